// SPDX-License-Identifier: BSD-3-Clause
// One <cprsim:video>: hands the states of a run to render/'s film recorder.
#pragma once

#include <filesystem>
#include <string>

#include "render/film_recorder.h"
#include "tools/sinks/sink.h"

namespace cprsim {

class FilmSink : public Sink {
 public:
  /// @param name how the file is called in reports
  FilmSink(const Scene& scene, const VideoSpec& video, const std::filesystem::path& file,
           std::string name);

  void begin(const Snapshot& start) override;
  void step(const Snapshot& before, const Snapshot& now) override;
  void finish() override;
  std::vector<WrittenFile> files() const override;

  bool draws() const override { return true; }

  std::string device() const { return recorder_.device(); }

 private:
  std::string name_;
  FilmRecorder recorder_;
};

}  // namespace cprsim
