// SPDX-License-Identifier: BSD-3-Clause
// Distance of a point to the surface of a shape, exact and with its first two derivatives:
// what the tangent of a contact needs. With y the nearest point of the solid,
//   d = |x - y|,   n = dd/dx = (x - y) / d,   H = dn/dx = (P - n n^T) / d (1)
// where P projects on the directions in which y stays where it is: none on a face, those across an
// edge, all at a corner. A surface of revolution adds (n_rho / rho) e_phi e_phi^T.
#pragma once

#include "engine/math/types.h"
#include "engine/model/geometry.h"

namespace cprsim {

struct Distance {
  double d = 0;            ///< positive outside
  Vec3 n = Vec3::UnitZ();  ///< outward normal, unit
  Mat3 H = Mat3::Zero();
};

/// Of all shapes but meshes (engine/model/mesh_distance.h).
/// @param x in the shape's frame. Inside the solid d is negative and n points to the nearest face.
Distance distance_to(const ShapeSpec& shape, const Vec3& x);

/// The same with the shape's frame at X_WC and x in the world.
Distance distance_to(const ShapeSpec& shape, const Pose& X_WC, const Vec3& x);

/// Seen from axes in which the shape's are the columns of R.
Distance carried(const Distance& at, const Mat3& R);

}  // namespace cprsim
