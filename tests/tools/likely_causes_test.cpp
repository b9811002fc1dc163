// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/likely_causes.h"

#include <gtest/gtest.h>

namespace cprsim {
namespace {

std::string all_of(const std::vector<std::string>& causes) {
  std::string all;
  for (const std::string& cause : causes)
    all += cause + "\n";
  return all;
}

struct HeavyThread : testing::Test {
  HeavyThread() {
    scene.simulation.mode = Mode::kStatic;
    scene.effects.set(Effect::kGravity, true);
    RodFacts rod;
    rod.name = "thread";
    rod.gravity_number = 7837;  // 1,000 times what stands
    facts.rods.push_back(rod);
  }

  std::string causes() const { return all_of(likely_causes(scene, facts, solve, 0, false)); }

  Scene scene;
  ProblemFacts facts;
  SolveReport solve;
};

TEST_F(HeavyThread, IsNamedWithItsWeight) {
  EXPECT_NE(causes().find("rod 'thread' weighs 1e+03 times what it could carry"), std::string::npos)
      << causes();
  scene.gravity *= 0.01;
  EXPECT_EQ(causes(), "");
  scene.gravity *= 1000;
  EXPECT_NE(causes().find("1e+04 times"), std::string::npos) << causes();
}

TEST_F(HeavyThread, WhoseSearchIsGivenUpSaysHowFarItCame) {
  solve.status = SolveStatus::kWorkLimit;
  EXPECT_EQ(causes().find("% of the loads"), std::string::npos) << causes();
  EXPECT_EQ(causes().find("an equilibrium may take 100 million section evaluations"), 0U);
  solve.loaded = 0.25;
  EXPECT_NE(causes().find("with 25 % of the loads carried"), std::string::npos) << causes();
}

// 0.3 m long, between the world's origin and a frame 0.5 m away, on a body that stands 0.2 m high.
TEST(ShortRod, IsNamedWithTheGapUnlessItStretches) {
  Scene scene;
  scene.simulation.mode = Mode::kStatic;
  BodySpec body;
  body.X_WB.p = {0, 0, 0.2};
  scene.bodies.push_back(body);
  RodSpec rod;
  rod.name = "leg";
  rod.length = 0.3;
  rod.base.joint = rod.tip.joint = EndJoint::kFixed;
  rod.tip.at.body = 0;
  rod.tip.at.X_BF.p = {0.3, 0, 0.2};
  scene.rods.push_back(rod);
  const auto causes = [&](bool started) {
    return all_of(likely_causes(scene, ProblemFacts{}, SolveReport{}, 0, started));
  };
  EXPECT_EQ(causes(false).find("rod 'leg' is 0.3 m long, the gap between its ends 0.5 m"), 0U)
      << causes(false);
  EXPECT_EQ(causes(true).find("gap"), std::string::npos);
  scene.rods[0].length = 0.6;
  EXPECT_EQ(causes(false), "");
  scene.rods[0].length = 0.3;
  scene.rods[0].tip.joint = EndJoint::kFree;
  EXPECT_EQ(causes(false), "");
  DriveSpec feed;
  feed.rod = 0;
  scene.rods[0].tip.joint = EndJoint::kFixed;
  scene.drives.push_back(feed);
  EXPECT_EQ(causes(false), "") << "its length is another";
  scene.drives.clear();
  scene.rods[0].tip.joint = EndJoint::kFixed;
  scene.effects.set(Effect::kExtension, true);
  EXPECT_EQ(causes(false), "");
}

}  // namespace
}  // namespace cprsim
