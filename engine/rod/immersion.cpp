// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/immersion.h"

#include <algorithm>
#include <cmath>

namespace cprsim {

void Immersion::prepare(const SectionProperties& section, const std::vector<SectionProperties>& own,
                        const StageRates& rates, const RodForcing& forcing,
                        const Track& positions) {
  if (places_.empty()) return;
  rates_ = rates;
  wind_ = forcing.wind;
  acts_ = rates.dynamic() || !wind_.isZero(0);
  loaded_ = !inside_.empty() && !forcing.lines.empty();
  if (loaded_) {
    acts_ = true;
    take_loads(forcing.lines);
  }
  for (std::size_t j = 0; j < places_.size(); ++j) {
    FluidSection& place = places_[j];
    const FluidProperties& fluid = own.empty() ? section.fluid : own[j].fluid;
    place.normal = fluid.normal;
    place.tangential = fluid.tangential;
    place.added_mass = fluid.added_mass;
    Vec3 v_h = -wind_, a_h = Vec3::Zero();
    if (rates.dynamic()) {
      const auto i = 3 * static_cast<Eigen::Index>(j);
      v_h += positions.x_h.segment<3>(i);
      a_h = rates.c_w * positions.x_h.segment<3>(i) + positions.v_h.segment<3>(i);
    }
    Eigen::Map<Vec3>(place.velocity_h) = v_h;
    Eigen::Map<Vec3>(place.acceleration_h) = a_h;
  }
}

void Immersion::take_loads(const std::vector<LineLoad>& lines) {
  for (std::size_t j = 0; j < places_.size(); ++j) {
    FluidSection& place = places_[j];
    place.loaded = 1;
    Eigen::Map<Vec3> dead_force(place.dead_force), dead_moment(place.dead_moment),
        own_force(place.own_force), own_moment(place.own_moment);
    for (Eigen::Map<Vec3>* sum : {&dead_force, &dead_moment, &own_force, &own_moment})
      sum->setZero();
    for (const LineLoad& line : lines) {
      if (inside_[j] < line.from || inside_[j] > line.to) continue;
      (line.follower ? own_force : dead_force) += line.force;
      (line.follower ? own_moment : dead_moment) += line.torque;
    }
  }
}

double Immersion::stiffness() const {
  double largest = 0;
  if (acts_)
    for (const FluidSection& place : places_)
      for (int i = 0; i < 9; i += 4)
        largest = std::max(largest, std::abs(place.force_p[i]));
  return largest;
}

// v_n, v_t are relative to the current, whose power is what the drag takes out plus what it does on
// the rod: F·p_t = F·v + F·V.
void Immersion::add_power(std::size_t place, const Vec3& axis, double weight,
                          const Track& positions, RodEnergy& energy) const {
  if (!rates_.dynamic()) return;
  const FluidSection& at = places_[place];
  const auto i = 3 * static_cast<Eigen::Index>(place);
  const Vec3 p_t = positions.v.segment<3>(i), a = positions.a.segment<3>(i), v = p_t - wind_;
  const double along = v.dot(axis);
  const Vec3 v_n = v - along * axis;
  const Vec3 drag = -at.normal * v_n.norm() * v_n - at.tangential * std::abs(along) * along * axis;
  energy.damping_power -= weight * drag.dot(v);
  if (loaded_) energy.fluid_power += weight * Eigen::Map<const Vec3>(at.applied).dot(p_t);
  energy.fluid_power +=
      weight * (drag.dot(wind_) - at.added_mass * (a - a.dot(axis) * axis).dot(p_t));
}

}  // namespace cprsim
