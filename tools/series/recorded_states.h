// SPDX-License-Identifier: BSD-3-Clause
// The states that an HDF5 recording holds of a scene's rods and links: what pictures are drawn
// from. Forces of contacts, tensions and energies are not among them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"

namespace cprsim {

class RecordedStates {
 public:
  /// @param scene outlives it. @throws TableError, as do all members: no such file, or not of this
  /// scene's rods and links
  RecordedStates(const std::string& path, const Scene& scene);
  ~RecordedStates();

  const std::vector<double>& times() const { return times_; }

  Snapshot at(std::size_t index) const;

  /// Of the scene that was recorded; empty if the file does not say.
  const std::string& scene_hash() const { return scene_hash_; }

 private:
  struct File;
  std::unique_ptr<File> file_;
  const Scene& scene_;
  std::vector<double> times_;
  std::string scene_hash_;
};

}  // namespace cprsim
