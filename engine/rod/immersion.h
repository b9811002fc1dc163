// SPDX-License-Identifier: BSD-3-Clause
// A fluid's force along a rod, for every method: the places where the rod's balance holds, in the
// order of its track of positions (engine/section/fluid.h).
#pragma once

#include <vector>

#include "engine/rod/rod_model.h"
#include "engine/section/fluid_section.h"
#include "engine/section/section.h"

namespace cprsim {

class Immersion {
 public:
  /// @param count places, one after the other at the front of the track; 0: no fluid.
  explicit Immersion(std::size_t count) : places_(count) {}

  /// Inputs of a solve.
  /// @param own of each place, or empty: all are like `section`.
  void prepare(const SectionProperties& section, const std::vector<SectionProperties>& own,
               const StageRates& rates, const RodForcing& forcing, const Track& positions);

  /// Whether a force acts in the present solve: something moves, the rod or the fluid.
  bool acts() const { return acts_; }

  FluidSection* at(std::size_t place) { return &places_[place]; }

  const FluidSection* at(std::size_t place) const { return &places_[place]; }

  /// The largest derivative of the force by a displacement that the last evaluation found, N/m²:
  /// for estimates.
  double stiffness() const;

  /// Adds a place's share to the powers of `energy`, at the track's velocity and acceleration.
  /// @param axis of the section; weight: length that the place stands for, m.
  void add_power(std::size_t place, const Vec3& axis, double weight, const Track& positions,
                 RodEnergy& energy) const;

  void visit(Archive& archive) { archive.doubles(places_); }

 private:
  std::vector<FluidSection> places_;
  Vec3 wind_ = Vec3::Zero();
  StageRates rates_;
  bool acts_ = false;
};

}  // namespace cprsim
