// SPDX-License-Identifier: BSD-3-Clause
#include "collision/convert.h"

#include <LinearMath/btTransform.h>

namespace cprsim {

btVector3 to_bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

btTransform to_bullet(const Pose& X) {
  const Mat3& R = X.R;
  const btMatrix3x3 basis(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1),
                          R(2, 2));
  return btTransform(basis, to_bullet(X.p));
}

Vec3 from_bullet(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

Pose from_bullet(const btTransform& X) {
  Pose pose;
  for (int i = 0; i < 3; ++i)
    pose.R.row(i) = from_bullet(X.getBasis()[i]);
  pose.p = from_bullet(X.getOrigin());
  return pose;
}

Pose scaled(const Pose& X, double by) {
  return {X.R, by * X.p};
}

}  // namespace cprsim
