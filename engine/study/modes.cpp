// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/modes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/math/linear_solve.h"
#include "engine/math/so3.h"
#include "engine/study/robot_variation.h"

namespace cprsim {
namespace {

/// A shift that makes K + shift M positive definite: none where the equilibrium is stable.
double find_shift(const MatX& K, const MatX& M) {
  if (is_positive_definite(K)) return 0;
  double shift = 1e-6 * K.diagonal().cwiseAbs().maxCoeff() / M.diagonal().maxCoeff();
  while (!is_positive_definite(K + shift * M) && std::isfinite(shift))
    shift *= 10;
  return shift;
}

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

// M may be singular (no rotary inertia), K + shift M is not: M x = mu (K + shift M) x,
// omega² = 1/mu - shift.
std::vector<VibrationMode> natural_modes(const StaticStudy& study, int count) {
  const RobotVariation v = robot_variation(study.robot(), Inertia::kReal);
  MatX K, M;
  v.assemble(K, M);
  std::vector<VibrationMode> modes;
  if (K.rows() == 0 || M.diagonal().maxCoeff() <= 0) return modes;
  const double shift = find_shift(K, M);
  const SymmetricModes all = symmetric_modes(M, K + shift * M);
  const Eigen::Index n = all.values.size();
  for (Eigen::Index i = n - 1; i >= 0 && static_cast<int>(modes.size()) < count; --i) {
    const double mu = all.values[i];
    if (mu <= 1e-14 * all.values[n - 1]) break;  // motions without inertia
    VibrationMode mode = expand(v, all.vectors.col(i) / std::sqrt(mu));
    mode.omega_squared = 1 / mu - shift;
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
