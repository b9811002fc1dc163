// SPDX-License-Identifier: BSD-3-Clause
// Tendons along a shooting rod: where they are asked, and tensions among the unknowns.
#include <cmath>

#include "engine/math/so3.h"
#include "engine/rod/arc_grid.h"
#include "engine/rod/shooting.h"

namespace cprsim {
namespace {

Vec3 vector_at(const double* x) {
  return {x[0], x[1], x[2]};
}

}  // namespace

void ShootingRod::place_tendons() {
  std::vector<AskedSection> sections;
  for (std::size_t c = 0; c < static_cast<std::size_t>(cells_); ++c)
    for (int j = 0; j < table_->stages; ++j) {
      const double from = grid_[c], h = grid_[c + 1] - from;
      const double s = from + h * table_->c[j];
      sections.push_back({s, from + 0.5 * h, h * table_->b[j], rest_curvature(s)});
    }
  tendons_ = std::make_unique<RodTendons>(options_.tendons, forcing_.length, sections,
                                          section_.K_bt.head<2>().maxCoeff(),
                                          all_stations(options_.stations, options_.along.get()));
}

const VecX& ShootingRod::tendon_gaps() {
  for (std::size_t j = 0; tendons_->rub() && j < stages_.size(); ++j)
    tendons_->set_curvature(j, vector_at(stages_[j].u));
  return tendons_->gaps();
}

// Starts of segments, lifted unknowns, contact forces.
VecX ShootingRod::direction_given(const Vec6& z, const Vec6& zeta_A) {
  find_direction(z, zeta_A);
  return found_direction();
}

VecX ShootingRod::found_direction() const {
  const auto starts = static_cast<Eigen::Index>(12 * start_direction_.size()),
             lifted = static_cast<Eigen::Index>(lifted_direction_.size());
  VecX all(starts + lifted + 3 * static_cast<Eigen::Index>(contact_count()));
  for (std::size_t g = 0; g < start_direction_.size(); ++g)
    all.segment<12>(static_cast<Eigen::Index>(12 * g)) = start_direction_[g];
  all.segment(starts, lifted) = Eigen::Map<const VecX>(lifted_direction_.data(), lifted);
  for (std::size_t i = 0; i < contact_count(); ++i)
    all.segment<3>(starts + lifted + static_cast<Eigen::Index>(3 * i)) = touch_->direction[i];
  return all;
}

void ShootingRod::take_direction(const VecX& all) {
  start_direction_.resize(starts_.size());
  lifted_direction_.resize(static_cast<std::size_t>(cells_ * kernel_->lifted));
  const double* from = all.data();
  for (Vec12& start : start_direction_) {
    start = Eigen::Map<const Vec12>(from);
    from += 12;
  }
  std::copy_n(from, lifted_direction_.size(), lifted_direction_.begin());
  from += lifted_direction_.size();
  for (std::size_t i = 0; i < contact_count(); ++i, from += 3)
    touch_->direction[i] = vector_at(from);
  tension_direction_ = all.tail(tendons_->unknowns());
}

// u - u0 - C_bt (R^T m - Lambda_m), v - v0 - C_se (R^T n - Lambda_n)
void ShootingRod::add_tension(Eigen::Index unknown, bool add) {
  if (!add) {
    stages_ = kept_stages_;
    return;
  }
  kept_stages_ = stages_;
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const CellSection& at = coefficients_at(j);
    const Vec6 Lambda = tendons_->per_unknown(unknown, j);
    for (int i = 0; i < 3; ++i) {
      stages_[j].residual_u[i] += at.C_bt[i] * Lambda[i];
      stages_[j].residual_v[i] += at.C_se[i] * Lambda[3 + i];
    }
  }
}

std::vector<Vec6> ShootingRod::strain_rates(const VecX& direction) const {
  const auto S = static_cast<std::size_t>(table_->stages);
  std::vector<Vec6> rates(stages_.size());
  const double* d = direction.data() + 12 * starts_.size();
  for (std::size_t c = 0; c < static_cast<std::size_t>(cells_); ++c, d += kernel_->lifted)
    for (std::size_t j = 0; j < S; ++j) {
      const CellStage& stage = stages_[c * S + j];
      Vec3 dOmega = Vec3::Zero();
      for (std::size_t k = 0; k < S; ++k)
        dOmega += cell_length(c) * table_->a[j][k] * vector_at(d + 3 * k);
      const Vec3 Omega = vector_at(stage.Omega);
      rates[c * S + j] << right_jacobian(Omega) * vector_at(d + 3 * j) +
                              right_jacobian_derivative(Omega, vector_at(stage.w)) * dOmega,
          vector_at(d + 3 * S + 3 * j);
    }
  return rates;
}

}  // namespace cprsim
