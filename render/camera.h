// SPDX-License-Identifier: BSD-3-Clause
// Where the picture is taken from: a camera of the scene, made concrete at one instant.
#pragma once

#include "engine/model/view_spec.h"
#include "engine/run/snapshot.h"

namespace cprsim {

using Mat4 = Eigen::Matrix4d;

Mat4 to_matrix(const Pose& pose);

/// A perspective view. Camera axes: x right, y up, z backwards out of the picture.
struct View {
  Vec3 eye = Vec3::Zero();
  Mat3 R_WC = Mat3::Identity();  ///< columns right, up, backwards
  double tan_half_x = 1, tan_half_y = 1;
  double near = 0.01, far = 100;
  int width = 0, height = 0;
  double fineness = 1;  ///< pixels drawn per pixel of the finished picture, along an edge

  Mat4 projection() const;  ///< world → clip coordinates

  Vec3 to_camera(const Vec3& p_W) const { return R_WC.transpose() * (p_W - eye); }

  /// Pixel coordinates, origin at the lower left corner; only for points in front of the eye.
  Vec2 to_pixel(const Vec3& p_W) const;

  /// Size in metres of a pixel of the finished picture at the depth of p_W.
  double pixel_size(const Vec3& p_W) const;

  bool operator==(const View&) const = default;
};

/// @param film_time  seconds of film, which turn an orbiting camera
/// @param scene_size metres, sets the range of depths that is seen
View make_view(const CameraSpec& camera, const Snapshot& now, double film_time, double scene_size,
               int width, int height);

/// Orthographic view along `direction` that just holds the ball of `radius` about `centre`:
/// world → clip coordinates.
Mat4 light_projection(const Vec3& direction, const Vec3& centre, double radius);

}  // namespace cprsim
