// SPDX-License-Identifier: BSD-3-Clause
// Tendons along a shooting rod: where they are asked, and tensions among the unknowns.
#include <cmath>

#include "engine/math/so3.h"
#include "engine/rod/arc_grid.h"
#include "engine/rod/shooting_open.h"

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

/// Of shared contacts and echoes, as last set.
VecX ShootingRod::open_forces() const {
  const auto count = 3 * static_cast<Eigen::Index>(open_->contacts.size());
  return port_scale_.force * open_->weights.head(count);
}

void ShootingRod::find_direction_in_case(const Eigen::Ref<const VecX>& column) {
  Open& open = *open_;
  const auto forces = 3 * static_cast<Eigen::Index>(open.contacts.size());
  open.weights.setZero();
  open.weights.head(forces) = column.segment(13, forces) / port_scale_.force;
  open.weights.segment(Open::kUsed * static_cast<Eigen::Index>(open.force_blocks), open.tensions) =
      column.tail(open.tensions);
  find_direction(column.head<6>(), column.segment<6>(6), column[12]);
}

// Of all lifted unknowns: strains follow from them.
void ShootingRod::find_directions(const MatX& cases, MatX& directions) {
  directions.resize(cells_ * kernel_->lifted, cases.cols());
  note_turning();
  for (Eigen::Index c = 0; c < cases.cols(); ++c) {
    find_direction_in_case(cases.col(c));
    directions.col(c) = Eigen::Map<const VecX>(lifted_direction_.data(), directions.rows());
  }
}

// u - u0 - C_bt (R^T m - Lambda_m), v - v0 - C_se (R^T n - Lambda_n)
void ShootingRod::find_tension_sources() {
  Open& open = *open_;
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto lifted = static_cast<std::size_t>(kernel_->lifted),
             cells = static_cast<std::size_t>(cells_);
  const std::size_t blocks = open.block_count() - open.force_blocks;
  open.sources.assign(blocks * cells * lifted * kWide, 0);
  for (Eigen::Index k = 0; k < open.tensions; ++k) {
    const double unit = tendons_->unit(k);
    const auto block = static_cast<std::size_t>(k / Open::kUsed),
               column = static_cast<std::size_t>(k % Open::kUsed);
    for (std::size_t j = 0; j < stages_.size(); ++j) {
      const CellSection& at = coefficients_at(j);
      const Vec6 Lambda = unit * tendons_->per_unknown(k, j);
      double* rows = &open.sources[(block * cells + j / S) * lifted * kWide] + column;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto e = static_cast<Eigen::Index>(i);
        rows[(3 * (j % S) + i) * kWide] = at.C_bt[i] * Lambda[e];
        rows[(3 * S + 3 * (j % S) + i) * kWide] = at.C_se[i] * Lambda[3 + e];
      }
    }
  }
}

const double* ShootingRod::tension_sources(std::size_t cell, std::size_t block) const {
  const auto lifted = static_cast<std::size_t>(kernel_->lifted),
             cells = static_cast<std::size_t>(cells_);
  return &open_->sources[(block * cells + cell) * lifted * kWide];
}

void ShootingRod::note_turning() {
  turning_.resize(2 * stages_.size());
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const Vec3 Omega = vector_at(stages_[j].Omega);
    turning_[2 * j] = right_jacobian(Omega);
    turning_[2 * j + 1] = right_jacobian_derivative(Omega, vector_at(stages_[j].w));
  }
}

// du = J_r dw + D dOmega, after note_turning()
void ShootingRod::strain_rates(const Eigen::Ref<const VecX>& direction,
                               std::vector<Vec6>& rates) const {
  const auto S = static_cast<std::size_t>(table_->stages);
  rates.resize(stages_.size());
  const double* d = direction.data();
  for (std::size_t c = 0; c < static_cast<std::size_t>(cells_); ++c, d += kernel_->lifted)
    for (std::size_t j = 0; j < S; ++j) {
      Vec3 dOmega = Vec3::Zero();
      for (std::size_t k = 0; k < S; ++k)
        dOmega += cell_length(c) * table_->a[j][k] * vector_at(d + 3 * k);
      const Mat3* turning = &turning_[2 * (c * S + j)];
      rates[c * S + j] << turning[0] * vector_at(d + 3 * j) + turning[1] * dOmega,
          vector_at(d + 3 * S + 3 * j);
    }
}

}  // namespace cprsim
