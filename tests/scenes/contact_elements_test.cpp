// SPDX-License-Identifier: BSD-3-Clause
// What scenes say about contact: pairs in records and expectations.
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

/// The rod may touch a floor, and nothing else. `world` is added to the world.
LoadResult load_on_floor(const std::string& world, const std::string& surface = "",
                         const std::string& simulation = "") {
  std::string text = scene_text("", R"(
    <model name="scenery"><static>true</static>
      <link name="floor"><collision name="c"><geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link>
      <link name="wall"><visual name="v"><geometry><sphere><radius>0.1</radius></sphere></geometry></visual></link>
    </model>)" + world);
  const std::string before = "<gravity/></cprsim:effects>";
  text.insert(text.find(before) + 10, "<contact/>");
  if (!simulation.empty()) text.insert(text.find("</cprsim:simulation>"), simulation);
  const std::string length = "<length>0.4</length>\n";
  return load_text(text.insert(text.find(length), surface));
}

const char* const kRecord =
    R"(<cprsim:record rate="500" prefix="p"><channel>contact(robot::leg,scenery::floor).*</channel><csv/></cprsim:record>)";
const char* const kExpect =
    R"(<cprsim:expect name="e"><event kind="contact" between="robot::leg scenery::floor" before="0.6"/></cprsim:expect>)";

TEST(ContactPairs, AreRecordedAndExpected) {
  const LoadResult result = load_on_floor(std::string(kRecord) + kExpect);
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->records.at(0).channels.size(), 12u);
  const Expectation& event = result.scene->expects.at(0).all.at(0);
  ASSERT_EQ(event.channels.size(), 1u);
  EXPECT_EQ(event.channels[0].name, "contact(robot::leg,scenery::floor).count");
  EXPECT_EQ(event.to, 0.6);
  ASSERT_EQ(result.scene->watched.size(), 1u) << "gap and penetration are measured";
  EXPECT_TRUE(load_on_floor(kExpect).scene->watched.empty())
      << "counting points costs no distances";
  EXPECT_FALSE(has_code(result, "W512"));
}

TEST(ContactPairs, ThatNeverTouchAreAWarning) {
  const LoadResult result = load_on_floor(
      R"(<cprsim:expect name="e"><event kind="separation" between="scenery::wall robot::leg"/></cprsim:expect>)");
  EXPECT_TRUE(result.scene);
  EXPECT_TRUE(has_code(result, "W512"));
}

TEST(SoftContact, IsReadFromEitherEngine) {
  const LoadResult ode =
      load_on_floor("", "<surface><contact><ode><kp>2e4</kp><kd>5</kd></ode></contact></surface>");
  ASSERT_TRUE(ode.scene) << to_text(ode.diagnostics);
  EXPECT_EQ(ode.scene->rods.at(0).surface.stiffness, 2e4);
  EXPECT_EQ(ode.scene->rods.at(0).surface.damping, 5);
  EXPECT_EQ(to_text(ode.diagnostics).find("<kp>"), std::string::npos);
  const LoadResult bullet =
      load_on_floor("", "<surface><contact><bullet><kp>1e5</kp></bullet></contact></surface>");
  EXPECT_EQ(bullet.scene->rods.at(0).surface.stiffness, 1e5);
  const LoadResult damped =
      load_on_floor("", "<surface><contact><ode><kd>5</kd></ode></contact></surface>");
  EXPECT_TRUE(has_code(damped, "W592")) << "a damper without a spring";
}

TEST(PlanarContact, IsSolvedInSpaceAndSaysSo) {
  const LoadResult result = load_on_floor("", "", "<planar normal=\"0 1 0\"/>");
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_FALSE(result.scene->planar_normal);
  EXPECT_TRUE(has_code(result, "W592"));
}

TEST(SoftContact, OfLinksAmongThemselvesIsNoted) {
  const std::string box = R"(
    <model name="loose"><link name="box">
      <inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>
      <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry><surface><contact>
        <ode><kp>1e5</kp></ode><collide_bitmask>2</collide_bitmask><category_bitmask>2</category_bitmask>
      </contact></surface></collision></link></model>)";
  const std::string apart =
      "<surface><contact><collide_bitmask>1</collide_bitmask>"
      "<category_bitmask>1</category_bitmask></contact></surface>";
  EXPECT_TRUE(has_code(load_on_floor(box, apart), "W592"));
  EXPECT_FALSE(has_code(load_on_floor(box), "W592"));
}

TEST(ContactPairs, NeedTwoNames) {
  EXPECT_EQ(
      error_codes(load_on_floor(
          R"(<cprsim:expect name="e"><event kind="contact" between="robot::leg"/></cprsim:expect>)")),
      std::vector<std::string>{"E305"});
}

}  // namespace
}  // namespace cprsim
