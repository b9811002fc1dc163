// SPDX-License-Identifier: BSD-3-Clause
// A film as numbered PNG frames, for machines without ffmpeg.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tools/sinks/sink.h"
#include "tools/sinks/view.h"

namespace cprsim {

class FrameSink : public Sink {
 public:
  /// Writes folder/000000.png and so on. @throws std::runtime_error if the machine cannot draw
  /// @param name how the folder is called in reports
  FrameSink(const Scene& scene, const VideoSpec& video, std::filesystem::path folder,
            std::string name);

  void begin(const Snapshot& start) override;
  void resume(const Snapshot& now) override;
  void step(const Snapshot& before, const Snapshot& now) override;

  void finish() override {}

  std::vector<WrittenFile> files() const override;

  bool draws() const override { return true; }

  std::string device() const { return renderer_->device(); }

 private:
  void draw(const Snapshot& snapshot);

  View view_;
  std::filesystem::path folder_;
  std::string name_;
  std::unique_ptr<Renderer> renderer_;
  long frames_ = 0;
};

/// What turns the frames into the film later.
std::string encode_command(const VideoSpec& video, const std::filesystem::path& folder,
                           const std::filesystem::path& film);

}  // namespace cprsim
