// SPDX-License-Identifier: BSD-3-Clause
// Rods attached to ends of rods, from the scene's text on: two in a row are one of their length,
// and what a fork's prongs carry its stem carries.
#include <gtest/gtest.h>

#include <numbers>

#include "engine/run/simulation.h"
#include "tests/scenes/scene_text.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

class Branching : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, Branching, ::testing::ValuesIn(kEveryMethod), test_name);

std::string rod(const std::string& name, const std::string& on, double length,
                const std::string& pose = "") {
  return "<cprsim:rod name=\"" + name + "\" class=\"wire\"><base attached_to=\"" + on +
         "\" joint=\"fixed\">" + (pose.empty() ? "" : "<pose>" + pose + "</pose>") +
         "</base><length>" + std::to_string(length) + "</length></cprsim:rod>";
}

std::string load(const std::string& at) {
  return "<cprsim:load at=\"" + at +
         "\"><force>0.05 0 -0.2</force><step from=\"1\" to=\"0\" at=\"0\"/></cprsim:load>";
}

Scene scene_of(const std::string& mode, const std::string& parts, Method method) {
  const std::string text =
      R"(<sdf version="1.11" xmlns:cprsim="urn:cprsim:1"><world name="w"><gravity>0 0 -9.81</gravity>
<physics name="p" type="bullet"><max_step_size>0.001</max_step_size><cprsim:solver method="auto">
<time scheme="tr_bdf2" step="0.001"/></cprsim:solver></physics>
<cprsim:simulation mode=")" +
      mode + R"("><duration>0.02</duration><initial solve="static"/></cprsim:simulation>
<cprsim:effects><gravity/></cprsim:effects><model name="m"><static>true</static><link name="wall">
<pose>0 0 0 0 1.5707963267948966 0</pose></link><cprsim:rod_class name="wire"><cross_section><circle>
<radius>0.001</radius></circle></cross_section><material><density>8000</density>
<youngs_modulus>2e11</youngs_modulus><poisson_ratio>0.3</poisson_ratio></material></cprsim:rod_class>)" +
      parts + "</model></world></sdf>";
  const LoadResult loaded = load_text(text);
  EXPECT_NE(loaded.scene, nullptr) << to_text(loaded.diagnostics);
  return loaded.scene ? finely(*loaded.scene, method) : Scene{};
}

/// By the name of the rod.
RodPoint tip_of(const Simulation& simulation, const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.rods.size(); ++i)
    if (scene.rods[i].name == name) return simulation.now().rods[i].points.back();
  ADD_FAILURE() << "no rod " << name;
  return {};
}

// The one that is attached comes first in the scene.
TEST_P(Branching, TwoRodsInARowAreOne) {
  for (const char* mode : {"static", "dynamic"}) {
    const Scene apart = scene_of(
        mode, rod("outer", "inner::tip", 0.2) + rod("inner", "wall", 0.3) + load("outer::tip"),
        GetParam());
    const Scene whole = scene_of(mode, rod("one", "wall", 0.5) + load("one::tip"), GetParam());
    Simulation a(apart), b(whole);
    run_to_end(a);
    run_to_end(b);
    ASSERT_EQ(a.status(), RunStatus::kDone) << a.failure();
    ASSERT_EQ(b.status(), RunStatus::kDone) << b.failure();
    const RodPoint end = tip_of(a, apart, "m::outer"), same = tip_of(b, whole, "m::one");
    EXPECT_LT((end.position - same.position).norm(), 1e-7 * 0.5) << mode;
    EXPECT_LT((end.rotation - same.rotation).norm(), 1e-6) << mode;
  }
}

// Moments about the wall and forces of three prongs, one of them on a prong.
TEST_P(Branching, AForkStandsInEquilibrium) {
  const Scene scene =
      scene_of("static",
               rod("stem", "wall", 0.2) + rod("left", "stem::tip", 0.1, "0 0 0 0.5 0 0") +
                   rod("right", "stem::tip", 0.1, "0.01 0 0 -0.5 0 0") +
                   rod("leaf", "left::tip", 0.05) + load("leaf::tip") + load("right::tip"),
               GetParam());
  ASSERT_EQ(scene.bodies.size(), 3u);  // the wall, and where rods meet
  Simulation simulation(scene);
  ASSERT_TRUE(simulation.start().converged()) << simulation.failure();
  const Snapshot& now = simulation.now();
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  const auto act = [&](const Vec3& f, const Vec3& at) {
    force += f;
    moment += at.cross(f);
  };
  for (std::size_t i = 0; i < now.rods.size(); ++i) {
    const RodSample& rod = now.rods[i];
    const double weight = 8000 * std::numbers::pi * 1e-6 * scene.rods[i].length * 9.81;
    constexpr int kPieces = 400;  // the midpoint rule
    for (int k = 0; k < kPieces; ++k)
      act(Vec3(0, 0, -weight / kPieces), point_at(rod, (k + 0.5) / kPieces).position);
  }
  for (const char* tip : {"m::leaf", "m::right"})
    act(Vec3(0.05, 0, -0.2), tip_of(simulation, scene, tip).position);
  const RodPoint& root = now.rods[0].points.front();
  EXPECT_LT((root.force - force).norm(), 1e-8);
  EXPECT_LT((root.moment - moment).norm(), 1e-6 * moment.norm());
}

TEST(RodsOnRods, ThatCannotBeAreRefusedWhereTheyStand) {
  const auto codes = [](std::string parts) {
    for (std::size_t at; (at = parts.find("\"wire\"")) != std::string::npos;)
      parts.replace(at, 6, "\"steel\"");
    return error_codes(load_text(scene_text(parts)));
  };
  using Codes = std::vector<std::string>;
  EXPECT_EQ(codes(rod("a", "b::tip", 1) + rod("b", "a::tip", 1)), Codes{"E405"});
  EXPECT_EQ(codes(rod("a", "a::tip", 1)), Codes{"E405"});
  EXPECT_EQ(codes(rod("a", "base", 1) + rod("b", "a", 1)), Codes{"E403"});
  EXPECT_EQ(codes(rod("a", "base", 1) + rod("b", "a::middle", 1)), Codes{"E403"});
  EXPECT_EQ(
      codes("<cprsim:rod name=\"a\" class=\"wire\"><base attached_to=\"base\" joint=\"ball\"/>"
            "<length>1</length></cprsim:rod>" +
            rod("b", "a::base", 1)),
      Codes{"E520"});
  EXPECT_EQ(codes(rod("a", "base", 1) + rod("b", "a::base", 1) + rod("c", "a::tip", 1)), Codes{});
}

}  // namespace
}  // namespace cprsim
