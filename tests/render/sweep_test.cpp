// SPDX-License-Identifier: BSD-3-Clause
#include "render/sweep.h"

#include <gtest/gtest.h>

#include "render/scenery.h"
#include "render/tiles.h"
#include "tests/support/six_rods.h"

namespace cprsim {
namespace {

View view_from(const Vec3& eye) {
  CameraSpec camera;
  camera.eye = eye;
  camera.look_at = {0, 0, 0.2};
  return make_view(camera, {}, 0, 1, 640, 360);
}

Tube straight(double radius) {
  Tube tube;
  tube.radius = radius;
  for (int k = 0; k <= 4; ++k) {
    tube.rings.push_back({Vec3(0, 0, 0.1 * k), Mat3::Identity(), Color(1, 0, 0)});
  }
  return tube;
}

/// Widest distance of vertices of one height, in pixels.
double width_in_pixels(const TriMesh& mesh, const View& view) {
  double low = 1e9, high = -1e9;
  for (const Vertex& vertex : mesh.vertices) {
    if (std::abs(vertex.position.z() - 0.2F) > 0.01F) continue;
    const double x = view.to_pixel(vertex.position.cast<double>()).x();
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return high - low;
}

TEST(Sweep, ThinRodsStayVisible) {
  const View view = view_from({0, -2, 0.2});
  for (double radius : {1e-6, 1e-4, 3e-3}) {
    TriMesh mesh;
    sweep_tube(straight(radius), view, mesh);
    const double expected = std::max(1.2, 2 * radius / view.pixel_size(Vec3(0, 0, 0.2)));
    EXPECT_NEAR(width_in_pixels(mesh, view), expected, 0.02 * expected) << radius;
  }
}

TEST(Sweep, NearRodsAreWholeAndClosed) {
  TriMesh mesh;
  sweep_tube(straight(0.03), view_from({0, -0.5, 0.2}), mesh);
  double volume = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return mesh.vertices[mesh.indices[i + k]].position.cast<double>();
    };
    volume += Vec3(at(0)).dot(Vec3(at(1)).cross(Vec3(at(2)))) / 6;
  }
  EXPECT_NEAR(volume, 3.14159 * 0.03 * 0.03 * 0.4, 0.02 * volume) << "polygons of 40 sides";
}

TEST(Sweep, ARodSeenFromItsEndIsWhole) {
  TriMesh mesh;
  sweep_tube(straight(0.001), view_from({0, 0.001, 2}), mesh);
  EXPECT_GT(mesh.vertices.size(), 5U * 8U) << "not only the half that faces a viewer at its side";
}

TEST(Sweep, TwistOfARoundRodDoesNotWringIt) {
  Tube tube = straight(0.03);
  for (std::size_t k = 0; k < tube.rings.size(); ++k) {
    tube.rings[k].rotation =
        Eigen::AngleAxisd(2.0 * static_cast<double>(k), Vec3::UnitZ()).matrix();
  }
  TriMesh twisted, plain;
  const View view = view_from({0, -0.5, 0.2});
  sweep_tube(tube, view, twisted);
  sweep_tube(straight(0.03), view, plain);
  ASSERT_EQ(twisted.vertices.size(), plain.vertices.size());
  for (std::size_t i = 0; i < plain.vertices.size(); ++i) {
    EXPECT_LT((twisted.vertices[i].position - plain.vertices[i].position).norm(), 1e-6F);
  }
}

TEST(Tiles, CoverEverythingThatMoves) {
  const Scene scene = six_rods_scene();
  const std::vector<Part> parts = make_parts(scene);
  const Snapshot now = six_rods_at(0.3);
  const Drawing drawing = make_drawing(scene, parts, now, {}, Vec2(0, 1));
  const View view = make_view(scene.cameras[0], now, 0, 1, 1280, 720);
  // a picture of sky alone: no shadows, only objects
  const TileMap map(view, std::vector<float>(1280 * 720, -1.0F), Mat4::Identity());
  const Changes changes = map.changes(parts, drawing, 0.02);
  const auto covered = [&](const Vec3& p) {
    const Vec2 at = view.to_pixel(p);
    return std::any_of(changes.runs.begin(), changes.runs.end(), [&](const TileRun& run) {
      return run.objects && at.x() >= run.region.x0 && at.x() < run.region.x1 &&
             at.y() >= run.region.y0 && at.y() < run.region.y1;
    });
  };
  for (const RodSample& rod : now.rods) {
    for (const RodPoint& point : rod.points)
      EXPECT_TRUE(covered(point.position));
  }
  for (const Vertex& vertex : parts[1].mesh.vertices) {
    EXPECT_TRUE(covered(drawing.part_poses[1] * vertex.position.cast<double>()));
  }
  int pixels = 0;
  for (const TileRun& run : changes.runs)
    pixels += run.region.width() * run.region.height();
  EXPECT_LT(pixels, 1280 * 720 / 4) << "and not much else";
}

}  // namespace
}  // namespace cprsim
