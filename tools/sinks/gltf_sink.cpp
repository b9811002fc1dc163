// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/gltf_sink.h"

#include <cmath>
#include <utility>

#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

constexpr std::size_t kBlockFrames = 64;    ///< kept in memory
constexpr double kKeyframeRoundOff = 1e-9;  ///< of a period, as in recording.cpp

}  // namespace

GltfSink::GltfSink(const Scene& scene, double fps, std::filesystem::path file, std::string name)
    : scene_(scene), fps_(fps), file_(std::move(file)), name_(std::move(name)) {}

void GltfSink::start(const Snapshot& first) {
  model_.emplace(scene_, first);
  spool_.emplace(file_.parent_path(), model_->widths(), kBlockFrames);
}

void GltfSink::begin(const Snapshot& first) {
  start(first);
  record(first);
}

void GltfSink::resume(const Snapshot& now) {
  start(now);
  next_ = static_cast<long>(std::floor(now.time * fps_ + kKeyframeRoundOff)) + 1;
}

void GltfSink::step(const Snapshot& before, const Snapshot& now) {
  while (static_cast<double>(next_) <= now.time * fps_ + kKeyframeRoundOff) {
    const double time = static_cast<double>(next_) / fps_;
    Snapshot snapshot = interpolate(before, now, time);
    snapshot.time = time;
    record(snapshot);
  }
}

void GltfSink::record(const Snapshot& snapshot) {
  model_->add_keyframe(snapshot);
  last_time_ = static_cast<float>(snapshot.time);
  if (frames_ == 0) first_time_ = last_time_;
  ++next_;
  ++frames_;
  if (model_->keyframes()[0].size() == kBlockFrames) hand_on();
}

void GltfSink::hand_on() {
  std::vector<const void*> data;
  for (const std::vector<float>& list : model_->keyframes())
    data.push_back(list.data());
  spool_->append(model_->keyframes()[0].size(), data);
  model_->clear_keyframes();
}

void GltfSink::finish() {
  if (!model_) return;
  hand_on();
  OutputFile file(file_);
  model_->glb().write(file, *spool_, first_time_, last_time_);
  file.commit();
}

std::vector<WrittenFile> GltfSink::files() const {
  if (!model_) return {};
  return {{name_, "gltf", frames_}};
}

}  // namespace cprsim
