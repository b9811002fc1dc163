// SPDX-License-Identifier: BSD-3-Clause
// cprsim sweep and cprsim effects: settings in; errors, orders, costs and pictures out.
#include <algorithm>
#include <cmath>

#include "tests/tools/program.h"

namespace cprsim {
namespace {

using Json = nlohmann::json;

class Sweep : public ProgramTest {
 protected:
  /// The released rod, held: an equilibrium, 2 ms a run.
  const std::string held_ =
      shipped("scenes/mechanics/released_rod.xml") + " --set simulation/@mode=static ";
  /// Let go and followed for a twentieth of a second.
  const std::string released_ = shipped("scenes/mechanics/released_rod.xml") + " --duration 0.05 ";

  /// What does not depend on the machine.
  static Json facts(const Json& report) {
    Json list = Json::array();
    for (const Json& run : report["runs"])
      list.push_back({run["settings"], run["errors"], run["section_evaluations"], run["last"]});
    return list;
  }
};

TEST_F(Sweep, ShowsTheOrdersInArcLength) {
  const Answer answer = run("sweep " + held_ +
                            "--vary integrator=gauss2,gauss4,rk4 --vary points=8,16,32 --repeat 1");
  ASSERT_EQ(answer.code, 0) << answer.err;
  const Json report = json("out/released_rod_sweep/sweep.json");
  ASSERT_EQ(report["runs"].size(), 9U);
  const auto order = [&](std::size_t i) { return report["runs"][i]["order"].get<double>(); };
  EXPECT_NEAR(order(2), 2, 0.1);
  EXPECT_NEAR(order(5), 4, 0.1);
  EXPECT_NEAR(order(8), 4, 0.3);
  EXPECT_FALSE(report["runs"][0].contains("order"));
  for (const Json& one : report["runs"])
    EXPECT_GT(one["section_evaluations"].get<long>(), 0);
}

TEST_F(Sweep, ShowsTheOrdersInTime) {
  const Answer answer = run("sweep " + released_ +
                            "--vary scheme=backward_euler,bdf2 --vary step=4e-4,2e-4 --norm final "
                            "--repeat 1 --reference scheme=esdirk43,tolerance=1e-8");
  ASSERT_EQ(answer.code, 0) << answer.err;
  const Json report = json("out/released_rod_sweep/sweep.json");
  EXPECT_NEAR(report["runs"][1]["order"].get<double>(), 1, 0.3);
  EXPECT_NEAR(report["runs"][3]["order"].get<double>(), 2, 0.3);
}

TEST_F(Sweep, SaysWhatAccuracyCostsInWordsTablesAndAPage) {
  const Answer answer = run("sweep " + held_ + "--vary points=1,2,4,8 --repeat 1");
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_TRUE(answer.says("costs")) << answer.out;
  EXPECT_TRUE(answer.says(" m costs ")) << answer.out;
  const Json report = json("out/released_rod_sweep/sweep.json");
  ASSERT_GE(report["decades"].size(), 2U);
  double last = 1e300;
  for (const Json& decade : report["decades"]) {
    const Json one = report["runs"][decade["run"].get<std::size_t>()];
    EXPECT_LE(one["errors"][0].get<double>(), decade["bound"].get<double>());
    EXPECT_LT(one["errors"][0].get<double>(), last);
    last = one["errors"][0].get<double>();
    EXPECT_TRUE(one["cheapest"].get<bool>());
  }
  const std::string csv = contents(folder_ / "out/released_rod_sweep/sweep.csv");
  EXPECT_EQ(csv.substr(0, csv.find("order")),
            "points,line,status,max error of wire::rod.tip.position [m],");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_NE(contents(folder_ / "out/released_rod_sweep/sweep.html").find("<table>"),
            std::string::npos);
}

// What is asked for is what a sweep over it shows, and its pilots are paid for.
TEST_F(Sweep, OverAccuraciesKeepsThem) {
  const std::string words = "sweep " + held_ + "--repeat 1 --vary ";
  const Answer answer = run(words + "accuracy=1e-4,1e-6,1e-8");
  ASSERT_EQ(answer.code, 0) << answer.err;
  const Json report = json("out/released_rod_sweep/sweep.json");
  long last = 0;
  for (const Json& one : report["runs"]) {
    EXPECT_LE(one["errors"][0].get<double>(),
              std::stod(one["settings"]["accuracy"].get<std::string>()));
    EXPECT_GT(one["section_evaluations"].get<long>(), last);
    last = one["section_evaluations"];
  }
  ASSERT_EQ(run(words + "points=12").code, 0);
  const Json once = json("out/released_rod_sweep/sweep.json");
  EXPECT_GT(last, once["runs"][0]["section_evaluations"].get<long>());
}

TEST_F(Sweep, HasTheSameErrorsOnAnyNumberOfThreadsAndAfterAnInterruption) {
  const std::string words = "sweep " + held_ + "--vary points=1:8:8 --repeat 1 ";
  ASSERT_EQ(run(words + "-j 1 -o one").code, 0);
  ASSERT_EQ(run(words + "-j 3 -o three").code, 0);
  EXPECT_EQ(facts(json("one/sweep.json")), facts(json("three/sweep.json")));
  // what a kill leaves: whole lines, then part of one
  const std::string journal = contents(folder_ / "one/sweep.journal");
  spill(folder_ / "three/sweep.journal", journal.substr(0, journal.size() / 2));
  ASSERT_EQ(run(words + "-j 1 -o three --resume").code, 0);
  EXPECT_EQ(facts(json("one/sweep.json")), facts(json("three/sweep.json")));
  const Answer other = run("sweep " + held_ + "--vary points=1:9:9 -o three --resume");
  EXPECT_EQ(other.code, 2);
  EXPECT_TRUE(other.complains("another scene or with other options")) << other.err;
}

TEST_F(Sweep, TellsValuesOverAPhysicalQuantity) {
  const Answer answer =
      run("sweep " + held_ +
          "--vary wire::rod/length=0.2:0.4:3 --reference none -q --without gravity "
          "--measure wire::rod.tip.position");
  ASSERT_EQ(answer.code, 0) << answer.err;
  const Json report = json("out/released_rod_sweep/sweep.json");
  ASSERT_EQ(report["runs"].size(), 3U);
  EXPECT_EQ(report["runs"][1]["settings"]["wire::rod/length"], "0.3");
  // the deflection of a cantilever grows with the third power of its length while it is small
  const auto x = [&](std::size_t i) { return report["runs"][i]["last"][0].get<double>(); };
  EXPECT_NEAR(x(0), -1 * std::pow(0.2, 3) / 3 / 0.15707963, 1e-3 * std::abs(x(0)) + 3e-4);
  EXPECT_LT(x(2), 2 * x(1));
}

TEST_F(Sweep, EveryCombinationOfPhysicalValuesHasItsOwnReference) {
  ASSERT_EQ(
      run("sweep " + held_ + "--vary wire::rod/length=0.2,0.4 --vary points=12 --repeat 1").code,
      0);
  const Json sweep = json("out/released_rod_sweep/sweep.json");
  for (const Json& one : sweep["runs"])
    EXPECT_LT(one["errors"][0].get<double>(), 1e-8);
}

TEST_F(Sweep, SaysWhichSettingsAreRefusedAndGoesOn) {
  const Answer answer = run("sweep " + held_ + "--vary integrator=gauss6,gauss5 --repeat 1");
  EXPECT_EQ(answer.code, 0) << answer.err;
  const Json report = json("out/released_rod_sweep/sweep.json");
  EXPECT_EQ(report["runs"][0]["status"], "done");
  EXPECT_EQ(report["runs"][1]["status"], "refused");
  EXPECT_NE(report["runs"][1]["reason"].get<std::string>().find("E307"), std::string::npos);
}

TEST_F(Sweep, CarriesOutWhatTheSceneAsksFor) {
  spill(
      folder_ / "s.xml",
      with(contents(shipped("scenes/mechanics/released_rod.xml")), "  </world>",
           "<cprsim:sweep name=\"cells\"><vary path=\"points\">2 4</vary><reference value=\"12\"/>"
           "<measure of=\"wire::rod(s=0.5).position\"/></cprsim:sweep>\n  </world>"));
  const Answer answer = run("sweep s.xml --set simulation/@mode=static --json --repeat 1");
  ASSERT_EQ(answer.code, 0) << answer.err;
  const Json report = Json::parse(answer.out);
  EXPECT_EQ(report["reference"], "the run with points=12");
  EXPECT_EQ(report["measures"][0]["name"], "wire::rod(s=0.5).position");
  EXPECT_EQ(report["runs"].size(), 2U);
  // or every scheme and method instead
  ASSERT_EQ(run("sweep s.xml --set simulation/@mode=static --sweep all --quick --repeat 1").code,
            0);
  EXPECT_GT(json("out/s_sweep/sweep.json")["runs"].size(), 10U);
}

TEST_F(Sweep, WrongWordsAreAnsweredWithWhatWouldBeRight) {
  for (const auto& [words, part] :
       {std::pair("--vary points", "NAME=a,b,c"), std::pair("--vary points=1:0:3log", "above 0"),
        std::pair("--vary points=1,2 --measure wire::rod.tip.positon", "wire::rod.tip.position"),
        std::pair("--vary points=1,2 --norm mean", "max, rms, final"),
        std::pair("--sweep cells", "'cells' is not"),
        std::pair("--vary points=1,2 --reference nowhere.csv", "NAME=VALUE")}) {
    const Answer answer = run("sweep " + held_ + words);
    EXPECT_EQ(answer.code, 2) << words;
    EXPECT_TRUE(answer.complains(part)) << answer.err;
  }
  EXPECT_FALSE(exists("out"));
}

TEST_F(Sweep, EffectsTellsWhatEachChangesAndCosts) {
  const Answer answer = run("effects " + held_ + "--json");
  ASSERT_EQ(answer.code, 0) << answer.err;
  const Json report = Json::parse(answer.out);
  const auto row = [&](const std::string& effect) {
    for (const Json& one : report["rows"])
      if (one["effect"] == effect) return one;
    return Json();
  };
  // its own weight bends the rod by w L⁴ / (8 EI), less where the load has bent it already
  EXPECT_NEAR(row("gravity")["change"].get<double>(),
              8000 * 3.1416e-6 * 9.81 * std::pow(0.4, 4) / 8 / 0.15708, 2e-3);
  EXPECT_FALSE(row("gravity")["added"]);
  // shear: F L / (kappa GA) is a micrometre
  EXPECT_LT(row("shear")["change"].get<double>(), 1e-5);
  EXPECT_LT(row("rotary_inertia")["change"].get<double>(), 1e-9);  // nothing moves
  EXPECT_TRUE(row("drag").contains("problem"));
  EXPECT_LT(report["numerical_error"].get<double>(), 1e-7);
  EXPECT_TRUE(exists("out/released_rod_effects/effects.csv"));
}

TEST_F(Sweep, IdaIsAReferenceOfItsOwn) {
  const std::string words =
      "sweep " + released_ + "--vary scheme=esdirk43 --vary tolerance=1e-4,1e-6 --repeat 1 -q ";
  ASSERT_EQ(run(words + "-o ours").code, 0);
  ASSERT_EQ(run(words + "--reference ida -o ida").code, 0);
  const Json ours = json("ours/sweep.json"), ida = json("ida/sweep.json");
  EXPECT_NE(ida["reference"].get<std::string>().find("scheme=ida"), std::string::npos);
  for (std::size_t i = 0; i < 2; ++i) {
    const double error = ours["runs"][i]["errors"][0];
    EXPECT_NEAR(ida["runs"][i]["errors"][0].get<double>(), error, 0.02 * error) << i;
  }
  EXPECT_EQ(run("sweep " + shipped("scenes/robots/csg_published.xml") + " --reference ida").code,
            2);
}

TEST_F(Sweep, PlotDrawsRecordingsAndScenes) {
  ASSERT_EQ(run("run " + released_ + "--no-video -o r -q").code, 0);
  for (const char* words :
       {"plot r", "plot r r/released_rod.csv -c wire::rod.tip.position --format png",
        "plot r --path wire::rod.tip.position", "plot r --energy"}) {
    const Answer answer = run(words);
    EXPECT_EQ(answer.code, 0) << words << answer.err;
  }
  EXPECT_EQ(run("plot " + released_ + "--solver -o s").code, 0);
  EXPECT_EQ(run("plot " + released_ + "--shapes 5 -o s").code, 0);
  const std::string shapes = contents(folder_ / "s/shapes.csv");
  EXPECT_EQ(shapes.substr(0, shapes.find('\n')), "rod,time [s],x [m],y [m],z [m]");
  EXPECT_NE(shapes.find("wire::rod,0.0125,"), std::string::npos);
  EXPECT_FALSE(exists("s/source_1.csv"));
  EXPECT_EQ(run("plot " + released_ + "--heat curvature -o heat").code, 0);
  const std::string heat = contents(folder_ / "heat/heat.csv");
  EXPECT_EQ(heat.substr(0, heat.find('\n')), "#rod,time [s],s [1],curvature [1/m]");
  EXPECT_EQ(std::count(heat.begin(), heat.end(), '\n'), 1 + 201 * 41 + 2);
  EXPECT_TRUE(exists("heat/plot.svg"));
  EXPECT_EQ(run("plot r --heat curvature").code, 2);
  EXPECT_EQ(run("plot " + released_ + "--heat warmth").code, 2);
  EXPECT_EQ(run("plot r -c nothing").code, 2);
  EXPECT_EQ(run("plot r --shapes 3").code, 2);
  EXPECT_EQ(run("plot r --format gif").code, 2);
  EXPECT_EQ(run("plot nowhere").code, 2);
}

}  // namespace
}  // namespace cprsim
