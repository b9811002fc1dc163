// SPDX-License-Identifier: BSD-3-Clause
#include "render/camera.h"

#include <algorithm>
#include <cmath>

#include "engine/math/so3.h"

namespace cprsim {

namespace {

/// Any unit vector normal to the unit vector n.
Vec3 normal_to(const Vec3& n) {
  return n.cross(std::abs(n.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX()).normalized();
}

/// Axes with z backwards, y as near to `up` as may be.
Mat3 look_along(const Vec3& forward, const Vec3& up) {
  const Vec3 back = -forward.normalized();
  Vec3 right = up.cross(back);
  right = right.norm() > 1e-9 * up.norm() ? Vec3(right.normalized()) : normal_to(back);
  Mat3 R;
  R << right, back.cross(right), back;
  return R;
}

}  // namespace

Mat4 to_matrix(const Pose& pose) {
  Mat4 M = Mat4::Identity();
  M.topLeftCorner<3, 3>() = pose.R;
  M.topRightCorner<3, 1>() = pose.p;
  return M;
}

Mat4 View::projection() const {
  Mat4 P = Mat4::Zero();
  P(0, 0) = 1 / tan_half_x;
  P(1, 1) = 1 / tan_half_y;
  P(2, 2) = -(far + near) / (far - near);
  P(2, 3) = -2 * far * near / (far - near);
  P(3, 2) = -1;
  Mat4 V = Mat4::Identity();
  V.topLeftCorner<3, 3>() = R_WC.transpose();
  V.topRightCorner<3, 1>() = -(R_WC.transpose() * eye);
  return P * V;
}

Vec2 View::to_pixel(const Vec3& p_W) const {
  const Vec3 c = to_camera(p_W);
  const double depth = std::max(-c.z(), 1e-12);
  return {0.5 * width * (1 + c.x() / (depth * tan_half_x)),
          0.5 * height * (1 + c.y() / (depth * tan_half_y))};
}

double View::pixel_size(const Vec3& p_W) const {
  return 2 * fineness * tan_half_x * std::max(-to_camera(p_W).z(), near) / width;
}

View make_view(const CameraSpec& camera, const Snapshot& now, double film_time, double scene_size,
               int width, int height) {
  View view;
  view.width = width;
  view.height = height;
  view.tan_half_x = std::tan(0.5 * std::clamp(camera.horizontal_fov, 0.01, 3.0));
  view.tan_half_y = view.tan_half_x * height / width;
  const Vec3 up = camera.up.norm() > 0 ? Vec3(camera.up.normalized()) : Vec3::UnitZ();
  Vec3 target = camera.look_at;
  if (camera.look_at_frame) {
    const FrameRef& frame = *camera.look_at_frame;
    const auto body = static_cast<std::size_t>(frame.body);
    Pose X_WF = frame.X_BF;
    if (frame.body >= 0 && body < now.bodies.size()) X_WF = now.bodies[body].X_WB * frame.X_BF;
    target = X_WF * camera.look_at;
  }
  view.eye = camera.eye;
  if (camera.orbit_rate != 0) {
    const Mat3 turn = exp_so3(camera.orbit_rate * film_time * up);
    view.eye = target + turn * (camera.eye - target);
  }
  Vec3 forward = target - view.eye;
  if (forward.norm() < 1e-9) forward = normal_to(up);
  view.R_WC = look_along(forward, up);
  const double distance = std::max(forward.norm(), 1e-3);
  view.near = 0.02 * std::min(distance, std::max(scene_size, 1e-3));
  view.far = 4 * (distance + scene_size);
  return view;
}

Mat4 light_projection(const Vec3& direction, const Vec3& centre, double radius) {
  const Mat3 R = look_along(direction, Vec3::UnitZ());
  Mat4 M = Mat4::Identity();
  M.topLeftCorner<3, 3>() = R.transpose() / radius;
  M.topRightCorner<3, 1>() = -(R.transpose() * centre) / radius;
  M.row(2) *= -1;  // depth grows along the light
  return M;
}

}  // namespace cprsim
