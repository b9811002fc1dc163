// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/immersion.h"

#include <algorithm>
#include <cmath>

#include "engine/math/so3.h"
#include "engine/section/line_load.h"

namespace cprsim {

MagneticField view_of(const MagneticSources& sources) {
  MagneticField field;
  Eigen::Map<Vec3>(field.uniform) = sources.uniform;
  field.dipoles = sources.dipoles.data();
  field.count = static_cast<int>(sources.dipoles.size());
  return field;
}

void Immersion::place(std::vector<double> inside, const std::vector<MagnetSpec>& magnets) {
  inside_ = std::move(inside);
  magnets_ = magnets;
  for (std::size_t j = 0; j < places_.size(); ++j) {
    const Vec3 m = magnetization(inside_[j]);
    Eigen::Map<Vec3>(places_[j].magnetization) = m;
    places_[j].magnetic = m.isZero(0) ? 0 : 1;
    places_[j].inside = inside_[j];
  }
}

Vec3 Immersion::magnetization(double inside) const {
  Vec3 sum = Vec3::Zero();
  for (const MagnetSpec& magnet : magnets_)
    if (inside >= magnet.from && inside <= magnet.to) sum += magnet.moment;
  return sum;
}

void Immersion::prepare(const SectionProperties& section, const std::vector<SectionProperties>& own,
                        const StageRates& rates, const RodForcing& forcing,
                        const Track& positions) {
  if (places_.empty()) return;
  rates_ = rates;
  wind_ = forcing.wind;
  acts_ = rates.dynamic() || !wind_.isZero(0);
  take_field(forcing.field);
  take_forces(forcing.lines);
  loaded_ = in_field_ || (!inside_.empty() && !forcing.lines.empty());
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

void Immersion::take_field(const MagneticSources& field) {
  in_field_ = !magnets_.empty() && !field.none();
  if (!in_field_) return;
  dipoles_ = field.dipoles;
  field_.magnetic = view_of(field);
  field_.magnetic.dipoles = dipoles_.data();
}

void Immersion::take_forces(const std::vector<LineLoad>& lines) {
  forces_.clear();
  for (const LineLoad& line : lines)
    if (line.law.law >= 0) forces_.push_back(line.law);
  field_.forces = forces_.data();
  field_.force_count = static_cast<int>(forces_.size());
}

double Immersion::magnetic_energy(std::size_t place, const Mat3& R, const Vec3& p,
                                  const MagneticField& field) const {
  const FluidSection& at = places_[place];
  if (at.magnetic == 0) return 0;
  const Vec3 m = R * Eigen::Map<const Vec3>(at.magnetization);
  const FieldAtPlace here = ::magnetic_field(field, load(p.data()), load(m.data()));
  return -m.dot(Vec3(here.B.x, here.B.y, here.B.z));
}

// With exp(phi^) m = m + phi × m + phi × (phi × m) / 2: of -m·B(p) the second-order part is
// (phi·phi m·B - phi·m phi·B) / 2 - (phi × m)·G dp - dp·H dp / 2.
Mat6 Immersion::outer_stiffness(double inside, const Mat3& R, const Vec3& p) const {
  using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Mat6 K = Mat6::Zero();
  if (!forces_.empty()) {
    const PlaceForce placed =
        placed_forces(field_.forces, field_.force_count, inside, load(p.data()));
    K.bottomRightCorner<3, 3>() = -Eigen::Map<const RowMatrix>(placed.f_p.a);
  }
  const Vec3 m = R * magnetization(inside);
  if (!in_field_ || m.isZero(0)) return K;
  const FieldAtPlace here = ::magnetic_field(field_.magnetic, load(p.data()), load(m.data()));
  const Mat3 G = Eigen::Map<const RowMatrix>(here.G.a), H = Eigen::Map<const RowMatrix>(here.H.a);
  const Vec3 B(here.B.x, here.B.y, here.B.z);
  const Mat3 mB = m * B.transpose();
  K.topLeftCorner<3, 3>() = m.dot(B) * Mat3::Identity() - 0.5 * (mB + mB.transpose());
  K.topRightCorner<3, 3>() = -cprsim::hat(m) * G;
  K.bottomLeftCorner<3, 3>() = K.topRightCorner<3, 3>().transpose();
  K.bottomRightCorner<3, 3>() -= H;
  return K;
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
