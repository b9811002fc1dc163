// SPDX-License-Identifier: BSD-3-Clause
// --set and the other options that change a scene before it is checked.
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

LoadResult with(const std::string& path, const std::string& value) {
  LoadOptions options;
  options.set = {{path, value}};
  return load_text(scene_text(), options);
}

TEST(Overrides, ReachElementsEntitiesAndAttributes) {
  for (const char* path :
       {"robot::leg/length", "robot/leg/length", "model[robot]/cprsim:rod[leg]/length",
        "world/model[1]/rod[leg]/length"}) {
    const LoadResult result = with(path, "0.5");
    ASSERT_TRUE(result.scene) << path << "\n" << to_text(result.diagnostics);
    EXPECT_EQ(result.scene->rods[0].length, 0.5) << path;
  }
  EXPECT_EQ(with("physics[default]/max_step_size", "0.5").scene->max_step_size, 0.5);
  EXPECT_EQ(with("robot::leg/tip/@joint", "ball").scene->rods[0].tip.joint, EndJoint::kBall);
}

LoadResult with_all(const std::vector<std::pair<std::string, std::string>>& set) {
  LoadOptions options;
  options.set = set;
  return load_text(scene_text(), options);
}

TEST(Overrides, ReachSettingsOfTheSolverByOneWord) {
  const LoadResult adaptive = with_all({{"scheme", "esdirk43"}, {"tolerance", "1e-6"}});
  ASSERT_TRUE(adaptive.scene) << to_text(adaptive.diagnostics);
  EXPECT_EQ(adaptive.scene->solver.scheme, SchemeKind::kEsdirk43);
  EXPECT_EQ(adaptive.scene->solver.tolerance, 1e-6);
  // a step replaces the tolerance, another scheme the parameters of the first
  const LoadResult fixed = with_all({{"scheme", "bdf_alpha"},
                                     {"alpha", "-0.2"},
                                     {"tolerance", "1e-6"},
                                     {"step", "0.002"},
                                     {"scheme", "bdf2"},
                                     {"points", "12"},
                                     {"residual", "1e-11"}});
  ASSERT_TRUE(fixed.scene) << to_text(fixed.diagnostics);
  EXPECT_EQ(fixed.scene->solver.step, 0.002);
  EXPECT_FALSE(fixed.scene->solver.tolerance);
  EXPECT_FALSE(fixed.scene->solver.alpha);
  EXPECT_EQ(fixed.scene->solver.points, 12);
  EXPECT_EQ(fixed.scene->solver.residual_tolerance, 1e-11);
  // an accuracy leaves resolution and steps to the program
  const LoadResult asked =
      with_all({{"points", "12"}, {"tolerance", "1e-6"}, {"accuracy", "1e-4"}});
  EXPECT_EQ(asked.scene->solver.accuracy, 1e-4);
  EXPECT_FALSE(asked.scene->solver.points || asked.scene->solver.tolerance);
  EXPECT_EQ(error_codes(with("scheme", "bdf7")), std::vector<std::string>{"E307"});
  EXPECT_EQ(error_codes(with("schem", "bdf2")), std::vector<std::string>{"E311"});
}

TEST(Overrides, ReachOneNumberOfSeveral) {
  const LoadResult result = with("robot::plate/pose#3", "0.45");
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(load_text(scene_text()).scene->bodies[1].X_WB.p.z(), 0.4);
  EXPECT_EQ(result.scene->bodies[1].X_WB.p.z(), 0.45);
  for (const char* path : {"robot::plate/pose#7", "robot::plate/pose#0", "robot::plate/pose#x"})
    EXPECT_EQ(error_codes(with(path, "1")), std::vector<std::string>{"E311"}) << path;
}

TEST(Overrides, TellTheValuesThatAreAskedFor) {
  LoadOptions options;
  options.set = {{"robot::leg/length", "0.5"}};
  options.get = {"robot::leg/length", "robot::plate/pose#3", "robot::leg/tip/@joint"};
  EXPECT_EQ(load_text(scene_text(), options).got,
            (std::vector<std::string>{"0.5", "0.4", "fixed"}));
  options.get = {"robot::leg/lenght"};
  EXPECT_EQ(error_codes(load_text(scene_text(), options)), std::vector<std::string>{"E311"});
}

TEST(Overrides, ThatFitNothingOrSeveralPlacesListCandidates) {
  const LoadResult nothing = with("robot::leg/lenght", "0.5");
  EXPECT_EQ(error_codes(nothing), std::vector<std::string>{"E311"});
  EXPECT_NE(to_text(nothing.diagnostics).find("did you mean 'length'?"), std::string::npos);
  const LoadResult inherited = with("robot::leg/material/density", "1");
  EXPECT_NE(to_text(inherited.diagnostics).find("cprsim:rod_class[steel]/material/density"),
            std::string::npos)
      << to_text(inherited.diagnostics);
  EXPECT_EQ(error_codes(with("robot/link", "1")), std::vector<std::string>{"E311"});
  EXPECT_EQ(error_codes(with("robot::leg", "1")), std::vector<std::string>{"E311"});
  EXPECT_EQ(error_codes(with("", "1")), std::vector<std::string>{"E311"});
}

TEST(Overrides, AreCheckedLikeTheSceneItself) {
  EXPECT_EQ(error_codes(with("robot::leg/length", "-1")), std::vector<std::string>{"E306"});
  EXPECT_EQ(error_codes(with("robot::leg/length", "long")), std::vector<std::string>{"E305"});
  EXPECT_EQ(error_codes(with("robot::leg/tip/@color", "red")), std::vector<std::string>{"E302"});
}

TEST(Options, ReplaceDurationStepAccuracyAndMethod) {
  LoadOptions options;
  options.duration = 7;
  options.step = 0.25;
  options.accuracy = 1e-4;
  options.method = "shooting";
  const LoadResult result = load_text(scene_text(), options);
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->simulation.duration, 7);
  EXPECT_EQ(result.scene->max_step_size, 0.25);
  EXPECT_EQ(result.scene->solver.accuracy, 1e-4);
  EXPECT_EQ(result.scene->solver.method, Method::kShooting);
  options.duration = -1;
  EXPECT_EQ(error_codes(load_text(scene_text(), options)), std::vector<std::string>{"E306"});
}

TEST(Options, TakeAMethodForEveryRod) {
  const std::string text = scene_text(R"(
    <cprsim:rod name="other" class="steel" method="auto">
      <base attached_to="base" joint="fixed"/><length>0.3</length></cprsim:rod>)");
  const auto scene = load_text(text).scene;
  ASSERT_TRUE(scene);
  EXPECT_FALSE(scene->rods[0].method);
  EXPECT_EQ(scene->rods[1].method, Method::kAuto);
  LoadOptions options;
  options.method = "shooting";
  const auto replaced = load_text(text, options).scene;
  ASSERT_TRUE(replaced);
  EXPECT_FALSE(replaced->rods[1].method);
  EXPECT_EQ(replaced->solver.method, Method::kShooting);
}

TEST(Options, KeepAResolutionForTheMethodItBelongsTo) {
  LoadOptions options;
  options.method = "shooting";
  const auto solved = [](const std::string& space) {
    std::string text = scene_text();
    const std::string before = "</max_step_size>";
    return text.insert(text.find(before) + before.size(),
                       "<cprsim:solver method=\"auto\"><space " + space + "/></cprsim:solver>");
  };
  const LoadResult strain = load_text(solved("order=\"8\" points=\"5\""), options);
  ASSERT_TRUE(strain.scene) << to_text(strain.diagnostics);
  EXPECT_EQ(strain.scene->solver.order, 8);
  EXPECT_EQ(strain.scene->solver.points, 5);
  EXPECT_TRUE(has_code(strain, "W508")) << "order is no setting of shooting";
  EXPECT_FALSE(has_code(load_text(solved("points=\"5\""), options), "W508"));
  EXPECT_FALSE(has_code(load_text(solved("order=\"8\"")), "W508"));
  EXPECT_TRUE(has_code(load_text(solved("basis=\"nurbs\""), options), "W508"));
  options.method = "collocation";
  EXPECT_FALSE(has_code(load_text(solved("basis=\"nurbs\""), options), "W508"));
  EXPECT_FALSE(has_code(load_text(solved("basis=\"bspline\""), options), "W508"));
  EXPECT_TRUE(has_code(load_text(solved("basis=\"chebyshev\""), options), "W508"));
  options.method = "strain";
  EXPECT_FALSE(has_code(load_text(solved("basis=\"chebyshev\""), options), "W508"));
  EXPECT_EQ(error_codes(load_text(solved("order=\"80\""))), std::vector<std::string>{"E509"});
}

TEST(Options, SwitchEffects) {
  LoadOptions options;
  options.with = {"shear"};
  options.without = {"gravity"};
  const LoadResult result = load_text(scene_text(), options);
  ASSERT_TRUE(result.scene);
  EXPECT_TRUE(result.scene->effects.has(Effect::kShear));
  EXPECT_FALSE(result.scene->effects.has(Effect::kGravity));
  options.with = {"sheer"};
  EXPECT_EQ(error_codes(load_text(scene_text(), options)), std::vector<std::string>{"E307"});
  options.with = {"drag"};
  EXPECT_EQ(error_codes(load_text(scene_text(), options)), std::vector<std::string>{"E503"});
}

}  // namespace
}  // namespace cprsim
