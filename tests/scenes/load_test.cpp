// SPDX-License-Identifier: BSD-3-Clause
// What a good scene becomes.
#include "scenes/loader/load.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

std::unique_ptr<Scene> scene_of(const std::string& model = "", const std::string& world = "") {
  LoadResult result = load_text(scene_text(model, world));
  EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
  return result.scene ? std::move(result.scene) : std::make_unique<Scene>();
}

TEST(Loading, FillsTheStewartPlatform) {
  LoadResult result =
      load_scene(std::string(CPRSIM_SOURCE_DIR) + "/scenes/robots/csg_published.xml");
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const Scene& scene = *result.scene;
  ASSERT_EQ(scene.rods.size(), 6u);
  EXPECT_EQ(scene.rods[0].name, "robot::leg_1");
  EXPECT_EQ(scene.rods[3].length, 0.4216240113);
  EXPECT_EQ(scene.rods[0].section.size[0], 0.001);
  EXPECT_EQ(scene.rods[0].material->shear_modulus, 80e9);
  EXPECT_TRUE(scene.rods[0].tip.spin_free);
  EXPECT_FALSE(scene.rods[0].base.spin_free);
  EXPECT_EQ(scene.bodies[static_cast<std::size_t>(scene.rods[0].tip.at.body)].name,
            "robot::platform");
  const double a = 50 * std::acos(-1.0) / 180;
  EXPECT_LT((scene.rods[0].tip.at.X_BF.p - 0.087 * Vec3(std::cos(a), -std::sin(a), 0)).norm(),
            1e-15);
  EXPECT_TRUE(scene.effects.has(Effect::kExtension));
  EXPECT_FALSE(scene.effects.has(Effect::kDamping));
  EXPECT_EQ(scene.simulation.mode, Mode::kStatic);
  EXPECT_EQ(scene.hash.size(), 16u);
}

TEST(Loading, PlacesJointFramesSoThatBothSidesAgreeAtZero) {
  const auto scene = scene_of(R"(
    <link name="arm"><pose>0.1 0.2 0.3 0.4 0.5 0.6</pose>
      <inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
    <joint name="hinge" type="revolute"><pose>0.01 0.02 0.03 1 0 0</pose><parent>plate</parent><child>arm</child>
      <axis><xyz expressed_in="base">0 0 2</xyz></axis></joint>)");
  const JointSpec& joint = scene->joints.at(1);
  const Pose left = scene->bodies.at(1).X_WB * joint.X_PJ,
             right = scene->bodies.at(2).X_WB * joint.X_CJ;
  EXPECT_LT((left.p - right.p).norm(), 1e-15);
  EXPECT_LT((left.R - right.R).norm(), 1e-14);
  EXPECT_LT((joint.X_CJ.p - Vec3(0.01, 0.02, 0.03)).norm(), 1e-15);  // relative to the child
  EXPECT_LT((right.R * joint.axis - Vec3::UnitZ()).norm(), 1e-14);
}

TEST(Loading, AllowsNamesBeforeTheirDefinition) {
  const auto scene = scene_of(R"(
    <frame name="early" attached_to="late"/>
    <frame name="late" attached_to="plate"><pose relative_to="base">0 0 1 0 0 0</pose></frame>)");
  ASSERT_EQ(scene->frames.size(), 2u);
  EXPECT_EQ(scene->frames[0].at.body, 1);
  EXPECT_LT((scene->frames[0].at.X_BF.p - Vec3(0, 0, 0.6)).norm(), 1e-15);
}

TEST(RodClasses, GiveWhatTheRodDoesNotSay) {
  const auto scene = scene_of(R"(
    <cprsim:rod_class name="soft" class="steel">
      <material><youngs_modulus>1e9</youngs_modulus></material>
      <damping><bending>1e-3</bending></damping>
    </cprsim:rod_class>
    <cprsim:rod name="other" class="soft">
      <base attached_to="base" joint="ball"/>
      <length>0.2</length>
      <material><poisson_ratio>0.25</poisson_ratio></material>
    </cprsim:rod>)");
  const RodSpec& rod = scene->rods.at(1);
  EXPECT_EQ(rod.section.size[0], 0.001);
  EXPECT_EQ(rod.material->density, 8000);
  EXPECT_EQ(rod.material->youngs_modulus, 1e9);
  EXPECT_DOUBLE_EQ(rod.material->shear_modulus, 1e9 / 2.5);
  EXPECT_EQ(rod.damping->bending, 1e-3);
  EXPECT_EQ(rod.tip.joint, EndJoint::kFree);
  EXPECT_EQ(rod.base.joint, EndJoint::kBall);
}

TEST(Fluid, IsReadValueByValueFromRodsAndClasses) {
  const auto scene = scene_of(R"(
    <cprsim:rod_class name="wet" class="steel">
      <drag><normal>1.2</normal><fluid_density>1000</fluid_density></drag></cprsim:rod_class>
    <cprsim:rod name="a" class="wet"><base attached_to="base" joint="fixed"/><length>0.2</length>
      <drag><tangential>0.1</tangential><added_mass>1</added_mass></drag></cprsim:rod>)");
  EXPECT_FALSE(scene->rods.at(0).drag.has_value());
  const DragSpec& drag = scene->rods.at(1).drag.value();
  EXPECT_EQ(drag.normal, 1.2);
  EXPECT_EQ(drag.tangential, 0.1);
  EXPECT_EQ(drag.fluid_density, 1000);
  EXPECT_EQ(drag.added_mass, 1);
}

TEST(Fields, AreThoseOfTheWorldAndMagnetsThoseOfRodsOrClasses) {
  std::string text = scene_text(R"(
    <cprsim:rod_class name="magnet" class="steel">
      <magnetization>0 0 2</magnetization><magnetization from="0.2" to="0.5">1 0 0</magnetization>
    </cprsim:rod_class>
    <cprsim:rod name="a" class="magnet"><base attached_to="base" joint="fixed"/><length>0.2</length>
    </cprsim:rod>
    <cprsim:rod name="b" class="magnet"><base attached_to="base" joint="fixed"/><length>0.2</length>
      <magnetization from="0.8">0 3 0</magnetization></cprsim:rod>)");
  text.insert(
      text.find("<model"),
      "<cprsim:magnetic_field profile=\"rise\"><uniform>1 2 3</uniform></cprsim:magnetic_field>"
      "<cprsim:magnetic_field><dipole><position>4 5 6</position><moment>7 8 9</moment></dipole>"
      "</cprsim:magnetic_field>"
      "<cprsim:profile name=\"rise\"><constant value=\"0.5\"/></cprsim:profile>");
  const LoadResult result = load_text(text);
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const Scene& scene = *result.scene;
  ASSERT_EQ(scene.magnetic_fields.size(), 2u);
  EXPECT_EQ(scene.magnetic_fields[0].uniform, Vec3(1, 2, 3));
  EXPECT_TRUE(scene.magnetic_fields[0].has_profile);
  EXPECT_EQ(scene.magnetic_fields[0].profile.evaluate(0).value, 0.5);
  EXPECT_TRUE(scene.magnetic_fields[1].dipole);
  EXPECT_FALSE(scene.magnetic_fields[1].has_profile);
  EXPECT_EQ(scene.magnetic_fields[1].position, Vec3(4, 5, 6));
  EXPECT_EQ(scene.magnetic_fields[1].moment, Vec3(7, 8, 9));
  const std::vector<MagnetSpec>&a = scene.rods.at(1).magnets, &b = scene.rods.at(2).magnets;
  ASSERT_EQ(a.size(), 2u);
  EXPECT_EQ(a[0].moment, Vec3(0, 0, 2));
  EXPECT_EQ(a[0].from, 0);
  EXPECT_EQ(a[0].to, 1);
  EXPECT_EQ(a[1].from, 0.2);
  EXPECT_EQ(a[1].to, 0.5);
  ASSERT_EQ(b.size(), 1u);
  EXPECT_EQ(b[0].moment, Vec3(0, 3, 0));
}

TEST(Temperature, IsARiseAndAGradientInTime) {
  const auto scene = scene_of(R"(
    <cprsim:rod name="a" class="steel"><base attached_to="base" joint="fixed"/><length>0.2</length>
      <material><thermal_expansion>-2e-6</thermal_expansion></material>
      <temperature><rise>40</rise><gradient>100 -200</gradient>
        <ramp from="0" to="2" start="0" end="1"/></temperature></cprsim:rod>)");
  const RodSpec& rod = scene->rods.at(1);
  EXPECT_EQ(rod.material->thermal_expansion, -2e-6);
  ASSERT_TRUE(rod.temperature);
  EXPECT_EQ(rod.temperature->rise, 40);
  EXPECT_EQ(rod.temperature->gradient, Vec2(100, -200));
  ASSERT_TRUE(rod.temperature->has_profile);
  EXPECT_EQ(rod.temperature->profile.evaluate(0.5).value, 1);
}

TEST(Disks, StandEvenlyOrWhereTheySay) {
  const auto scene = scene_of(R"(
    <cprsim:rod_class name="heavy" class="steel">
      <disks count="4"><radius>0.02</radius><mass>0.01</mass></disks>
      <disks s="0.6"><mass>0.03</mass></disks></cprsim:rod_class>
    <cprsim:rod name="a" class="heavy"><base attached_to="base" joint="fixed"/><length>0.2</length>
    </cprsim:rod>
    <cprsim:rod name="b" class="heavy"><base attached_to="base" joint="fixed"/><length>0.2</length>
      <disks s="1"><mass>0.5</mass></disks></cprsim:rod>)");
  const std::vector<DiskSpec>& disks = scene->rods.at(1).disks;
  ASSERT_EQ(disks.size(), 5u);
  const double s[] = {0.25, 0.5, 0.6, 0.75, 1};
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(disks[k].s, s[k]);
    EXPECT_EQ(disks[k].mass, k == 2 ? 0.03 : 0.01);
    EXPECT_EQ(disks[k].radius, k == 2 ? 0 : 0.02);
  }
  ASSERT_EQ(scene->rods.at(2).disks.size(), 1u);
  EXPECT_EQ(scene->rods.at(2).disks[0].mass, 0.5);
}

TEST(RestShapes, AreACurvatureOrAHelixAndInherited) {
  const auto scene = scene_of(R"(
    <cprsim:rod_class name="bent" class="steel"><rest><curvature>1 -2 0.5</curvature></rest></cprsim:rod_class>
    <cprsim:rod name="a" class="bent"><base attached_to="base" joint="fixed"/><length>0.2</length></cprsim:rod>
    <cprsim:rod name="b" class="bent"><base attached_to="base" joint="fixed"/><length>0.2</length>
      <rest><helix><radius>0.03</radius><pitch>-0.25132741228718347</pitch></helix></rest></cprsim:rod>)");
  EXPECT_EQ(scene->rods.at(0).rest_curvature, Vec3::Zero());
  EXPECT_EQ(scene->rods.at(1).rest_curvature, Vec3(1, -2, 0.5));
  // pitch -2 pi 0.04: r / (r2 + c2) = 0.03 / 0.0025, c / (r2 + c2) = -0.04 / 0.0025
  EXPECT_LT((scene->rods.at(2).rest_curvature - Vec3(0, 12, -16)).norm(), 1e-12);
}

TEST(RestShapes, MustBeOneAndPossible) {
  const auto codes = [](const std::string& rest) {
    return error_codes(load_text(
        scene_text("<cprsim:rod name='a' class='steel'><base attached_to='base' joint='fixed'/>"
                   "<length>0.2</length><rest>" +
                   rest + "</rest></cprsim:rod>")));
  };
  using Codes = std::vector<std::string>;
  EXPECT_EQ(codes("<curvature>0 900 0</curvature>"), Codes{});
  EXPECT_EQ(codes("<curvature>0 1100 0</curvature>"), Codes{"E506"});  // radius 1 mm
  EXPECT_EQ(codes(""), Codes{"E303"});
  EXPECT_EQ(codes("<curvature>0 1 0</curvature><helix><radius>1</radius><pitch>1</pitch></helix>"),
            Codes{"E310"});
  EXPECT_EQ(codes("<helix><radius>-1</radius><pitch>1</pitch></helix>"), Codes{"E306"});
  EXPECT_EQ(codes("<file>shape.csv</file>"), Codes{"E106"});
}

TEST(Loads, ActOnBodiesAndRodPoints) {
  const auto scene = scene_of(R"(
    <cprsim:load at='leg::tip'><force>1 0 0</force></cprsim:load>
    <cprsim:load at='leg(s=0.25)' expressed_in='leg(s=0.25)'>
      <force>0 1 0</force><step from='1' to='0' at='0'/>
    </cprsim:load>
    <cprsim:load at='plate' expressed_in='plate'><torque>0 0 1</torque></cprsim:load>)");
  ASSERT_EQ(scene->loads.size(), 3u);
  EXPECT_EQ(scene->loads[0].rod, 0);
  EXPECT_EQ(scene->loads[0].rod_s, 1);
  EXPECT_FALSE(scene->loads[0].follower);
  EXPECT_FALSE(scene->loads[0].has_profile);
  EXPECT_EQ(scene->loads[1].rod_s, 0.25);
  EXPECT_TRUE(scene->loads[1].follower);
  EXPECT_EQ(scene->loads[1].profile.evaluate(0, true).value, 1);
  EXPECT_EQ(scene->loads[2].rod, -1);
  EXPECT_EQ(scene->loads[2].at.body, 1);
  EXPECT_TRUE(scene->loads[2].follower);
}

TEST(InitialVelocities, AreGivenInWorldAxes) {
  std::string text = scene_text();
  text.replace(text.find("<duration>"), 0,
               "<initial solve='none'><velocity of='robot::plate'><linear>1 2 3</linear>"
               "<angular>0 0 4</angular></velocity></initial>");
  const LoadResult result = load_text(text);
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_TRUE(result.scene->bodies[1].velocity_given);
  EXPECT_EQ(result.scene->bodies[1].linear_velocity, Vec3(1, 2, 3));
  EXPECT_EQ(result.scene->bodies[1].angular_velocity, Vec3(0, 0, 4));
}

TEST(InitialVelocities, NameWhatWeldsALinkThatCannotMove) {
  std::string text = scene_text();
  text.replace(text.find("<duration>"), 0,
               "<initial><velocity of='robot::base'><linear>1 2 3</linear></velocity></initial>");
  const LoadResult result = load_text(text);
  ASSERT_EQ(error_codes(result), std::vector<std::string>{"E512"});
  const std::string told = to_text(result.diagnostics);
  EXPECT_NE(told.find("joint 'robot::ground', test.xml:9"), std::string::npos) << told;
  EXPECT_NE(told.find("leave <velocity> out"), std::string::npos) << told;
}

TEST(InitialVelocities, DoNothingAtRestWhichIsTold) {
  std::string text = scene_text();
  const std::string duration = "<duration>1</duration>";
  text.replace(text.find(duration), duration.size(),
               "<initial><velocity of='robot::plate'><linear>1 2 3</linear></velocity></initial>");
  text.replace(text.find("dynamic"), 7, "static");
  const LoadResult result = load_text(text);
  EXPECT_TRUE(result.scene);
  EXPECT_TRUE(has_code(result, "W513"));
}

TEST(Ties, AreSolvedInSpaceAndSaySo) {
  std::string text = scene_text(
      "<cprsim:rod name='other' class='steel'><base attached_to='base' joint='fixed'>"
      "<pose>0.01 0 0 0 0 0</pose></base><length>0.4</length></cprsim:rod>"
      "<cprsim:tie name='t' rod='leg' other='other'><s>0.5 1</s></cprsim:tie>");
  text.replace(text.find("<gravity/>"), 0, "<extension/>");
  text.replace(text.find("</duration>") + 11, 0, "<planar normal='0 1 0'/>");
  const LoadResult result = load_text(text);
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_FALSE(result.scene->planar_normal);
  EXPECT_TRUE(has_code(result, "W592"));
}

TEST(Ties, OfAFedRodAreAtItsTip) {
  for (const auto& [s, codes] : {std::pair<const char*, std::vector<std::string>>{"1", {}},
                                 {"0.5", {"E520"}},
                                 {"0.5 1", {"E520"}}}) {
    std::string text = scene_text(
        std::string("<cprsim:rod name='other' class='steel'><base attached_to='base' "
                    "joint='fixed'/><length>0.4</length></cprsim:rod><cprsim:tie name='t' "
                    "rod='leg' other='other'><s>") +
        s +
        "</s></cprsim:tie><cprsim:drive rod='leg' quantity='length'><constant value='0.4'/>"
        "</cprsim:drive>");
    text.replace(text.find("<gravity/>"), 0, "<extension/>");
    EXPECT_EQ(error_codes(load_text(text)), codes) << s;
  }
}

TEST(Includes, BringAModelUnderItsNameAndPose) {
  const auto folder = std::filesystem::temp_directory_path() / "cprsim_include_test";
  std::filesystem::create_directories(folder / "post");
  std::ofstream(folder / "post/model.sdf")
      << "<sdf version='1.11'><model name='post'><static>true</static>"
         "<link name='l'><pose>0 0 1 0 0 0</pose></link><frame name='top' attached_to='l'>"
         "<pose>0 0 0.5 0 0 0</pose></frame></model></sdf>";
  LoadOptions options;
  options.resource_paths = {folder.string()};
  const LoadResult result = load_text(
      scene_text(
          "",
          "<include><uri>model://post</uri><name>left</name><pose>3 0 0 0 0 0</pose></include>"
          "<include><uri>model://post</uri><name>right</name><pose>9 0 0 0 0 0</pose>"
          "<placement_frame>top</placement_frame></include>"),
      options);
  std::filesystem::remove_all(folder);
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->bodies.at(2).name, "left::l");
  EXPECT_TRUE(result.scene->bodies.at(2).is_static);
  EXPECT_LT((result.scene->bodies[2].X_WB.p - Vec3(3, 0, 1)).norm(), 1e-15);
  EXPECT_LT((result.scene->bodies.at(3).X_WB.p - Vec3(9, 0, -0.5)).norm(), 1e-15);
  EXPECT_EQ(result.scene->files.size(), 3u);
}

TEST(Effects, GivenButNotListedAreNoted) {
  const LoadResult result = load_text(scene_text(R"(
    <cprsim:rod name="other" class="steel"><base attached_to="base" joint="fixed"/><length>0.2</length>
      <damping><bending>1e-3</bending></damping></cprsim:rod>)"));
  EXPECT_TRUE(result.scene);
  EXPECT_TRUE(has_code(result, "W511"));
}

TEST(Lax, TurnsRejectedSdfElementsIntoWarningsOnly) {
  const std::string text = scene_text("", "<road name='r'><width>1</width></road>");
  EXPECT_EQ(error_codes(load_text(text)), std::vector<std::string>{"E520"});
  LoadOptions lax;
  lax.lax = true;
  EXPECT_TRUE(load_text(text, lax).scene);
  EXPECT_EQ(error_codes(load_text(
                scene_text("<cprsim:rod name='other' class='steel'><base attached_to='base' "
                           "joint='fixed'/><length>0.4</length></cprsim:rod><cprsim:tie name='t' "
                           "rod='leg' other='other'><s>0.5</s></cprsim:tie>"
                           "<cprsim:drive rod='leg' quantity='length'><constant value='0.4'/>"
                           "</cprsim:drive>"),
                lax)),
            std::vector<std::string>{"E520"});
}

TEST(ExpectedFailures, AreReportedBesideTheErrors) {
  const LoadResult result = load_text(scene_text(
      "<frame name='plate'/>", "<cprsim:expect name='bad'><fails with='E401'/></cprsim:expect>"));
  EXPECT_FALSE(result.scene);
  EXPECT_EQ(result.expected_failure, "E401");
  EXPECT_EQ(error_codes(result), std::vector<std::string>{"E401"});
}

TEST(Loading, ReportsAllIndependentMistakesAtOnce) {
  std::string text = scene_text(
      "<frame name='f' attached_to='nowhere'/><cprsim:drive rod='lag' "
      "quantity='length'><constant value='1'/></cprsim:drive>",
      "<cprsim:video camera='none' file='../x.mp4'/>");
  text.replace(text.find("<length>0.4"), 11, "<length>-4");
  const std::vector<std::string> expected{"E306", "E403", "E404", "E410"};
  EXPECT_EQ(error_codes(load_text(text)), expected);
}

// Where this spline is back at 0, round-off leaves -7e-15.
TEST(Loading, LetsADriveEndAtItsLimit) {
  const auto scene = scene_of(R"(
    <joint name="slide" type="prismatic"><parent>base</parent><child>plate</child>
      <axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>30</upper></limit></axis></joint>
    <cprsim:drive joint="slide" quantity="position">
      <keyframes interpolation="cubic">0 0, 0.2 5, 0.5 20, 0.8 20, 1 0</keyframes>
    </cprsim:drive>)");
  ASSERT_EQ(scene->drives.size(), 1u);
  EXPECT_LT(scene->drives[0].profile.evaluate(1, true).value, 0);
}

TEST(Loading, ReadsEveryAxisOfAJoint) {
  const auto scene = scene_of(R"(
    <cprsim:joint name="table" type="planar"><parent>base</parent><child>plate</child>
      <axis><xyz>0 2 0</xyz><limit><lower>-1</lower><upper>2</upper><stiffness>50</stiffness><dissipation>0.5</dissipation></limit></axis>
      <axis2><xyz>0 0 1</xyz><dynamics><friction>0.3</friction></dynamics></axis2>
      <axis3><dynamics><damping>0.2</damping><spring_stiffness>4</spring_stiffness></dynamics></axis3>
    </cprsim:joint>
    <joint name="bolt" type="screw"><parent>base</parent><child>plate</child>
      <axis><xyz>1 0 0</xyz></axis><screw_thread_pitch>-0.01</screw_thread_pitch></joint>
    <cprsim:drive joint="table" axis="3" quantity="velocity"><constant value="1"/></cprsim:drive>)");
  ASSERT_EQ(scene->joints.size(), 3u);
  const auto named = [&](const std::string& name) {
    for (const JointSpec& joint : scene->joints)
      if (joint.name == name) return joint;
    return JointSpec{};
  };
  const JointSpec table = named("robot::table"), bolt = named("robot::bolt");
  EXPECT_EQ(table.kind, JointKind::kPlanar);
  EXPECT_EQ(table.axis, Vec3::UnitY());
  EXPECT_EQ(table.lower, -1);
  EXPECT_EQ(table.stop_stiffness, 50);
  EXPECT_EQ(table.stop_dissipation, 0.5);
  EXPECT_EQ(table.second.axis, Vec3::UnitZ());
  EXPECT_EQ(table.second.friction, 0.3);
  EXPECT_FALSE(table.second.limited());
  EXPECT_EQ(table.third.damping, 0.2);
  EXPECT_EQ(table.third.spring_stiffness, 4);
  EXPECT_EQ(bolt.kind, JointKind::kScrew);
  EXPECT_EQ(bolt.screw_pitch, -0.01);
  ASSERT_EQ(scene->drives.size(), 1u);
  EXPECT_EQ(scene->drives[0].freedom, 2);
}

}  // namespace
}  // namespace cprsim
