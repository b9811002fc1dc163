// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/stability.h"

#include <algorithm>
#include <cmath>

#include "engine/math/linear_solve.h"
#include "engine/study/lowest_modes.h"
#include "engine/study/robot_variation.h"

namespace cprsim {
namespace {

// Stiffnesses below this fraction of EI / L³ are within the discretisation of nothing.
constexpr double kNothing = 1e-6;

struct Signs {
  int negative = 0, none = 0;
};

Signs signs(const VecX& values, double nothing) {
  Signs s;
  for (const double value : values) {
    if (value < -nothing) ++s.negative;
    if (std::abs(value) <= nothing) ++s.none;
  }
  return s;
}

StabilityVerdict verdict_of(int negative, int none) {
  if (negative > 0) return StabilityVerdict::kUnstable;
  return none > 0 ? StabilityVerdict::kSingular : StabilityVerdict::kStable;
}

/// The lowest stiffnesses, and motions, of K measured by M: all that are negative or nothing, and
/// some beyond.
SymmetricModes softest_modes(const MatX& K, const MatX& M, double nothing) {
  for (int count = 6;; count *= 4) {
    SymmetricModes modes = lowest_modes(K, M, count);
    const Eigen::Index found = modes.values.size();
    if (found < count || modes.values[found - 1] > nothing) return modes;
  }
}

/// Signs of a rod with its ends held. Most rods are stable by far, which a triangular decomposition
/// shows at a fraction of the cost of eigenvalues.
Signs held_signs(const ReducedRod& rod, double nothing) {
  const Eigen::Index k = rod.inner;
  if (k == 0) return {};
  const auto K = rod.K.topLeftCorner(k, k), M = rod.M.topLeftCorner(k, k);
  if (is_positive_definite(K - nothing * M)) return {};
  return signs(softest_modes(K, M, nothing).values, nothing);
}

double nothing_of(const Robot& robot) {
  return kNothing * robot.scale.force / robot.scale.length;
}

}  // namespace

const char* to_string(StabilityVerdict verdict) {
  switch (verdict) {
    case StabilityVerdict::kUnstable:
      return "unstable";
    case StabilityVerdict::kSingular:
      return "singular";
    default:
      return "stable";
  }
}

double no_stiffness(const StaticStudy& study) {
  return nothing_of(study.robot());
}

Stability judge(const StaticStudy& study) {
  const Robot& robot = study.robot();
  const RobotVariation v = robot_variation(robot, Inertia::kMetric);
  Stability out;
  out.potential = v.potential;
  const double nothing = nothing_of(robot);
  for (const ReducedRod& rod : v.rods)
    out.in_rods.push_back(held_signs(rod, nothing).negative);
  MatX K, M;
  v.assemble(K, M);
  if (K.rows() == 0) return out;
  const SymmetricModes modes = softest_modes(K, M, nothing);
  if (modes.values.size() == 0) return out;
  const Signs all = signs(modes.values, nothing);
  out.unstable = all.negative;
  out.verdict = verdict_of(all.negative, all.none);
  out.softest = modes.values[0];
  out.stiffnesses = modes.values;
  const VecX shape = modes.vectors.col(0);
  const VecX y = v.free() * shape.tail(shape.size() - v.inner());
  for (std::size_t b = 0; b < robot.bodies.size(); ++b)
    out.softest_bodies.push_back(y.segment<6>(6 * static_cast<Eigen::Index>(b)));
  out.body_stiffness = condensed_stiffness(v);
  return out;
}

MatX condensed_stiffness(const RobotVariation& v) {
  MatX S = v.K;
  for (const ReducedRod& rod : v.rods) {
    const Eigen::Index k = rod.inner;
    MatX own = rod.K.bottomRightCorner<12, 12>();
    if (k > 0) {
      const MatX coupling = rod.K.topRightCorner(k, 12);
      own -= coupling.transpose() * solve_columns(rod.K.topLeftCorner(k, k), coupling);
    }
    const int bodies[2] = {rod.base_body, rod.tip_body};
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        if (bodies[i] >= 0 && bodies[j] >= 0)
          S.block<6, 6>(6 * bodies[i], 6 * bodies[j]) += own.block<6, 6>(6 * i, 6 * j);
  }
  return S;
}

Stability count_unstable(const Robot& robot) {
  const RobotVariation v = robot_variation(robot, Inertia::kMetric);
  Stability out;
  out.potential = v.potential;
  const double nothing = nothing_of(robot);
  Signs all;
  for (const ReducedRod& rod : v.rods) {
    const Signs own = held_signs(rod, nothing);
    out.in_rods.push_back(own.negative);
    all.negative += own.negative;
    all.none += own.none;
  }
  out.body_stiffness = condensed_stiffness(v);
  if (v.outer() > 0) {
    // forces per length: rotations in units of the robot's length
    VecX unit = VecX::Ones(v.outer());
    for (std::size_t b = 0; b < robot.bodies.size(); ++b)
      unit.segment<3>(6 * static_cast<Eigen::Index>(b)).setConstant(1 / robot.scale.length);
    const MatX F = v.free();
    const MatX scaled =
        F.transpose() * unit.asDiagonal() * out.body_stiffness * unit.asDiagonal() * F;
    if (F.cols() > 0) {
      const SymmetricModes modes = symmetric_modes(scaled, MatX::Identity(F.cols(), F.cols()));
      const Signs own = signs(modes.values, nothing);
      all.negative += own.negative;
      all.none += own.none;
      out.softest = modes.values[0];
    }
  }
  out.unstable = all.negative;
  out.verdict = verdict_of(all.negative, all.none);
  return out;
}

}  // namespace cprsim
