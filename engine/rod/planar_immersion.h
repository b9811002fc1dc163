// SPDX-License-Identifier: BSD-3-Clause
// What lies around a rod in a plane: engine/rod/immersion.h, which computes in space, seen in the
// plane. It is asked for the sections of a rod for which something is there; others know nothing
// of it.
#pragma once

#include "engine/rod/immersion.h"
#include "engine/rod/planar_cell.h"

namespace cprsim {

class PlanarImmersion {
 public:
  /// @param plane e1, e2, normal as columns; offset: section axes in plane axes at theta = 0;
  /// height: of the rod's plane along the normal
  PlanarImmersion(std::size_t count, const Mat3& plane, const Mat3& offset, double height);

  /// Inputs of a solve, from a track whose front holds two coordinates of each place. @param
  /// sections of the places, if they vary
  void prepare(const SectionProperties& section, const StageRates& rates, const RodForcing& forcing,
               const Track& in_plane, const std::vector<SectionProperties>& sections = {});

  /// Force and moment at a place and their derivatives.
  void evaluate(std::size_t place, const PlanarStage& at);

  PlanarAround* at(std::size_t place) { return &around_[place]; }

  /// As Immersion::add_power, at the track's velocity and acceleration.
  void add_powers(const std::vector<double>& weights, const std::vector<PlanarStage>& stages,
                  const Track& in_plane, RodEnergy& energy) const;

  double magnetic_energy(std::size_t place, const PlanarStage& at,
                         const MagneticField& field) const;
  Mat6 outer_stiffness(double inside, const PlanarStage& at) const;

  Immersion& in_space() { return fluid_; }

  const Immersion& in_space() const { return fluid_; }

 private:
  Mat3 rotation(const PlanarStage& at) const;
  Vec3 position(const PlanarStage& at) const;
  VecX lifted(const VecX& in_plane, double along_normal) const;

  Mat3 plane_, offset_;
  double height_;
  StageRates rates_;
  Immersion fluid_;
  std::vector<PlanarAround> around_;
};

}  // namespace cprsim
