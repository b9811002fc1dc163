// SPDX-License-Identifier: BSD-3-Clause
// What a plane leaves of motions, wrenches and rows; everything where there is none.
#include "engine/robot/equations.h"

namespace cprsim {

void Equations::set_plane() {
  in_plane_.setZero();
  if (!robot_.plane) return;
  freedoms_ = 3;
  in_plane_.topLeftCorner<3, 1>() = robot_.plane->col(2);
  in_plane_.bottomRightCorner<3, 2>() = robot_.plane->leftCols<2>();
}

// No row holds what leaves the plane: extrapolated, its round-off would grow from step to step.
Vec6 Equations::left_by_plane(const Vec6& v) const {
  if (!robot_.plane) return v;
  const Vec3 left = in_plane_.transpose() * v;
  return in_plane_ * left;
}

Vec6 Equations::in_space(const double* part) const {
  if (!robot_.plane) return Eigen::Map<const Vec6>(part);
  return in_plane_ * Eigen::Map<const Vec3>(part);
}

// Six rows (moment or turn, force or shift) written in `axes`.
void Equations::note_rows(const Mat3& axes, const Vec6& rows, Worst where, ProblemResidual& r) {
  if (!robot_.plane) {
    for (where.row = 0; where.row < 6; ++where.row)
      note(rows[where.row], where, r);
    return;
  }
  Vec6 in_world;
  in_world << axes * rows.head<3>(), axes * rows.tail<3>();
  const Vec3 left = in_plane_.transpose() * in_world;
  for (where.row = 0; where.row < 3; ++where.row)
    note(left[where.row], where, r);
}

}  // namespace cprsim
