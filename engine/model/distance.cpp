// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cprsim {
namespace {

/// (1) for the nearest point y = x - gap; P as its diagonal.
Distance from_gap(const Vec3& gap, const Vec3& P) {
  Distance out;
  out.d = gap.norm();
  out.n = gap / out.d;
  out.H = (Mat3(P.asDiagonal()) - out.n * out.n.transpose()) / out.d;
  return out;
}

/// A box of half edges b with everything within r of it: box, capsule (no width) and sphere (no
/// size).
Distance to_round_box(const Vec3& b, double r, const Vec3& x) {
  const Vec3 y = x.cwiseMax(-b).cwiseMin(b), gap = x - y;
  if (gap.isZero(0)) {
    // inside: the nearest face
    int face = 0;
    const double depth = (b - x.cwiseAbs()).minCoeff(&face);
    Distance out;
    out.d = -depth - r;
    out.n = std::copysign(1.0, x[face]) * Vec3::Unit(face);
    return out;
  }
  Vec3 P;
  for (int i = 0; i < 3; ++i)
    P[i] = gap[i] != 0 || b[i] == 0 ? 1 : 0;
  Distance out = from_gap(gap, P);
  out.d -= r;
  return out;
}

using Profile2 = std::array<Vec2, 5>;  // corners (rho, z), counter-clockwise; the last may repeat

struct PlaneDistance {
  double d = 0;
  Vec2 n = Vec2::UnitX();
  double bend = 0;  ///< H = bend t t^T, t across n
};

/// Distance to a convex polygon whose side on the axis is no boundary.
PlaneDistance to_profile(const Profile2& corners, const Vec2& x) {
  PlaneDistance inside, outside;
  inside.d = -std::numeric_limits<double>::infinity();
  outside.d = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Vec2 a = corners[i], side = corners[i + 1] - a;
    const double length = side.norm();
    if (length == 0) continue;
    const Vec2 t = side / length, n(t.y(), -t.x());
    const double along = t.dot(x - a), across = n.dot(x - a);
    if (across > inside.d) inside = {across, n, 0};
    const Vec2 gap = x - a - std::clamp(along, 0.0, length) * t;
    const double d = gap.norm();
    if (across <= 0 && along >= 0 && along <= length) continue;
    if (d >= outside.d || d == 0) continue;
    outside = {d, gap / d, along > 0 && along < length ? 0 : 1 / d};
  }
  return inside.d <= 0 ? inside : outside;
}

Distance to_revolution(const Profile2& corners, const Vec3& x) {
  const double rho = std::hypot(x.x(), x.y());
  const PlaneDistance flat = to_profile(corners, {rho, x.z()});
  const Vec3 e = rho > 0 ? Vec3(x.x() / rho, x.y() / rho, 0) : Vec3(Vec3::UnitX());
  const Vec3 e_phi(-e.y(), e.x(), 0), z = Vec3::UnitZ();
  Distance out;
  out.d = flat.d;
  out.n = flat.n.x() * e + flat.n.y() * z;
  const Vec3 t = flat.n.y() * e - flat.n.x() * z;
  out.H = flat.bend * t * t.transpose();
  if (rho > 0) out.H += flat.n.x() / rho * e_phi * e_phi.transpose();
  return out;
}

/// t of (2) plus the least a_i², which `above` is the others' rise over. (2) falls and bends
/// upwards: from a t that is too small Newton's steps never pass the root. Halving is for
/// round-off.
double ellipsoid_parameter(const Vec3& above, const Vec3& ax) {
  double low = (ax - above).maxCoeff(), high = ax.norm();
  double t = low;
  for (int i = 0; i < 100; ++i) {
    const Vec3 below = above + Vec3::Constant(t), y = ax.cwiseQuotient(below);
    const double f = y.squaredNorm() - 1, slope = -2 * y.cwiseProduct(y).cwiseQuotient(below).sum();
    (f > 0 ? low : high) = t;
    double next = t - f / slope;
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 1e-15 * t) return next;
    t = next;
  }
  return t;
}

/// With the nearest point y and the axes a_i,  y_i = a_i² x_i / (a_i² + t),
///   sum_i (a_i x_i / (a_i² + t))² = 1,  n ~ y_i / a_i²,  d = n . (x - y)               (2)
///   H = (I + d S)^-1 S,  S = P diag(1 / a_i²) P / |y_i / a_i²|,  P = I - n n^T          (3)
/// S being the curvature of the surface at y (Eberly, Distance from a point to an ellipsoid, 2011).
Distance to_ellipsoid(const Vec3& axes, const Vec3& x) {
  const Vec3 a2 = axes.cwiseAbs2(), ax = axes.cwiseProduct(x.cwiseAbs());
  int thin = 0;
  const double least = a2.minCoeff(&thin);
  const Vec3 above = a2 - Vec3::Constant(least);
  // deep inside the middle plane t is as small as can be, and what is nearest lies above and below
  Vec3 flat = Vec3::Zero();
  bool middle = true;
  for (int i = 0; i < 3; ++i) {
    if (above[i] > 0) flat[i] = a2[i] * x[i] / above[i];
    middle = middle && (above[i] > 0 || ax[i] == 0);
  }
  const double rest = 1 - flat.cwiseQuotient(axes).squaredNorm();
  Vec3 y = flat;
  if (middle && rest > 0) {
    y[thin] = axes[thin] * std::sqrt(rest);
  } else {
    y = a2.cwiseProduct(x).cwiseQuotient(above + Vec3::Constant(ellipsoid_parameter(above, ax)));
  }
  const Vec3 slope = y.cwiseQuotient(a2);
  Distance out;
  out.n = slope.normalized();
  out.d = out.n.dot(x - y);
  const Mat3 P = Mat3::Identity() - out.n * out.n.transpose();
  const Mat3 S = P * a2.cwiseInverse().asDiagonal() * P / slope.norm();
  const Mat3 spread = Mat3::Identity() + out.d * S;
  // where surface normals meet, deep inside, there is no curvature
  if (spread.determinant() > 1e-3) out.H = spread.inverse() * S;
  return out;
}

}  // namespace

Distance distance_to(const ShapeSpec& shape, const Vec3& x) {
  const double a = shape.size.x(), b = 0.5 * shape.size.y();
  switch (shape.kind) {
    case ShapeKind::kBox:
      return to_round_box(0.5 * shape.size, 0, x);
    case ShapeKind::kSphere:
      return to_round_box(Vec3::Zero(), a, x);
    case ShapeKind::kCapsule:
      return to_round_box({0, 0, b}, a, x);
    case ShapeKind::kCylinder:
      return to_revolution({Vec2(0, -b), Vec2(a, -b), Vec2(a, b), Vec2(0, b), Vec2(0, b)}, x);
    case ShapeKind::kCone:
      return to_revolution({Vec2(0, -b), Vec2(a, -b), Vec2(0, b), Vec2(0, b), Vec2(0, b)}, x);
    case ShapeKind::kTube: {
      const double i = shape.size.z();
      return to_revolution({Vec2(i, -b), Vec2(a, -b), Vec2(a, b), Vec2(i, b), Vec2(i, -b)}, x);
    }
    case ShapeKind::kEllipsoid:
      return to_ellipsoid(shape.size, x);
    default:
      break;
  }
  Distance plane;
  plane.n = shape.normal.normalized();
  plane.d = plane.n.dot(x);
  return plane;
}

Distance carried(const Distance& at, const Mat3& R) {
  return {at.d, R * at.n, R * at.H * R.transpose()};
}

Distance distance_to(const ShapeSpec& shape, const Pose& X_WC, const Vec3& x) {
  return carried(distance_to(shape, X_WC.inverse() * x), X_WC.R);
}

}  // namespace cprsim
