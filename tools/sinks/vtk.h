// SPDX-License-Identifier: BSD-3-Clause
// Rods as ParaView polylines: one .vtp per instant in its own folder and a .pvd that lists them
// with their times. The .pvd is rewritten whole as frames come, at first after each, later after
// every hundredth part more, so that a killed run still opens. Where rods may touch something, the
// points at which they do are a second such series.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"

namespace cprsim {

class VtkWriter {
 public:
  /// Writes folder/prefix.pvd and folder/prefix_vtk/000000.vtp and so on; with contact of rods
  /// folder/prefix_contacts.pvd and folder/prefix_vtk/contacts_000000.vtp besides.
  VtkWriter(const std::filesystem::path& folder, std::string prefix);

  void write_frame(const Scene& scene, const Snapshot& snapshot);

  /// Lists the last frames.
  void finish();

  /// Whether frames have had contacts beside rods.
  bool has_contacts() const { return has_contacts_; }

  long frames() const { return static_cast<long>(times_.size()); }

 private:
  enum class Written { kNow, kWhenever };  ///< to the disk

  void list_frames(Written written);
  void rewrite_collection(const std::string& name, const std::string& part, Written written) const;
  std::string frame_name(const std::string& part, std::size_t frame) const;

  std::filesystem::path folder_;
  std::string prefix_;
  std::vector<double> times_;
  std::size_t listed_ = 0;  ///< frames in the .pvd
  bool has_contacts_ = false;
};

/// One instant as VTK PolyData XML: a line per rod; point data s, arc_length, radius, curvature,
/// shear_stretch, force, moment, velocity; cell data rod (its index in the scene).
std::string to_vtp(const Scene& scene, const Snapshot& snapshot);

/// Whether the rods of a scene may touch something.
bool writes_contacts(const Scene& scene);

/// Where rods touch: point data normal, force (on the rod), slip, gap, rod.
std::string to_contacts_vtp(const Snapshot& snapshot);

}  // namespace cprsim
