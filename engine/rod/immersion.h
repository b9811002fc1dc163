// SPDX-License-Identifier: BSD-3-Clause
// What lies around a rod, for every method: a fluid's force, loads that are spread along it, what a
// magnetic field does to it, forces by where it is, at the places where the rod's balance holds, in
// the order of its track of positions (engine/section/fluid.h, engine/section/line_load.h,
// engine/section/magnetic_load.h).
#pragma once

#include <vector>

#include "engine/model/rod_spec.h"
#include "engine/rod/effect_part.h"
#include "engine/rod/rod_model.h"
#include "engine/section/fluid_section.h"
#include "engine/section/outer_field.h"
#include "engine/section/section.h"

namespace cprsim {

class Immersion {
 public:
  /// @param count places, one after the other at the front of the track; 0: nothing around it.
  explicit Immersion(std::size_t count) : places_(count) {}

  Immersion(const Immersion&) = delete;
  Immersion& operator=(const Immersion&) = delete;
  Immersion(Immersion&&) = default;
  Immersion& operator=(Immersion&&) = default;

  /// Where the places are, for loads and magnetic moments along the rod; a fraction of the length
  /// in the interior of the piece of the grid to which a place belongs.
  void place(std::vector<double> inside, const std::vector<MagnetSpec>& magnets);

  /// Inputs of a solve.
  /// @param own of each place, or empty: all are like `section`.
  void prepare(const SectionProperties& section, const std::vector<SectionProperties>& own,
               const StageRates& rates, const RodForcing& forcing, const Track& positions);

  /// Whether a force acts in the present solve: something moves, the rod or the fluid, or there are
  /// loads along the rod.
  bool acts() const { return !kBare && acts_; }

  /// Whether there are moments per length, too.
  bool loaded() const { return !kBare && loaded_; }

  /// Null where no field acts on this rod.
  const OuterField* field() const { return in_field_ || !forces_.empty() ? &field_ : nullptr; }

  bool field_varies() const { return !kBare && in_field_ && field_.magnetic.count > 0; }

  FluidSection* at(std::size_t place) { return &places_[place]; }

  const FluidSection* at(std::size_t place) const { return &places_[place]; }

  /// The largest derivative of the force by a displacement that the last evaluation found, N/m²:
  /// for estimates.
  double stiffness() const;

  /// Adds a place's share to the powers of `energy`, at the track's velocity and acceleration.
  /// @param axis of the section; weight: length that the place stands for, m.
  void add_power(std::size_t place, const Vec3& axis, double weight, const Track& positions,
                 RodEnergy& energy) const;

  /// Energy per length of a place of the rod in a field, J/m.
  double magnetic_energy(std::size_t place, const Mat3& R, const Vec3& p,
                         const MagneticField& field) const;

  /// Second derivative of this energy, and of that of placed forces, by (phi, dp), world axes,
  /// anywhere on the rod: `inside` as for place(). Of the field of the present solve.
  Mat6 outer_stiffness(double inside, const Mat3& R, const Vec3& p) const;

  void visit(Archive& archive) { archive.doubles(places_); }

 private:
  void take_loads(const std::vector<LineLoad>& lines);
  void take_field(const MagneticSources& field);
  void take_forces(const std::vector<LineLoad>& lines);
  Vec3 magnetization(double inside) const;

  std::vector<FluidSection> places_;
  std::vector<double> inside_;
  Vec3 wind_ = Vec3::Zero();
  StageRates rates_;
  bool acts_ = false, loaded_ = false;

  std::vector<MagnetSpec> magnets_;
  std::vector<MagneticDipole> dipoles_;
  std::vector<PlacedForce> forces_;
  OuterField field_;  ///< its dipoles and forces are those above
  bool in_field_ = false;
};

/// Of sources, which must outlive it.
MagneticField view_of(const MagneticSources& sources);

}  // namespace cprsim
