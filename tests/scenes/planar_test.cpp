// SPDX-License-Identifier: BSD-3-Clause
// Planar scenes: which are accepted, and that a spatial one says nothing of a plane.
#include "engine/model/planar.h"

#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

std::string planar_text(const std::string& normal, const std::string& model = "") {
  std::string text = scene_text(model);
  const std::string end = "<duration>1</duration>";
  text.insert(text.find(end) + end.size(), "<planar normal=\"" + normal + "\"/>");
  return text;
}

TEST(PlanarScene, KnowsItsNormal) {
  const LoadResult result = load_text(planar_text("0 -2 0"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  ASSERT_TRUE(result.scene->planar_normal);
  EXPECT_EQ(*result.scene->planar_normal, Vec3(0, -1, 0));
  EXPECT_FALSE(load_text(scene_text()).scene->planar_normal);
}

// gravity and the rod lie in every vertical plane
TEST(PlanarScene, TakesEveryPlaneThatHoldsAll) {
  for (const char* normal : {"1 0 0", "0 1 0", "0.6 0.8 0"}) {
    const LoadResult result = load_text(planar_text(normal));
    EXPECT_TRUE(result.scene) << normal << to_text(result.diagnostics);
  }
  EXPECT_EQ(error_codes(load_text(planar_text("0 0 1"))), std::vector<std::string>{"E511"});
  EXPECT_EQ(error_codes(load_text(planar_text("0 1"))), std::vector<std::string>{"E305"});
}

// What is bent at rest, or by heat, bends in the plane or leaves it.
TEST(PlanarScene, TakesRodsThatBendInThePlane) {
  const std::string bent =
      "<cprsim:rod name='bent' class='steel'><base attached_to='base' joint='fixed'/>"
      "<length>0.2</length><rest><curvature>0 2 0</curvature></rest></cprsim:rod>";
  EXPECT_TRUE(load_text(planar_text("0 1 0", bent)).scene);
  const LoadResult across = load_text(planar_text("1 0 0", bent));
  EXPECT_EQ(error_codes(across), std::vector<std::string>{"E511"});
  EXPECT_NE(across.diagnostics.back().message.find("bent at rest, out of the plane"),
            std::string::npos);
}

TEST(PlanarScene, NamesWhatLeavesThePlane) {
  const LoadResult result = load_text(
      planar_text("0 1 0", "<cprsim:load at=\"leg::tip\"><force>0 1 0</force></cprsim:load>"));
  EXPECT_EQ(error_codes(result), std::vector<std::string>{"E511"});
  const Diagnostic& d = result.diagnostics.back();
  EXPECT_NE(d.message.find("force 0 1 0"), std::string::npos) << to_text(result.diagnostics);
  EXPECT_GT(d.line, 0);
  EXPECT_GT(d.column, 0);
  EXPECT_FALSE(d.suggestion.empty());
}

TEST(PlanarScene, TakesDirectionsWrittenWithFewDigits) {
  // 1.5708 instead of pi / 2: 4e-6 rad off
  const LoadResult result = load_text(planar_text(
      "0 1 0",
      "<cprsim:load at=\"leg::tip\" expressed_in=\"turned\"><force>0 1 0</force></cprsim:load>"
      "<frame name=\"turned\" attached_to=\"base\"><pose>0 0 0 1.5708 0 0</pose></frame>"));
  EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
}

TEST(PlaneAxes, AreRightHandedAlongTheWorldsWherePossible) {
  for (const Vec3& normal : {Vec3(0, 1, 0), Vec3(0, 0, -3), Vec3(0.3, -0.5, 0.2)}) {
    const Mat3 axes = plane_axes(normal);
    EXPECT_LT((axes.transpose() * axes - Mat3::Identity()).norm(), 1e-15);
    EXPECT_NEAR(axes.determinant(), 1, 1e-15);
    EXPECT_LT((axes.col(2) - normal.normalized()).norm(), 1e-15);
  }
  EXPECT_EQ(plane_axes(Vec3::UnitZ()), Mat3::Identity());
}

}  // namespace
}  // namespace cprsim
