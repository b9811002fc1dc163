// SPDX-License-Identifier: BSD-3-Clause
// The geometry of bodies' contacts: lowest points, depths, and speeds at which something was met.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/golden_section.h"
#include "engine/robot/body_contacts.h"

namespace cprsim {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

double BodyContacts::distance(const BodyProbe& probe, const Vec3& at, Vec3* normal) const {
  const Distance found =
      distance_to(probe.surface, pose(probe.other) * probe.surface.X_WC, pose(probe.body) * at);
  if (normal) *normal = found.n;
  return found.d;
}

// Ends are corners, which have probes of their own.
BodyContacts::Foot BodyContacts::lowest_on_edge(const BodyProbe& probe) const {
  constexpr double kEnd = 1e-3;
  const auto place = [&](double s) {
    return Vec3(probe.X_BC * (probe.a + s * (probe.b - probe.a)));
  };
  const double s = lowest_of([&](double at) { return distance(probe, place(at), nullptr); }).at;
  Foot foot;
  foot.at = place(s);
  foot.gap =
      s < kEnd || s > 1 - kEnd ? kFar : distance(probe, foot.at, &foot.normal) - probe.radius;
  return foot;
}

BodyContacts::Foot BodyContacts::foot(const BodyProbe& probe) const {
  constexpr int kRounds = 8;
  constexpr double kFlat = 1e-6;  // sine of the tilt below which no place of a rim is the lowest
  if (probe.kind == BodyProbe::Kind::kEdge) return lowest_on_edge(probe);
  Foot foot;
  const Mat3 axes = pose(probe.body).R * probe.X_BC.R;
  const bool rim = probe.kind == BodyProbe::Kind::kRim;
  Vec3 local = rim || probe.kind == BodyProbe::Kind::kPoint ? probe.a : Vec3::Zero();
  for (int round = 0; round < kRounds; ++round) {
    foot.at = probe.X_BC * local;
    foot.gap = distance(probe, foot.at, &foot.normal) - probe.radius;
    if (probe.kind == BodyProbe::Kind::kPoint) return foot;
    const Vec3 down = -axes.transpose() * foot.normal;
    Vec3 next;
    if (rim) {
      const double tilt = down.head<2>().norm();
      if (tilt < kFlat) {
        foot.gap = kFar;
        return foot;
      }
      next = probe.a;
      next.head<2>() += probe.b.x() / tilt * down.head<2>();
    } else {
      const Vec3 scaled = probe.a.cwiseProduct(down);
      next = probe.a.cwiseProduct(scaled) / scaled.norm() - probe.radius * down;
    }
    const bool stays = round > 0 && (next - local).norm() < 1e-12 * probe.size;
    local = next;
    if (stays) break;
  }
  foot.at = probe.X_BC * local;
  foot.gap = distance(probe, foot.at, &foot.normal) - probe.radius;
  return foot;
}

/// Of a body's point when the step began.
Distance BodyContacts::begun(const BodyProbe& probe, const Vec3& at) const {
  Distance found = distance_to(probe.surface, begun_pose(probe.other) * probe.surface.X_WC,
                               begun_pose(probe.body) * at);
  found.d -= probe.radius;
  return found;
}

// What gives under the force that it had is no depth to come back from, unless it was that of an
// impact: put back at once, what was hit would be thrown.
double BodyContacts::sunk(const BodyContact& contact, const BodyContact* before) const {
  if (left_ == 0) return 0;
  const double given = before && !before->fresh ? before->give * before->law.force.norm() : 0;
  return left_ * std::min(0.0, begun(robot_.probes[contact.probe], contact.at).d + given);
}

/// The same contact when the step began, or null.
const BodyContact* BodyContacts::before(const BodyContact& contact) const {
  const auto was = std::find_if(before_.begin(), before_.end(),
                                [&](const BodyContact& old) { return old.probe == contact.probe; });
  return was == before_.end() ? nullptr : &*was;
}

/// The speed at which what meets now is to part, or 0. What rests only falls back by what gravity
/// adds within a step.
double BodyContacts::bounce(const BodyProbe& probe, const Foot& foot) const {
  if (!(probe.restitution > 0) || !rates_ || velocity_.empty()) return 0;
  const auto at = [&](int body, const Vec3& y) -> Vec3 {
    if (body < 0) return Vec3::Zero();
    const auto b = static_cast<std::size_t>(body);
    return velocity_[b].tail<3>() + velocity_[b].head<3>().cross(y - begun_[b].p);
  };
  const Vec3 y = begun_pose(probe.body) * foot.at - probe.radius * foot.normal;
  const double approach = -foot.normal.dot(at(probe.body, y) - at(probe.other, y));
  const double rest = 2 * robot_.gravity.norm() * since_;
  return approach > rest ? probe.restitution * approach : 0;
}

}  // namespace cprsim
