// SPDX-License-Identifier: BSD-3-Clause
#include "render/camera.h"

#include <gtest/gtest.h>

namespace cprsim {
namespace {

CameraSpec camera() {
  CameraSpec spec;
  spec.eye = {1, -2, 1.5};
  spec.look_at = {0.1, 0.2, 0.3};
  spec.horizontal_fov = 0.8;
  return spec;
}

TEST(Camera, LooksAtItsTargetWithUpUp) {
  const View view = make_view(camera(), {}, 0, 1, 640, 360);
  EXPECT_LT((view.to_pixel(camera().look_at) - Vec2(320, 180)).norm(), 1e-9);
  EXPECT_GT(view.to_pixel(camera().look_at + Vec3(0, 0, 0.1)).y(), 180);
  EXPECT_NEAR(view.to_pixel(camera().look_at + Vec3(0, 0, 0.1)).x(), 320, 1e-9);
}

TEST(Camera, FieldOfViewSpansTheWidth) {
  const View view = make_view(camera(), {}, 0, 1, 640, 360);
  const Vec3 forward = -view.R_WC.col(2), right = view.R_WC.col(0);
  EXPECT_NEAR(view.to_pixel(view.eye + forward + std::tan(0.4) * right).x(), 640, 1e-9);
}

TEST(Camera, ProjectionAgreesWithPixels) {
  const View view = make_view(camera(), {}, 0, 1, 640, 360);
  const Vec3 p(0.3, -0.1, 0.5);
  const Vec4 clip = view.projection() * Vec4(p.x(), p.y(), p.z(), 1);
  const Vec2 at = view.to_pixel(p);
  EXPECT_NEAR(320 * (1 + clip.x() / clip.w()), at.x(), 1e-9);
  EXPECT_NEAR(180 * (1 + clip.y() / clip.w()), at.y(), 1e-9);
}

TEST(Camera, OrbitKeepsDistanceAndHeight) {
  CameraSpec spec = camera();
  spec.orbit_rate = 0.5;
  const View a = make_view(spec, {}, 0, 1, 640, 360), b = make_view(spec, {}, 2, 1, 640, 360);
  EXPECT_NEAR((a.eye - spec.look_at).norm(), (b.eye - spec.look_at).norm(), 1e-12);
  EXPECT_NEAR(a.eye.z(), b.eye.z(), 1e-12);
  const Vec2 u = (a.eye - spec.look_at).head<2>(), v = (b.eye - spec.look_at).head<2>();
  EXPECT_NEAR(u.dot(v), u.norm() * v.norm() * std::cos(1.0), 1e-12) << "0.5 rad/s for 2 s";
}

TEST(Camera, FollowsAFrameOfABody) {
  CameraSpec spec = camera();
  spec.look_at = {0, 0, 0.1};
  spec.look_at_frame = FrameRef{0, {Mat3::Identity(), Vec3(0.2, 0, 0)}};
  Snapshot now;
  now.bodies.resize(1);
  now.bodies[0].X_WB.p = {0, 0.5, 0};
  const View view = make_view(spec, now, 0, 1, 640, 360);
  EXPECT_LT((view.to_pixel(Vec3(0.2, 0.5, 0.1)) - Vec2(320, 180)).norm(), 1e-9);
}

TEST(Camera, LooksStraightDownWithoutBreaking) {
  CameraSpec spec = camera();
  spec.eye = spec.look_at + Vec3(0, 0, 2);
  const View view = make_view(spec, {}, 0, 1, 640, 360);
  EXPECT_TRUE(view.R_WC.allFinite());
  EXPECT_NEAR(view.R_WC.determinant(), 1, 1e-12);
}

}  // namespace
}  // namespace cprsim
