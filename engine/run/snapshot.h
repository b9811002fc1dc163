// SPDX-License-Identifier: BSD-3-Clause
// What an observer may see of the robot at one instant: plain data in world axes, no solver
// objects. Channels, writers, pictures and expectations are all computed from it.
#pragma once

#include <vector>

#include "engine/math/archive.h"
#include "engine/math/types.h"
#include "engine/model/touch.h"
#include "engine/rod/shape.h"

namespace cprsim {

struct BodySample {
  Pose X_WB;                       ///< link frame
  Vec3 linear_velocity{0, 0, 0};   ///< of the link origin, world axes
  Vec3 angular_velocity{0, 0, 0};  ///< world axes
};

struct JointSample {
  Vec3 position{0, 0, 0}, velocity{0, 0, 0};  ///< by axis; of a ball see Joint::Observed
  Vec3 effort{0, 0, 0};  ///< along each axis: what drive, spring, damper, friction, limits exert
  Vec3 limit{0, 0, 0};   ///< of that, what the limits exert; 0 between them
};

/// J. work is what drives and loads have put in, dissipated what damping has taken out since t = 0;
/// balance = total - total(0) - work + dissipated, which a perfect integration keeps at 0.
struct EnergySample {
  double kinetic = 0, elastic = 0, gravity = 0, magnetic = 0;
  double dissipated = 0, work = 0, total = 0, balance = 0;
};

struct SolverSample {
  int iterations = 0;    ///< Newton iterations of the step that ended here
  double residual = 0;   ///< scaled, dimensionless
  double step = 0;       ///< s
  double wall_time = 0;  ///< s, of that step
};

/// Where a rod touches: its surface's point, what acts there on the rod, and the other side's
/// outward normal; world axes.
struct ContactPoint {
  int rod = 0;                   ///< index into Scene::rods; of two rods the first
  Vec3 position = Vec3::Zero();  ///< m
  Vec3 normal = Vec3::UnitZ();   ///< unit
  Vec3 force = Vec3::Zero();     ///< N
  Vec3 slip = Vec3::Zero();      ///< of the rod over the other, m/s; in quasi-statics m per step
  double gap = 0;                ///< m
  ContactParty other;            ///< what it touches
};

/// Where two links touch; of a body in free flight, as of its last substep.
struct LinkContact {
  int link = 0, other = 0;       ///< indices into Scene::bodies
  Vec3 position = Vec3::Zero();  ///< m
  Vec3 normal = Vec3::UnitZ();   ///< of the other, outwards, unit
  Vec3 force = Vec3::Zero();     ///< on the link, N
  Vec3 slip = Vec3::Zero();      ///< of the link over the other, m/s
  double gap = 0;                ///< m
};

/// The least distance of a pair that is watched.
struct PairDistance {
  ContactPair pair;
  double gap = 0;                ///< m; below 0: how deep
  Vec3 position = Vec3::Zero();  ///< where, on the surface of the pair's first rod, m
};

struct ContactSample {
  int count = 0;
  double penetration = 0;            ///< deepest, m
  double force = 0, friction = 0;    ///< sums of normal and tangential forces on rods, N
  double slip = 0;                   ///< fastest of rods, m/s
  std::vector<ContactPoint> points;  ///< of rods
  std::vector<LinkContact> links;
  std::vector<PairDistance> distances;  ///< as Scene::watched, where there is a rod
};

struct Snapshot {
  // Compiled once, in snapshot.cpp: dozens of files make and copy one.
  Snapshot();
  Snapshot(const Snapshot&);
  Snapshot(Snapshot&&) noexcept;
  Snapshot& operator=(const Snapshot&);
  Snapshot& operator=(Snapshot&&) noexcept;
  ~Snapshot();

  double time = 0;
  std::vector<BodySample> bodies;  ///< as Scene::bodies
  std::vector<JointSample> joints;
  std::vector<RodSample> rods;
  std::vector<TendonSample> tendons;  ///< as Scene::tendons
  EnergySample energy;
  SolverSample solver;
  ContactSample contact;
};

inline void visit(EnergySample& e, Archive& archive) {
  for (double* x : {&e.kinetic, &e.elastic, &e.gravity, &e.magnetic, &e.dissipated, &e.work,
                    &e.total, &e.balance})
    archive(*x);
}

/// The state between two snapshots: cubic Hermite in positions, geodesic in rotations, linear in
/// the rest. Requires a.time <= t <= b.time.
Snapshot interpolate(const Snapshot& a, const Snapshot& b, double t);

/// The point of a rod at fraction s of its length. Between the sample's points its position errs by
/// the sixth power of their distance, its rotation and moment by the fourth, where strains and
/// forces are smooth; otherwise by the fourth and the second.
RodPoint point_at(const RodSample& rod, double s);

}  // namespace cprsim
