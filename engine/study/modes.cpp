// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/modes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/math/so3.h"
#include "engine/study/lowest_modes.h"
#include "engine/study/robot_variation.h"

namespace cprsim {
namespace {

VibrationMode expand(const RobotVariation& v, const VecX& x) {
  VibrationMode mode;
  const VecX y = v.free() * x.tail(x.size() - v.inner());
  for (Eigen::Index at = 0; at + 6 <= v.outer(); at += 6)
    mode.bodies.push_back(y.segment<6>(at));
  Eigen::Index at = 0;
  for (const ReducedRod& rod : v.rods) {
    VecX own = VecX::Zero(rod.inner + 12);
    own.head(rod.inner) = x.segment(at, rod.inner);
    if (rod.base_body >= 0) own.segment<6>(rod.inner) = y.segment<6>(6 * rod.base_body);
    if (rod.tip_body >= 0) own.segment<6>(rod.inner + 6) = y.segment<6>(6 * rod.tip_body);
    at += rod.inner;
    const VecX nodes = rod.nodes * own;
    std::vector<Vec6> motions;
    for (Eigen::Index i = 0; i < nodes.size(); i += 6)
      motions.push_back(nodes.segment<6>(i));
    mode.rods.push_back(std::move(motions));
  }
  return mode;
}

double farthest(const VibrationMode& mode) {
  double most = 0;
  for (const Vec6& body : mode.bodies)
    most = std::max(most, body.tail<3>().norm());
  for (const auto& rod : mode.rods)
    for (const Vec6& node : rod)
      most = std::max(most, node.tail<3>().norm());
  return most;
}

}  // namespace

double VibrationMode::frequency() const {
  return omega_squared > 0 ? std::sqrt(omega_squared) / (2 * std::numbers::pi) : 0;
}

std::vector<VibrationMode> natural_modes(const StaticStudy& study, int count) {
  const RobotVariation v = robot_variation(study.robot(), Inertia::kReal);
  MatX K, M;
  v.assemble(K, M);
  const SymmetricModes lowest = lowest_modes(K, M, count);
  std::vector<VibrationMode> modes;
  for (Eigen::Index i = 0; i < lowest.values.size() && i < count; ++i) {
    VibrationMode mode = expand(v, lowest.vectors.col(i));
    mode.omega_squared = lowest.values[i];
    modes.push_back(std::move(mode));
  }
  return modes;
}

Snapshot displaced(const StaticStudy& study, const VibrationMode& mode, double amplitude) {
  Snapshot shown = study.snapshot();
  const Robot& robot = study.robot();
  const double far = farthest(mode);
  const double a = far > 0 ? amplitude / far : 0;
  for (std::size_t i = 0; i < shown.bodies.size(); ++i) {
    const int b = robot.links[i].body;
    if (b < 0) continue;
    const Vec6 motion = a * mode.bodies[static_cast<std::size_t>(b)];
    const Vec3 centre = robot.bodies[static_cast<std::size_t>(b)].p;
    const Mat3 turn = exp_so3(motion.head<3>());
    Pose& X = shown.bodies[i].X_WB;
    X.p = centre + motion.tail<3>() + turn * (X.p - centre);
    X.R = turn * X.R;
  }
  for (std::size_t r = 0; r < shown.rods.size(); ++r)
    for (std::size_t k = 0; k < shown.rods[r].points.size(); ++k) {
      const Vec6 motion = a * mode.rods[r][k];
      RodPoint& point = shown.rods[r].points[k];
      point.position += motion.tail<3>();
      point.rotation = exp_so3(motion.head<3>()) * point.rotation;
    }
  return shown;
}

}  // namespace cprsim
