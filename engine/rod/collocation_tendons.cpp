// SPDX-License-Identifier: BSD-3-Clause
// Tendons along a rod of splines: where they are asked, and tensions among the unknowns.
#include "engine/math/so3.h"
#include "engine/rod/arc_grid.h"
#include "engine/rod/collocation.h"

namespace cprsim {

void CollocationRod::place_tendons() {
  std::vector<AskedSection> sections;
  for (const Piece& piece : pieces_) {
    const auto first = static_cast<std::size_t>(piece.first_point),
               last = first + static_cast<std::size_t>(piece.points) - 1;
    // its first and last point stand where the next piece begins
    const double inside = 0.5 * (sites_[first].s + sites_[last].s);
    for (std::size_t j = first; j <= last; ++j)
      sections.push_back({sites_[j].s, inside, weights_[j], rest_curvature(sites_[j].s)});
  }
  tendons_ = std::make_unique<RodTendons>(options_.tendons, forcing_.length, sections,
                                          section_.K_bt.head<2>().maxCoeff(),
                                          all_stations(options_.stations, options_.along.get()));
}

const VecX& CollocationRod::tendon_gaps() {
  for (std::size_t j = 0; tendons_->rub() && j < points_.size(); ++j)
    tendons_->set_curvature(j, points_[j].u);
  return tendons_->gaps();
}

void CollocationRod::describe_tendons(const Site& at, RodField& field) const {
  CollocationPoint point;
  point.y = value(at);
  point.y_s = derivative(at);
  evaluate_point({}, point);
  MatX held;
  const Mat6 stiffness = tendons_->stiffness(at.s, at.s, point.u,
                                             point.R.transpose() * point.y_s.segment<3>(kP), &held);
  field.add_tendons(stiffness, held);
}

VecX CollocationRod::direction_given(const Vec6& z, const Vec6& zeta_A) {
  find_direction(z, zeta_A);
  return found_direction();
}

VecX CollocationRod::found_direction() const {
  VecX all(13 * static_cast<Eigen::Index>(direction_.size()));
  for (std::size_t k = 0; k < direction_.size(); ++k)
    all.segment<13>(13 * static_cast<Eigen::Index>(k)) = direction_[k];
  return all;
}

// Rows (2), (3) of engine/rod/collocation_point.h; those of joins stand between the pieces.
void CollocationRod::add_tension(Eigen::Index unknown, bool add) {
  if (!add) {
    residual_ = kept_residual_;
    return;
  }
  kept_residual_ = residual_;
  std::size_t row = 0;
  for (std::size_t g = 0; g < pieces_.size(); ++g) {
    row += g > 0;
    for (int i = 0; i < pieces_[g].points; ++i, ++row) {
      const auto j = static_cast<std::size_t>(pieces_[g].first_point + i);
      const Vec6 Lambda = tendons_->per_unknown(unknown, j);
      residual_[row].segment<3>(kQ + 1) += model(j).C_bt.cwiseProduct(Lambda.head<3>());
      residual_[row].segment<3>(kP) += points_[j].R * model(j).C_se.cwiseProduct(Lambda.tail<3>());
    }
  }
}

// du from row (2) of a point without compliance, dv = R^T (dp_s + p_s × phi).
std::vector<Vec6> CollocationRod::strain_rates(const VecX& direction) const {
  std::vector<Vec13> moving(control_.size());
  for (std::size_t k = 0; k < control_.size(); ++k) {
    const Vec13 d = direction.segment<13>(13 * static_cast<Eigen::Index>(k));
    moving[k] << quaternion_by_increment(Vec4(control_[k].head<4>())) * d.head<4>(), d.tail<9>();
  }
  PointModel rigid = model_;
  rigid.C_bt.setZero();
  std::vector<Vec6> rates(points_.size());
  Mat13 by_y, by_y_s;
  for (std::size_t j = 0; j < points_.size(); ++j) {
    const CollocationPoint& point = points_[j];
    Vec13 y = Vec13::Zero(), y_s = Vec13::Zero();
    for (int i = 0; i <= options_.degree; ++i) {
      const Vec13& control = moving[static_cast<std::size_t>(sites_[j].basis.first + i)];
      y += sites_[j].basis.value[i] * control;
      y_s += sites_[j].basis.slope[i] / forcing_.length * control;
    }
    linearize_point(rigid, point, by_y, by_y_s);
    const Vec3 phi = turn_by_quaternion(Vec4(point.y.head<4>())) * y.head<4>();
    const Vec3 p_s = point.y_s.segment<3>(kP);
    rates[j] << (by_y * y + by_y_s * y_s).segment<3>(kQ + 1),
        point.R.transpose() * (y_s.segment<3>(kP) + p_s.cross(phi));
  }
  return rates;
}

}  // namespace cprsim
