// SPDX-License-Identifier: BSD-3-Clause
// Images to an H.264 MP4 file, encoded by the ffmpeg program at the other end of a pipe.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/image.h"

namespace cprsim {

/// Why no film can be made on this machine (the ffmpeg program is missing, or lacks libx264), or
/// empty.
std::string film_unavailable();

/// One video file: High profile, yuv420p, BT.709, constant rate, index in front. Written to
/// <file>.part.mp4 and renamed by close(); a film that is dropped unclosed leaves nothing behind.
/// Every failure throws std::runtime_error with ffmpeg's own last words.
class Film {
 public:
  Film();
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// Width and height are rounded down to even numbers.
  void open(const std::string& path, int width, int height, double fps);
  void add(const Image& image);
  void close();

  int frames() const { return frames_; }

 private:
  void abandon();
  std::string last_words() const;

  std::string path_, part_, log_;
  int width_ = 0, height_ = 0, frames_ = 0;
  int pipe_ = -1;
  int process_ = -1;
  std::vector<std::uint8_t> planes_;
};

}  // namespace cprsim
