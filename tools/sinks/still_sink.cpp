// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/still_sink.h"

#include <utility>

namespace cprsim {

namespace {

/// s between the points of a trace, so that it is smooth however long the steps are.
constexpr double kTracePeriod = 0.01;

}  // namespace

StillSink::StillSink(const Scene& scene, std::optional<double> time, std::filesystem::path file,
                     std::string name)
    : scene_(scene),
      time_(time),
      file_(std::move(file)),
      name_(std::move(name)),
      view_(scene, video_or_default(scene)) {}

void StillSink::begin(const Snapshot& start) {
  begun_ = true;
  last_ = start;
  view_.follow(start);
  if (time_ && *time_ <= start.time) draw(start);
}

void StillSink::resume(const Snapshot& now) {
  earlier_ = time_ && *time_ <= now.time;
  if (!earlier_) begin(now);
}

void StillSink::step(const Snapshot& before, const Snapshot& now) {
  if (drawn_ || earlier_) return;
  const bool passed = time_ && *time_ <= now.time;
  last_ = passed ? interpolate(before, now, *time_) : now;
  for (double t = before.time + kTracePeriod; t < last_.time; t += kTracePeriod) {
    view_.follow(interpolate(before, now, t));
  }
  view_.follow(last_);
  if (passed) draw(last_);
}

void StillSink::finish() {
  if (begun_ && !drawn_) draw(last_);
}

void StillSink::draw(const Snapshot& snapshot) {
  const double film_time = snapshot.time / view_.video().speed;
  write_still(file_.string(), scene_, snapshot, view_.camera(snapshot), view_.decor_at(film_time));
  drawn_ = true;
}

std::vector<WrittenFile> StillSink::files() const {
  if (!drawn_) return {};
  return {{name_, "still", 1}};
}

}  // namespace cprsim
