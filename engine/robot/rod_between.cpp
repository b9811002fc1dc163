// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/rod_between.h"

#include <cmath>

#include "engine/math/linear_solve.h"

namespace cprsim {
namespace {

// Below this ratio of pivots T is singular: something turns without resistance, like a rod that
// spins between two balls.
constexpr double kSingularPivot = 1e-10, kConsistent = 1e-6;

}  // namespace

// To linearise and eliminate a rod costs for each unknown of shooting about what an evaluation of a
// section does; collocation has a band, the strain basis a full matrix, of whose products that many
// cost the same.
long direction_work(const RodModel& rod) {
  constexpr long kBandProducts = 500, kFullProducts = 1000;
  constexpr long kFields = 13;  // pose, force and moment of a point
  const RodResolution how = rod.resolution();
  const long n = rod.unknown_count(), band = kFields * (how.order + 1);
  if (how.method == Method::kStrain) return n + n * n * n / kFullProducts;
  if (how.method == Method::kCollocation) return n + n * band * band / kBandProducts;
  return n;
}

RodBetween::RodBetween(const Problem& whole, long& eliminating, const Robot& robot, RobotRod& rod,
                       const StageRates& rates)
    : whole_(whole),
      eliminating_(eliminating),
      rod_(rod),
      rates_(rates),
      base_(robot.port(rod.base)),
      tip_(robot.port(rod.tip)),
      freedoms_(robot.plane ? 3 : 6),
      forcing_(rod.forcing),
      start_(rod.model->unknowns()) {}

ProblemResidual RodBetween::evaluate() {
  const RodResidual r = rod_.model->evaluate(base_, tip_);
  worst_row_ = r.worst_row;
  return {0.5 * r.sum_squares, r.largest, r.finite};
}

bool RodBetween::find_direction(double mu) {
  CondensedRod c;
  ++factorizations_;
  eliminating_ += direction_work(*rod_.model);
  if (!rod_.model->linearize(base_, tip_, c)) return false;
  growth_ = c.growth;
  const MatX T = c.T.topLeftCorner(freedoms_, freedoms_);
  const VecX t = c.t.head(freedoms_);
  predicted_merit_ = 0;
  VecX x;
  if (mu == 0) {
    if (!solve_square(T, t, kSingularPivot, x)) {
      // if the rows can be met all the same, the smallest change that does so is as good as any
      x = least_norm_solution(T, t, kSingularPivot);
      if (!((T * x - t).norm() <= kConsistent * t.norm())) return false;
    }
  } else {
    MatX N = T.transpose() * T;
    const double floor = 1e-8 * N.diagonal().maxCoeff();
    N.diagonal() += mu * N.diagonal().cwiseMax(floor);
    x = solve_symmetric(N, T.transpose() * t);
    predicted_merit_ = 0.5 * (t - T * x).squaredNorm();
  }
  if (!x.allFinite()) return false;
  Vec6 z = Vec6::Zero();
  z.head(freedoms_) = -x;
  rod_.model->set_direction(z, Vec6::Zero());
  return true;
}

void RodBetween::set_fraction(double fraction) {
  if (fraction < 1 && !gap_captured_) {
    rod_.model->capture_gap(base_, tip_);
    gap_captured_ = true;
  }
  rod_.model->hold_gap(gap_captured_ ? 1 - fraction : 0);
  prepare();
}

void RodBetween::set_relaxation(double drag) {
  forcing_.relaxation = drag * rod_.section.K_bt.head<2>().maxCoeff() / std::pow(rod_.length, 4);
  rod_.model->mark_positions();
  prepare();
}

void RodBetween::set_softness(double softness) {
  forcing_.axial_softness = softness;
  prepare();
}

void RodBetween::restart() {
  rod_.model->set_unknowns(start_);
  gap_captured_ = false;
  rod_.model->hold_gap(0);
  prepare();
  evaluate();
}

void RodBetween::prepare() {
  rod_.model->prepare(rates_, forcing_);
}

}  // namespace cprsim
