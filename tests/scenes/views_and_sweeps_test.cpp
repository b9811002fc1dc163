// SPDX-License-Identifier: BSD-3-Clause
// Lights, cameras and sweeps: what is rarely written of them, and what makes no sense.
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

std::vector<std::string> codes_of(const std::string& world) {
  return error_codes(load_text(scene_text("", world)));
}

TEST(Views, AreReadAsWritten) {
  const LoadResult loaded = load_text(scene_text("", R"(
    <light name="lamp" type="point"><pose>1 2 3 0 0 0</pose><intensity>0.5</intensity></light>
    <light name="beam" type="spot"><direction>0 3 -4</direction></light>
    <gui><camera name="user"><pose>1 0 2 0 0 1.5707963267948966</pose></camera></gui>
    <cprsim:camera name="plate"><eye>1 1 1</eye><look_at frame="robot::plate"/><orbit rate="0.2"/>
      <image><width>300</width><height>200</height></image></cprsim:camera>)"));
  ASSERT_TRUE(loaded.scene) << to_text(loaded.diagnostics);
  const Scene& scene = *loaded.scene;
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].kind, LightKind::kPoint);
  EXPECT_EQ(scene.lights[0].at.X_BF.p, Vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[0].intensity, 0.5);
  EXPECT_EQ(scene.lights[1].kind, LightKind::kSpot);
  EXPECT_LT((scene.lights[1].direction - Vec3(0, 0.6, -0.8)).norm(), 1e-15);
  ASSERT_EQ(scene.cameras.size(), 2u);
  const CameraSpec &plate = scene.cameras[0], &user = scene.cameras[1];
  ASSERT_TRUE(plate.look_at_frame);
  EXPECT_EQ(scene.bodies[static_cast<std::size_t>(plate.look_at_frame->body)].name, "robot::plate");
  EXPECT_EQ(plate.look_at, Vec3(0, 0, 0));
  EXPECT_EQ(plate.orbit_rate, 0.2);
  EXPECT_EQ(plate.width, 300);
  EXPECT_EQ(user.name, "user");
  EXPECT_LT((user.look_at - Vec3(1, 1, 2)).norm(), 1e-15);  // along x of its pose
  EXPECT_EQ(user.up, Vec3(0, 0, 1));
}

TEST(Views, ThatShowNothingAreRefused) {
  const auto looking = [](const std::string& at, const std::string& more = "") {
    return "<cprsim:camera name=\"c\"><eye>1 1 1</eye><look_at" + at + more + "</cprsim:camera>";
  };
  const std::string center = ">0 0 0</look_at>";
  for (const auto& [world, code] :
       {std::pair{
            std::string("<light name=\"l\" type=\"spot\"><direction>0 0 0</direction></light>"),
            "E506"},
        {looking(">1 1 1</look_at>"), "E506"},
        {looking(center, "<up>0 0 0</up>"), "E506"},
        {looking(center, "<horizontal_fov>3.12</horizontal_fov>"), "E306"},
        {looking(center, "<image><width>8193</width><height>99</height></image>"), "E509"},
        {looking(" frame=\"robot::plat\"/>"), "E403"},
        {looking(" frame=\"robot::leg\"/>"), "E403"},
        {looking(center) + looking(center), "E401"}})
    EXPECT_EQ(codes_of(world), std::vector<std::string>{code}) << world;
}

TEST(Sweeps, TakeAListOrARange) {
  const auto sweep = [](const std::string& vary) {
    return "<cprsim:sweep name=\"s\"><vary path=\"world/model/cprsim:rod/length\"" + vary +
           "<measure of=\"robot::leg.tip.position.x\" norm=\"final\"/></cprsim:sweep>";
  };
  for (const auto& [vary, values] :
       {std::pair{std::string(">0.3 0.4</vary>"), std::vector<std::string>{"0.3", "0.4"}},
        {" from=\"0.25\" to=\"0.5\" count=\"3\"/>", {"0.25", "0.375", "0.5"}},
        {" from=\"0.25\" to=\"0.5\" count=\"1\"/>", {"0.25"}}}) {
    const LoadResult loaded = load_text(scene_text("", sweep(vary)));
    ASSERT_TRUE(loaded.scene) << to_text(loaded.diagnostics);
    ASSERT_EQ(loaded.scene->sweeps.size(), 1u);
    EXPECT_EQ(loaded.scene->sweeps[0].vary[0].values, values) << vary;
    EXPECT_EQ(loaded.scene->sweeps[0].measures[0].norm, Norm::kFinal);
  }
  for (const auto& [vary, code] : {std::pair{std::string("/>"), "E310"},
                                   {" from=\"0.3\">0.3 0.4</vary>", "E310"},
                                   {" from=\"0.3\" to=\"0.4\"/>", "E310"},
                                   {" to=\"0.4\" count=\"3\"/>", "E310"},
                                   {" from=\"0.3\" to=\"0.4\" count=\"10001\"/>", "E509"}})
    EXPECT_EQ(codes_of(sweep(vary)), std::vector<std::string>{code}) << vary;
}

}  // namespace
}  // namespace cprsim
