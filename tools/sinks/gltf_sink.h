// SPDX-License-Identifier: BSD-3-Clause
// A run as an animated glTF model, for Blender, browsers and slides.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/gltf/robot_model.h"
#include "tools/sinks/sink.h"
#include "tools/sinks/spool.h"

namespace cprsim {

class GltfSink : public Sink {
 public:
  /// Keyframes at exactly k/fps. @param name how the file is called in reports
  /// @throws OutputError
  GltfSink(const Scene& scene, double fps, std::filesystem::path file, std::string name);

  void begin(const Snapshot& start) override;
  void resume(const Snapshot& now) override;
  void step(const Snapshot& before, const Snapshot& now) override;
  void finish() override;
  std::vector<WrittenFile> files() const override;

 private:
  void start(const Snapshot& first);
  void record(const Snapshot& snapshot);
  void hand_on();

  const Scene& scene_;
  double fps_;
  std::filesystem::path file_;
  std::string name_;
  std::optional<RobotModel> model_;
  std::optional<Spool> spool_;
  long next_ = 0;  ///< keyframe
  float first_time_ = 0, last_time_ = 0;
  long frames_ = 0;
};

}  // namespace cprsim
