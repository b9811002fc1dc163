// SPDX-License-Identifier: BSD-3-Clause
// What acts on bodies and rods at an instant, and where: the ledger's work is forces over the ways
// of their points.
#include <cmath>
#include <optional>

#include "engine/math/so3.h"
#include "engine/run/ledger.h"
#include "engine/section/along.h"
#include "engine/section/place_laws.h"

namespace cprsim {

void EnergyLedger::collect(double t, bool before) {
  points_.clear();
  for (const BodyLoad& load : robot_.body_loads) {
    const Pose X = robot_.pose_of(load.at);
    const PointLoad at = load_at(*load.spec, t, before);
    const Mat3 axes = at.follower ? X.R : Mat3(Mat3::Identity());
    points_.push_back({axes * at.force, axes * at.torque, X.p, X.R});
  }
  for (const RobotRod& rod : robot_.rods) {
    collect_lines(rod, t, before);
    collect_current(rod);
    if (rod.loads.empty()) continue;
    const RodSample sample = rod.model->observe();
    for (const LoadSpec* load : rod.loads) {
      const PointLoad at = load_at(*load, t, before);
      const RodPoint* nearest = &sample.points.front();
      for (const RodPoint& point : sample.points)
        if (std::abs(point.s - load->rod_s) < std::abs(nearest->s - load->rod_s)) nearest = &point;
      const Mat3 axes = at.follower ? nearest->rotation : Mat3(Mat3::Identity());
      points_.push_back({axes * at.force, axes * at.torque, nearest->position, nearest->rotation});
    }
  }
}

namespace {

// of Gauss's two points from the middle
const double kAside = 0.5 / std::sqrt(3);

/// A section between two nodes, x of the way.
RodPoint between(const RodPoint& a, const RodPoint& b, double length, double x) {
  const double h = (b.s - a.s) * length, y = 1 - x;
  RodPoint at;
  at.s = y * a.s + x * b.s;
  at.rotation = exp_so3(x * log_so3(b.rotation * a.rotation.transpose())) * a.rotation;
  at.position = y * y * ((1 + 2 * x) * a.position + x * h * (a.rotation * a.shear_stretch)) +
                x * x * ((1 + 2 * y) * b.position - y * h * (b.rotation * b.shear_stretch));
  return at;
}

}  // namespace

// Of loads along the rod. In motion the power of their forces is the rod's
// (RodEnergy::fluid_power); where nothing has a rate they count as forces at points between its
// nodes, Gauss's.
void EnergyLedger::collect_lines(const RobotRod& rod, double t, bool before) {
  if (rod.line_loads.empty()) return;
  const bool moves = robot_.scene->simulation.mode == Mode::kDynamic;
  const RodSample sample = rod.model->observe();
  for (const LoadSpec* load : rod.line_loads) {
    const LineLoad line = line_load_at(*load, t, before);
    if (moves && line.torque.isZero(0)) continue;
    for (std::size_t k = 0; k + 1 < sample.points.size(); ++k) {
      const RodPoint &a = sample.points[k], &b = sample.points[k + 1];
      const double middle = 0.5 * (a.s + b.s);
      if (middle < line.from || middle > line.to) continue;
      for (const double x : {0.5 - kAside, 0.5 + kAside}) {
        const RodPoint at = between(a, b, sample.length, x);
        const Mat3 axes = line.follower ? at.rotation : Mat3(Mat3::Identity());
        Vec3 force = axes * line.force;
        if (line.law.law >= 0) {
          const PlaceForce placed = placed_forces(&line.law, 1, middle, ::load(at.position.data()));
          force += Vec3(placed.f.x, placed.f.y, placed.f.z);
        }
        const double weight = 0.5 * (b.s - a.s) * sample.length;
        points_.push_back({moves ? Vec3(Vec3::Zero()) : Vec3(weight * force),
                           weight * (axes * line.torque), at.position, at.rotation});
      }
    }
  }
}

// What a current does to a rod that stands in it (engine/section/fluid.h with p_t = 0), where
// nothing has a rate; in motion that is the rod's, too.
void EnergyLedger::collect_current(const RobotRod& rod) {
  const Vec3& V = rod.forcing.wind;
  if (robot_.scene->simulation.mode == Mode::kDynamic || !rod.section.fluid.resists() ||
      V.isZero(0))
    return;
  std::optional<SectionsAlong> along;
  if (SectionsAlong::varies(*rod.spec)) along.emplace(*rod.spec, true);
  const RodSample sample = rod.model->observe();
  for (std::size_t k = 0; k + 1 < sample.points.size(); ++k) {
    const RodPoint &a = sample.points[k], &b = sample.points[k + 1];
    for (const double x : {0.5 - kAside, 0.5 + kAside}) {
      const RodPoint at = between(a, b, sample.length, x);
      const FluidProperties fluid = along ? along->at(at.s, at.s).fluid : rod.section.fluid;
      const Vec3 t = at.rotation.col(2), V_t = t.dot(V) * t, V_n = V - V_t;
      const double weight = 0.5 * (b.s - a.s) * sample.length;
      points_.push_back(
          {weight * (fluid.normal * V_n.norm() * V_n + fluid.tangential * V_t.norm() * V_t),
           Vec3::Zero(), at.position, at.rotation});
    }
  }
}

}  // namespace cprsim
