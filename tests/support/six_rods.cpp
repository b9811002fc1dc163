// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/six_rods.h"

#include <array>
#include <cmath>
#include <numbers>

#include "engine/math/so3.h"

namespace cprsim {

namespace {

constexpr int kPoints = 51;
constexpr double kBendingStiffness = 0.157;  // N m², a round 2 mm steel rod
constexpr double kPi = std::numbers::pi;

const std::array<Vec3, 6> kBase{{{0.08568, -0.01511, 0},
                                 {0.08568, 0.01511, 0},
                                 {-0.02976, 0.08175, 0},
                                 {-0.05592, 0.06665, 0},
                                 {-0.05592, -0.06665, 0},
                                 {-0.02976, -0.08175, 0}}};
const std::array<Vec3, 6> kPlatform{{{0.05592, -0.06665, 0},
                                     {0.05592, 0.06665, 0},
                                     {0.02976, 0.08175, 0},
                                     {-0.08568, 0.01511, 0},
                                     {-0.08568, -0.01511, 0},
                                     {0.02976, -0.08175, 0}}};

BodySpec plate(const std::string& name, double radius, const Pose& X_WB) {
  BodySpec body;
  body.name = "robot::" + name;
  body.X_WB = X_WB;
  body.mass = 0.1;
  VisualSpec visual;
  visual.name = "plate";
  visual.shape.kind = ShapeKind::kCylinder;
  visual.shape.size = {radius, 0.006, 0};
  body.visuals.push_back(visual);
  return body;
}

Pose platform_pose(double t) {
  const double w = 2 * kPi * 0.5;
  const Vec3 p(0.05 * std::sin(w * t), 0.04 * std::sin(2 * w * t + 0.4),
               0.40 + 0.03 * std::sin(w * t + 1));
  const Mat3 tilt = exp_so3({0, 0.22 * std::sin(w * t + 0.5), 0}) *
                    exp_so3({0.18 * std::cos(w * t), 0, 0}) *
                    exp_so3({0, 0, 0.35 * std::sin(w * t)});
  return {tilt, p};
}

/// Cubic from a to b with end directions da and db; k-th derivative at u in [0,1].
Vec3 cubic(const Vec3& a, const Vec3& da, const Vec3& b, const Vec3& db, double u, int k) {
  const Vec3 c2 = 3 * (b - a) - 2 * da - db, c3 = 2 * (a - b) + da + db;
  if (k == 0) return a + u * (da + u * (c2 + u * c3));
  if (k == 1) return da + u * (2 * c2 + 3 * u * c3);
  return 2 * c2 + 6 * u * c3;
}

RodSample rod_between(const Vec3& a, const Vec3& b, const Vec3& z_b) {
  RodSample rod;
  rod.radius = 0.001;
  const Vec3 da = 0.45 * Vec3::UnitZ(), db = 0.45 * z_b;
  for (int k = 0; k < kPoints; ++k) {
    RodPoint point;
    point.s = static_cast<double>(k) / (kPoints - 1);
    const Vec3 d1 = cubic(a, da, b, db, point.s, 1), d2 = cubic(a, da, b, db, point.s, 2);
    const Vec3 tangent = d1.normalized(), bending = d1.cross(d2) / std::pow(d1.norm(), 3);
    point.position = cubic(a, da, b, db, point.s, 0);
    point.rotation = rotation_between(Vec3::UnitZ(), tangent);
    point.curvature = point.rotation.transpose() * bending;
    point.moment = kBendingStiffness * bending;
    rod.length += d1.norm() / (kPoints - 1);
    rod.points.push_back(point);
  }
  return rod;
}

}  // namespace

Scene six_rods_scene() {
  Scene scene;
  scene.name = "six_rods";
  scene.bodies = {plate("base", 0.11, {}), plate("platform", 0.095, platform_pose(0))};
  Look& look = scene.bodies[1].visuals[0].look;
  look.set = true;
  look.diffuse = {0.85, 0.35, 0.15};
  JointSpec weld;
  weld.child = 0;
  scene.joints.push_back(weld);
  for (int i = 0; i < 6; ++i) {
    RodSpec rod;
    rod.name = "robot::leg_" + std::to_string(i + 1);
    rod.length = 0.4;
    rod.section.size = {0.001, 0};
    rod.base.joint = rod.tip.joint = EndJoint::kFixed;
    rod.look.set = true;
    rod.look.diffuse = {0.25, 0.45, 0.85};
    scene.rods.push_back(rod);
  }
  LightSpec sun;
  sun.direction = {-0.4, 0.3, -0.9};
  scene.lights.push_back(sun);
  CameraSpec camera;
  camera.name = "hero";
  camera.eye = {0.82, -0.98, 0.56};
  camera.look_at = {0, 0, 0.215};
  camera.horizontal_fov = 0.75;
  scene.cameras.push_back(camera);
  VideoSpec video;
  video.file = "six_rods.mp4";
  video.camera = 0;
  video.color_by = ColorBy::kBendingMoment;
  video.traces.push_back({"robot::platform.position", 1.5});
  scene.videos.push_back(video);
  return scene;
}

Snapshot six_rods_at(double t) {
  Snapshot now;
  now.time = t;
  const Pose X_WP = platform_pose(t);
  now.bodies.resize(2);
  now.bodies[1].X_WB = X_WP;
  for (std::size_t i = 0; i < kBase.size(); ++i) {
    now.rods.push_back(rod_between(kBase[i], X_WP * kPlatform[i], X_WP.R.col(2)));
  }
  return now;
}

}  // namespace cprsim
