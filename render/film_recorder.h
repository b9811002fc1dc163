// SPDX-License-Identifier: BSD-3-Clause
// Films a run while it runs: the caller's thread picks the instants k·speed/fps, a second thread
// draws them, a third encodes. Queues are bounded, so a fast simulation waits for the film, not the
// memory.
#pragma once

#include <memory>
#include <string>

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"
#include "render/renderer.h"

namespace cprsim {

class FilmRecorder {
 public:
  /// Opens the drawing device and the file. Throws std::runtime_error if either is not to be had.
  /// The scene must outlive the recorder.
  FilmRecorder(const Scene& scene, const VideoSpec& video, const std::string& file,
               const RenderOptions& options = {});
  ~FilmRecorder();

  /// Films every instant k·speed/fps in (before.time, now.time], and the first one if it is
  /// before.time. Blocks while the film is more than a few frames behind. Throws what went wrong in
  /// the threads.
  void observe(const Snapshot& before, const Snapshot& now);

  /// Draws and encodes what is queued and closes the file. Without it the file is discarded.
  void finish();

  int frames() const;              ///< taken so far
  double seconds_drawing() const;  ///< wall time the drawing thread was busy
  double seconds_encoding() const;
  double seconds_waiting() const;  ///< wall time observe() and finish() held up the caller
  std::string device() const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace cprsim
