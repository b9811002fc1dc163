// SPDX-License-Identifier: BSD-3-Clause
// What lies around a rod, for every method: a fluid's force and loads that are spread along it, at
// the places where the rod's balance holds, in the order of its track of positions
// (engine/section/fluid.h, engine/section/line_load.h).
#pragma once

#include <vector>

#include "engine/rod/rod_model.h"
#include "engine/section/fluid_section.h"
#include "engine/section/section.h"

namespace cprsim {

class Immersion {
 public:
  /// @param count places, one after the other at the front of the track; 0: nothing around it.
  explicit Immersion(std::size_t count) : places_(count) {}

  /// Where the places are, for loads along the rod; a fraction of the length in the interior of the
  /// piece of the grid to which a place belongs.
  void place(std::vector<double> inside) { inside_ = std::move(inside); }

  /// Inputs of a solve.
  /// @param own of each place, or empty: all are like `section`.
  void prepare(const SectionProperties& section, const std::vector<SectionProperties>& own,
               const StageRates& rates, const RodForcing& forcing, const Track& positions);

  /// Whether a force acts in the present solve: something moves, the rod or the fluid, or there are
  /// loads along the rod.
  bool acts() const { return acts_; }

  bool loaded() const { return loaded_; }

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
  void take_loads(const std::vector<LineLoad>& lines);

  std::vector<FluidSection> places_;
  std::vector<double> inside_;
  Vec3 wind_ = Vec3::Zero();
  StageRates rates_;
  bool acts_ = false, loaded_ = false;
};

}  // namespace cprsim
