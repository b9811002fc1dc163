// SPDX-License-Identifier: BSD-3-Clause
// Rods as ParaView polylines: one .vtp per instant in its own folder and a .pvd that lists them
// with their times. The .pvd is rewritten whole after every frame, so that a killed run still
// opens.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"

namespace cprsim {

class VtkWriter {
 public:
  /// Writes folder/prefix.pvd and folder/prefix_vtk/000000.vtp and so on.
  VtkWriter(const std::filesystem::path& folder, std::string prefix);

  void write_frame(const Scene& scene, const Snapshot& snapshot);

  long frames() const { return static_cast<long>(times_.size()); }

 private:
  void rewrite_collection() const;
  std::string frame_name(std::size_t frame) const;

  std::filesystem::path folder_;
  std::string prefix_;
  std::vector<double> times_;
};

/// One instant as VTK PolyData XML: a line per rod; point data s, arc_length, radius, curvature,
/// shear_stretch, force, moment, velocity; cell data rod (its index in the scene).
std::string to_vtp(const Scene& scene, const Snapshot& snapshot);

}  // namespace cprsim
