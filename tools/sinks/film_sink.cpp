// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/film_sink.h"

#include <utility>

namespace cprsim {

FilmSink::FilmSink(const Scene& scene, const VideoSpec& video, const std::filesystem::path& file,
                   std::string name)
    : name_(std::move(name)), recorder_(scene, video, file.string()) {}

void FilmSink::begin(const Snapshot& start) {
  recorder_.observe(start, start);
}

void FilmSink::step(const Snapshot& before, const Snapshot& now) {
  recorder_.observe(before, now);
}

void FilmSink::finish() {
  recorder_.finish();
}

std::vector<WrittenFile> FilmSink::files() const {
  if (recorder_.frames() == 0) return {};
  return {{name_, "video", recorder_.frames()}};
}

}  // namespace cprsim
