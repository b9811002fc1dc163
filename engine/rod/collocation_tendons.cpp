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

// Rows (2), (3) of engine/rod/collocation_point.h; those of joins stand between the pieces.
void CollocationRod::assemble_tensions() {
  int row = static_cast<int>(space_.freedoms()) + 1;
  const int first = affine() + 1 + force_columns();
  for (std::size_t g = 0; g < pieces_.size(); ++g) {
    if (g > 0) row += width();
    for (int i = 0; i < pieces_[g].points; ++i, row += width()) {
      const auto j = static_cast<std::size_t>(pieces_[g].first_point + i);
      for (int k = 0; k < tension_columns(); ++k) {
        const Vec6 Lambda = tendons_->unit(k) * tendons_->per_unknown(k, j);
        Vec13 by = Vec13::Zero();
        by.segment<3>(kQ + 1) = model(j).C_bt.cwiseProduct(Lambda.head<3>());
        by.segment<3>(kP) = points_[j].R * model(j).C_se.cwiseProduct(Lambda.tail<3>());
        for (int r = 0; r < width(); ++r)
          system_.dense(row + r, first + k) = rows_.row(r).dot(by);
      }
    }
  }
}

/// Increments of all control points, one after another.
void CollocationRod::find_directions(const MatX& cases, MatX& directions) {
  const MatX x = system_.substitute(last_ * cases, cases.bottomRows(given()));
  const Vec13 units = increment_units();
  const auto n = static_cast<Eigen::Index>(control_.size());
  directions.resize(13 * n, cases.cols());
  for (Eigen::Index c = 0; c < cases.cols(); ++c)
    for (Eigen::Index k = 0; k < n; ++k) {
      Vec13 increment = Vec13::Zero();
      for (int i = 0; i < width(); ++i)
        increment += x(k * width() + i, c) * increments_.col(i);
      directions.col(c).segment<13>(13 * k) = units.cwiseProduct(increment);
    }
}

// du from row (2) of a point without compliance, dv = R^T (dp_s + p_s × phi).
void CollocationRod::strain_rates(const Eigen::Ref<const VecX>& direction,
                                  std::vector<Vec6>& rates) const {
  // of a control point, and the derivative of its fields
  const auto moving = [&](int k) {
    const Vec13 d = direction.segment<13>(13 * static_cast<Eigen::Index>(k));
    Vec13 by;
    by << quaternion_by_increment(Vec4(control_[static_cast<std::size_t>(k)].head<4>())) *
              d.head<4>(),
        d.tail<9>();
    return by;
  };
  PointModel rigid = model_;
  rigid.C_bt.setZero();
  rates.resize(points_.size());
  Mat13 by_y, by_y_s;
  for (std::size_t j = 0; j < points_.size(); ++j) {
    const CollocationPoint& point = points_[j];
    Vec13 y = Vec13::Zero(), y_s = Vec13::Zero();
    for (int i = 0; i <= options_.degree; ++i) {
      const Vec13 control = moving(sites_[j].basis.first + i);
      y += sites_[j].basis.value[i] * control;
      y_s += sites_[j].basis.slope[i] / forcing_.length * control;
    }
    linearize_point(rigid, point, by_y, by_y_s);
    const Vec3 phi = turn_by_quaternion(Vec4(point.y.head<4>())) * y.head<4>();
    const Vec3 p_s = point.y_s.segment<3>(kP);
    rates[j] << (by_y * y + by_y_s * y_s).segment<3>(kQ + 1),
        point.R.transpose() * (y_s.segment<3>(kP) + p_s.cross(phi));
  }
}

}  // namespace cprsim
