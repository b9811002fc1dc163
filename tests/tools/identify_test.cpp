// SPDX-License-Identifier: BSD-3-Clause
// cprsim identify against scenes whose answers are known: in closed form, or because the
// measurements were made from them.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/run/observe.h"
#include "scenes/loader/load.h"
#include "tests/tools/identify_fixture.h"
#include "tools/cprsim/build_simulation.h"
#include "tools/cprsim/identify_model.h"

namespace cprsim {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

const std::string kWire = kScenes + "cantilever_end_moment.xml";
constexpr double kLength = 0.4;

double curvature(double moment, double E) {
  return moment / (E * std::acos(-1.0) / 4 * 1e-12);
}

/// Tip of the wire under a moment: a circle.
double tip_x(double k) {
  return (1 - std::cos(k * kLength)) / k;
}

double tip_z(double k) {
  return std::sin(k * kLength) / k;
}

class Identify : public IdentifyTest {
 protected:
  void SetUp() override { spill(folder_ / "tips.csv", tips()); }

  static std::string tips() {
    std::string table = "# tips of a wire\nM [N mm],tip x [cm],tip z [mm]\n";
    for (const double moment : {0.1, 0.2, 0.4, 0.6}) {
      const double k = curvature(moment, kE);
      table += fmt::format("{},{:.17g},{:.17g}\n", 1000 * moment, 100 * tip_x(k), 1000 * tip_z(k));
    }
    return table;
  }

  Words wire_words(const std::string& table = "tips.csv") const {
    return {kWire,     path(table),
            "--input", "M=wire/cprsim:load/torque#2",
            "--match", "tip x=wire::rod.tip.position.x",
            "--match", "tip z=wire::rod.tip.position.z"};
  }
};

TEST_F(Identify, FindsTheStiffnessFromTipsUnderKnownMoments) {
  EXPECT_EQ(run(wire_words(), {"--fit", kStiffness + "=120e9:20e9:900e9"}), 0) << errors_;
  const Json json = report();
  EXPECT_EQ(json["status"], "converged");
  EXPECT_EQ(json["numbers"], 8);
  // the scene asks for an accuracy of 1e-9 m
  EXPECT_NEAR(json["values"][0]["value"].get<double>() / kE, 1, 1e-8);
  EXPECT_LT(json["measured"][0]["rms_after"].get<double>(), 1e-9);
  EXPECT_GT(json["measured"][0]["rms_before"].get<double>(), 1e-2);
}

TEST_F(Identify, FindsLengthAndStiffnessTogetherAndConvertsUnits) {
  EXPECT_EQ(
      run(wire_words(), {"--fit", kStiffness + "=300e9", "--fit", "wire::rod/length=0.35:0.2:0.6"}),
      0);
  const Json values = report()["values"];
  EXPECT_NEAR(values[0]["value"].get<double>() / kE, 1, 1e-7);
  EXPECT_NEAR(values[1]["value"].get<double>(), kLength, 1e-9);
}

TEST_F(Identify, HelpsWithExamplesAndExitCodes) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(identify_command({"--help"}), 0);
  const std::string help = testing::internal::GetCapturedStdout();
  EXPECT_LT(help.find("Examples"), help.find("Exit codes"));
  EXPECT_LT(help.find("Exit codes"), help.find("--fit PATH"));
}

TEST_F(Identify, DifferentiatesThroughTheSolver) {
  Words words = wire_words();
  words.insert(words.end(), {"--fit", kStiffness + "=200e9:20e9:900e9"});
  const auto options = parse_identify_options(words);
  const auto study = prepare_study(std::get<IdentifyOptions>(options), Console({}));
  ASSERT_TRUE(std::holds_alternative<Study>(study));
  SceneFit model(std::get<Study>(study));
  VecX r;
  MatX J;
  ASSERT_TRUE(model.residuals(model.start(), r)) << model.failure();
  ASSERT_TRUE(model.derivative(model.start(), r, J));
  int row = 0;
  for (const double moment : {0.1, 0.2, 0.4, 0.6}) {
    // z is ln E, and d/d ln E = -k d/dk
    const double k = curvature(moment, kE);
    const double dx = tip_x(k) - kLength * std::sin(k * kLength);
    const double dz = tip_z(k) - kLength * std::cos(k * kLength);
    // single Newton steps of 1e-5: truncation of about 1e-10, rounding of about 1e-14 / 1e-5
    EXPECT_NEAR(J(row++, 0), dx, 1e-9 * kLength);
    EXPECT_NEAR(J(row++, 0), dz, 1e-9 * kLength);
  }
}

TEST_F(Identify, SkipsCellsThatNobodyCouldRead) {
  std::string table = tips();
  table += "700,,nan\n800,?,-\n,1,2\n";
  spill(folder_ / "holes.csv", table);
  EXPECT_EQ(run(wire_words("holes.csv"), {"--fit", kStiffness}), 0) << errors_;
  const Json json = report();
  EXPECT_EQ(json["numbers"], 8);
  EXPECT_EQ(json["missing"], 4);
  EXPECT_EQ(json["rows_without_input"], 1);
}

TEST_F(Identify, SaysThatOnlyTheProductOfTwoValuesIsSeen) {
  // of a rod that only bends the tips show E I: E down by 1 % is radius up by 0.25 %
  EXPECT_EQ(run(wire_words(), {"--fit", kStiffness + "=220e9:20e9:900e9", "--fit",
                               "wire::rod/cross_section/circle/radius"}),
            1);
  const Json json = report();
  for (const Json& value : json["values"]) {
    EXPECT_FALSE(value["determined"].get<bool>());
    EXPECT_TRUE(value["standard_error"].is_null());
    EXPECT_EQ(value["state"], "NOT OBSERVABLE: dependent");
  }
  ASSERT_EQ(json["undetermined_combinations"].size(), 1U);
  const std::string text = json["undetermined_combinations"][0];
  EXPECT_NE(text.find("0.25 %"), std::string::npos) << text;
  // what is determined, is
  const double E = json["values"][0]["value"], radius = json["values"][1]["value"];
  EXPECT_NEAR(E * std::pow(radius, 4) / (kE * 1e-12), 1, 1e-6);
}

TEST_F(Identify, SaysThatNothingDependsOnAValue) {
  EXPECT_EQ(run(wire_words(), {"--fit", kStiffness, "--fit", "wire::rod/material/shear_modulus"}),
            1);
  const Json values = report()["values"];
  EXPECT_TRUE(values[0]["determined"].get<bool>());
  EXPECT_EQ(values[1]["state"], "NOT OBSERVABLE: no influence");
}

/// An elastic slider-crank: weightless, so that its shape is that of any stiffness.
constexpr const char* kCrank =
    R"(<sdf version="1.11" xmlns:cprsim="urn:cprsim:1"><world name="crank">
  <physics name="default" type="bullet"><cprsim:solver method="auto"><accuracy>1e-9</accuracy></cprsim:solver></physics>
  <cprsim:simulation mode="static"/><cprsim:effects/>
  <model name="m">
    <link name="crank"><pose>0 0 0 0 0 1</pose></link>
    <joint name="a" type="fixed"><parent>world</parent><child>crank</child></joint>
    <link name="slider"><pose>0.4 0 0 0 0 0</pose>
      <inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
    <joint name="b" type="prismatic"><parent>world</parent><child>slider</child><axis><xyz>1 0 0</xyz></axis></joint>
    <cprsim:rod name="rod">
      <base attached_to="crank" joint="fixed"><pose>0 0 0 0 1.5707963267948966 0</pose></base>
      <tip attached_to="slider" joint="fixed"><pose>0 0 0 0 1.5707963267948966 0</pose></tip>
      <length>0.4</length><cross_section><circle><radius>0.001</radius></circle></cross_section>
      <material><density>1900</density><youngs_modulus>36e9</youngs_modulus><shear_modulus>14e9</shear_modulus></material>
    </cprsim:rod>
  </model></world></sdf>)";

TEST_F(Identify, SaysThatAWeightlessShapeDoesNotShowItsStiffness) {
  spill(folder_ / "crank.xml", kCrank);
  spill(folder_ / "crank.csv", "m::slider.position.x [cm]\n35.2\n35.1\n35.0\n");
  const Words words{path("crank.xml"), path("crank.csv"), "--fit", "m::rod/length=0.4:0.3:0.6"};
  EXPECT_EQ(run(words, {"--fit", "m::rod/material/youngs_modulus"}), 1) << errors_;
  const Json values = report()["values"];
  EXPECT_TRUE(values[0]["determined"].get<bool>());
  EXPECT_EQ(values[1]["state"], "NOT OBSERVABLE: no influence");
  EXPECT_EQ(values[1]["value"], 36e9);
  EXPECT_EQ(run(words, {}), 0) << errors_;
  EXPECT_NEAR(report()["values"][0]["value"].get<double>(), values[0]["value"].get<double>(), 1e-9);
}

TEST_F(Identify, HoldsAValueAtItsBound) {
  EXPECT_EQ(run(wire_words(), {"--fit", kStiffness + "=250e9:220e9:300e9"}), 1) << errors_;
  const Json value = report()["values"][0];
  EXPECT_EQ(value["state"], "at its lower bound");
  EXPECT_EQ(value["value"], 220e9);
  EXPECT_TRUE(value["interval"][0].is_null());
}

TEST_F(Identify, RefusesTrialsThatTheSceneForbids) {
  // without bounds the first step would make the radius negative
  EXPECT_EQ(run(wire_words(), {"--fit", "wire::rod/cross_section/circle/radius=0.004"}), 0)
      << errors_;
  EXPECT_NEAR(report()["values"][0]["value"].get<double>(), 1e-3, 1e-10);
}

TEST_F(Identify, SaysWhatIsWrong) {
  const std::string fit = kStiffness;
  const auto table = [&](const char* name, const std::string& text) {
    spill(folder_ / name, text);
    return wire_words(name);
  };
  const Words good = wire_words();

  struct Case {
    Words words, more;
    int code;
    const char* says;
  };

  const Case cases[] = {
      {good, {}, 2, "--fit"},
      {good, {"--fit", fit + "=1e9:3e9:2e9"}, 2, "reversed"},
      {good, {"--fit", fit + "=9e9:1e9:2e9"}, 2, "outside its bounds"},
      {good, {"--fit", fit + "=1e9:2e9"}, 2, "PATH=START:LOW:HIGH"},
      {good, {"--fit", fit + "=much"}, 2, "'much'"},
      {good, {"--fit", "wire::rod/lenght"}, 3, "did you mean 'length'"},
      {good, {"--fit", "wire/cprsim:load/torque"}, 2, "pick one with #1"},
      {good, {"--fit", "wire/cprsim:load/torque#4"}, 3, "there are 3 numbers"},
      {good, {"--fit", "wire/cprsim:load/torque#1"}, 2, "give bounds"},
      {good, {"--fit", fit + "=-1e9"}, 3, "is invalid"},
      {good, {"--fit", fit, "--match", "tip y=wire::rod.tip.position.y"}, 2, "no such column"},
      {good, {"--fit", fit, "--match", "tip x=wire::rod.tip.position"}, 2, "3 channels"},
      {good, {"--fit", fit, "--match", "tip x=wire::rod.tip.positon.x"}, 2, "is no channel"},
      {good, {"--fit", fit, "--match", "M=wire::rod.tip.position.x"}, 2, "[N mm]"},
      {good, {"--fit", fit, "--input", "N=wire::rod/length"}, 2, "no such column"},
      {good, {"--fit", fit, "--input", "M=wire::rud/length"}, 3, "nothing here is called"},
      {good, {"--fit", fit, "--sigma", "tip x=0.1"}, 2, "give all or none"},
      {good, {"--fit", fit, "--sigma", "tip x=0"}, 2, "greater than 0"},
      {table("word.csv", "M,tip x,tip z\n1,2,three\n"), {"--fit", fit}, 2, "word.csv:2: 'three'"},
      {table("short.csv", "M,tip x,tip z\n1,2\n"), {"--fit", fit}, 2, "2 cells"},
      {table("unit.csv", "M [lbf],tip x,tip z\n1,2,3\n"), {"--fit", fit}, 2, "[lbf]"},
      {table("empty.csv", "M,tip x,tip z\n"), {"--fit", fit}, 2, "no rows"},
      {table("twice.csv", "M,M,tip z\n1,2,3\n"), {"--fit", fit}, 2, "two columns"},
      {wire_words("absent.csv"), {"--fit", fit}, 2, "cannot be opened"},
      {{kWire, path("tips.csv")}, {"--fit", fit}, 2, "--match"},
  };
  for (const Case& each : cases) {
    EXPECT_EQ(run(each.words, each.more), each.code) << each.says << "\n" << errors_;
    EXPECT_TRUE(complains(each.says)) << each.says << "\n" << errors_;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/identify.json"));
}

/// Weightless, both ends held, bent by half a turn between them: its shape is that of any
/// stiffness.
constexpr const char* kArch = R"(<sdf version="1.11" xmlns:cprsim="urn:cprsim:1"><world name="arch">
  <physics name="default" type="bullet"><cprsim:solver method="auto"><accuracy>1e-9</accuracy></cprsim:solver></physics>
  <cprsim:simulation mode="static"/><cprsim:effects/>
  <model name="m">
    <link name="left"/><link name="right"><pose>0.25 0 0 0 3.141592653589793 0</pose></link>
    <joint name="a" type="fixed"><parent>world</parent><child>left</child></joint>
    <joint name="b" type="fixed"><parent>world</parent><child>right</child></joint>
    <cprsim:rod name="rod"><base attached_to="left" joint="fixed"/><tip attached_to="right" joint="fixed"/>
      <length>0.5</length><cross_section><circle><radius>0.001</radius></circle></cross_section>
      <material><density>1900</density><youngs_modulus>36e9</youngs_modulus><shear_modulus>14e9</shear_modulus></material>
    </cprsim:rod>
  </model></world></sdf>)";

TEST_F(Identify, NamesTheRowThatHasNoEquilibriumAtTheStart) {
  // nearly taut, and yet turned by half a turn at the end
  spill(folder_ / "arch.xml", kArch);
  spill(folder_ / "far.csv", "x [m],m::rod(s=0.5).position.z [m]\n0.25,0.18\n0.499,0.18\n");
  EXPECT_EQ(run({path("arch.xml"), path("far.csv")},
                {"--fit", "m::rod/length=0.5:0.4:0.6", "--input", "x=m::right/pose#1"}),
            4);
  EXPECT_TRUE(complains("far.csv:3: no static equilibrium found")) << errors_;
}

TEST_F(Identify, FollowsTheEquilibriumOfANeighbour) {
  const auto tip = [](const Values& set, const Simulation* from, int& iterations) {
    LoadOptions load;
    load.set = set;
    const auto scene = load_scene(kScenes + "released_rod.xml", load).scene;
    auto simulation = build_simulation(*scene);
    bool followed = true;
    const SolveReport& report =
        from ? simulation->start_near(*from->unknowns(), &followed) : simulation->start();
    EXPECT_TRUE(followed);
    EXPECT_TRUE(report.converged());
    iterations = report.iterations;
    return evaluate(find_channels(*scene, "wire::rod.tip.position.x")[0], *scene,
                    simulation->now());
  };
  int cold = 0, warm = 0;
  const Values near{{kStiffness, "200.02e9"}};
  const auto scene = load_scene(kScenes + "released_rod.xml").scene;
  const auto neighbour = build_simulation(*scene);
  neighbour->start();
  const double sought = tip(near, nullptr, cold);
  const double followed = tip(near, neighbour.get(), warm);
  EXPECT_NEAR(followed, sought, 1e-10);
  EXPECT_LE(warm, 3);
  EXPECT_LT(warm, cold);
}

}  // namespace
}  // namespace cprsim
