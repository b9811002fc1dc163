// SPDX-License-Identifier: BSD-3-Clause
#include "tools/series/alignment.h"

#include <cmath>

#include "engine/math/linear_solve.h"

namespace cprsim {

namespace {

Mat3 about_z(double angle) {
  return Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
}

/// Horn's matrix of S = sum r x^T; its eigenvector is the quaternion w x y z.
Mat3 best_turn(const Mat3& S) {
  MatX N(4, 4);
  N(0, 0) = S.trace();
  const Vec3 skew(S(1, 2) - S(2, 1), S(2, 0) - S(0, 2), S(0, 1) - S(1, 0));
  N.block(0, 1, 1, 3) = skew.transpose();
  N.block(1, 0, 3, 1) = skew;
  N.block(1, 1, 3, 3) = S + S.transpose() - S.trace() * Mat3::Identity();
  const VecX q = symmetric_modes(N, MatX::Identity(4, 4)).vectors.col(3);
  return Quat(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

void store(Series& series, const SeriesQuantity& quantity, std::size_t row, const Vec4& value) {
  for (std::size_t i = 0; i < quantity.width(); ++i)
    series.columns[quantity.columns[i]].values[row] = value[static_cast<Eigen::Index>(i)];
}

Vec4 entries(const Quat& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}

/// Curvatures and stretches are in section axes: no frame of the world turns them.
bool in_world_axes(const std::string& name) {
  for (const char* end : {"position", "velocity", "force", "moment"})
    if (name.ends_with(end)) return true;
  return false;
}

}  // namespace

Pose fit_frame(Alignment alignment, const MatX& x, const MatX& r) {
  Pose X;
  if (alignment == Alignment::kNone || x.cols() == 0) return X;
  const Vec3 x_mean = x.rowwise().mean(), r_mean = r.rowwise().mean();
  const Mat3 S = (r.colwise() - r_mean) * (x.colwise() - x_mean).transpose();
  if (alignment == Alignment::kYaw) X.R = about_z(std::atan2(S(0, 1) - S(1, 0), S(0, 0) + S(1, 1)));
  if (alignment == Alignment::kFull) X.R = best_turn(S);
  X.p = x_mean - X.R * r_mean;
  return X;
}

void change_frame(Series& reference, const Pose& X) {
  for (const SeriesQuantity& quantity : quantities_of(reference)) {
    const bool vector = quantity.kind == QuantityKind::kVector && in_world_axes(quantity.name);
    const bool position = vector && quantity.name.ends_with("position");
    for (std::size_t row = 0; row < reference.size(); ++row) {
      Vec4 value = value_at(reference, quantity, row);
      if (quantity.kind == QuantityKind::kAttitude) {
        value = entries(Quat(X.R) * quaternion(value));
      } else if (vector) {
        value.head<3>() = X.R * value.head<3>() + (position ? X.p : Vec3(Vec3::Zero()));
      }
      store(reference, quantity, row, value);
    }
  }
}

void put_tangent_on_z(Series& reference) {
  Mat3 R_old_new;
  R_old_new << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // columns: old y, old z, old x
  for (const SeriesQuantity& quantity : quantities_of(reference)) {
    if (quantity.kind != QuantityKind::kAttitude) continue;
    for (std::size_t row = 0; row < reference.size(); ++row)
      store(reference, quantity, row,
            entries(quaternion(value_at(reference, quantity, row)) * Quat(R_old_new)));
  }
}

}  // namespace cprsim
