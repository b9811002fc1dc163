// SPDX-License-Identifier: BSD-3-Clause
// Who receives the states of a run. The loop hands every sink the start and then each step; a sink
// looks between the two ends of a step if it wants other instants.
#pragma once

#include <string>
#include <vector>

#include "engine/math/archive.h"
#include "engine/run/snapshot.h"

namespace cprsim {

/// Something a sink leaves on disk, for run.json and the closing lines.
struct WrittenFile {
  std::string name;  ///< relative to the output folder; ends in '/' for a folder
  std::string kind;  ///< csv, hdf5, npz, vtk, gltf, video, still
  long count = 0;    ///< rows or frames
};

class Sink {
 public:
  virtual ~Sink() = default;

  virtual void begin(const Snapshot& start) = 0;

  /// In the place of begin(): the run goes on from this state, which an earlier run has reached and
  /// recorded.
  virtual void resume(const Snapshot& now) { begin(now); }

  virtual void step(const Snapshot& before, const Snapshot& now) = 0;

  /// What must be known to go on as if nothing had happened.
  virtual void visit(Archive&) {}

  /// Completes the files, also after a run that failed or was interrupted.
  virtual void finish() = 0;
  virtual std::vector<WrittenFile> files() const = 0;

  /// Its work is pictures, not numbers.
  virtual bool draws() const { return false; }
};

}  // namespace cprsim
