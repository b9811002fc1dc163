// SPDX-License-Identifier: BSD-3-Clause
// Between Eigen and Bullet, and between metres and the millimetres of Bullet's world.
#pragma once

#include "engine/math/types.h"

class btVector3;
class btTransform;

namespace cprsim {

/// World units per metre. In millimetres, without margins, double precision finds gaps to 3e-10 m;
/// in metres the absolute tolerances inside Bullet's GJK miss a tenth of the contacts of small
/// shapes.
constexpr double kUnitsPerMetre = 1000, kU = kUnitsPerMetre;

btVector3 to_bullet(const Vec3& v);
btTransform to_bullet(const Pose& X);
Vec3 from_bullet(const btVector3& v);
Pose from_bullet(const btTransform& X);

/// Changes the unit of length of a pose.
Pose scaled(const Pose& X, double by);

}  // namespace cprsim
