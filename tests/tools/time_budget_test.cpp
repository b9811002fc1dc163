// SPDX-License-Identifier: BSD-3-Clause
// cprsim run --profile, --trace and --real-time-factor: where time goes, and what fits into it.
#include <algorithm>

#include "tests/tools/program.h"

namespace cprsim {
namespace {

using Json = nlohmann::json;

class TimeBudget : public ProgramTest {
 protected:
  const std::string rod_ =
      shipped("scenes/mechanics/released_rod.xml") + " --duration 0.05 --no-video ";
};

TEST_F(TimeBudget, AProfileAddsUpAndChangesNothing) {
  ASSERT_LE(run("run " + rod_ + "-q -o plain").code, 1);
  const Answer answer = run("run " + rod_ + "--profile -o profiled");
  ASSERT_LE(answer.code, 1);
  EXPECT_TRUE(answer.says("where the time went")) << answer.out;
  EXPECT_TRUE(answer.says("ns each"));
  EXPECT_EQ(contents(folder_ / "plain/released_rod.csv"),
            contents(folder_ / "profiled/released_rod.csv"));
  const Json plain = json("plain/run.json"), profiled = json("profiled/run.json");
  EXPECT_FALSE(plain["timings"].contains("phases"));
  double sum = 0;
  for (const Json& phase : profiled["timings"]["phases"])
    sum += phase["seconds"].get<double>();
  EXPECT_LT(sum, profiled["timings"]["total"].get<double>());
  const Json phases = profiled["timings"]["phases"];
  EXPECT_GE(phases["elimination"]["count"], profiled["statistics"]["factorizations"]);
  EXPECT_GE(phases["observation"]["count"], profiled["statistics"]["steps"]);
  EXPECT_EQ(phases["contact"]["count"], 0);
  EXPECT_EQ(phases["free_bodies"]["count"], 0);
  EXPECT_EQ(phases["pictures"]["count"], 0);
}

TEST_F(TimeBudget, ATraceHoldsEveryStepWithThePhasesWithinIt) {
  ASSERT_LE(run("run " + rod_ + "-q --trace trace.json -o r").code, 1);
  const Json trace = json("trace.json");
  std::vector<std::pair<double, double>> steps, sections;
  for (const Json& event : trace["traceEvents"]) {
    if (event["ph"] != "X") continue;
    const double begin = event["ts"], end = begin + event["dur"].get<double>();
    EXPECT_GE(begin, 0);
    if (event["name"] == "step") steps.emplace_back(begin, end);
    if (event["name"] == "sections") sections.emplace_back(begin, end);
  }
  EXPECT_EQ(steps.size(), json("r/run.json")["statistics"]["steps"]);
  constexpr double kRounding = 0.01;  // of times in the file, microseconds
  const auto within = [&](const auto& step) {
    return std::any_of(sections.begin(), sections.end(), [&](const auto& section) {
      return section.first >= step.first - kRounding && section.second <= step.second + kRounding;
    });
  };
  EXPECT_TRUE(std::all_of(steps.begin(), steps.end(), within));
  EXPECT_EQ(run("run " + rod_ + "-q --trace nowhere/trace.json -o s").code, 5);
}

TEST_F(TimeBudget, BuysAnAccuracyWhoseErrorIsTold) {
  const Answer answer = run("run " + rod_ + "--real-time-factor 0.1 -o r");
  ASSERT_LE(answer.code, 1) << answer.err;
  EXPECT_TRUE(answer.says("which buys --accuracy")) << answer.out;
  const Json real_time = json("r/run.json")["real_time"];
  EXPECT_TRUE(real_time["kept_up"]);
  EXPECT_GE(real_time["factor_of_the_trial"], 0.1);
  EXPECT_LT(real_time["accuracy"], 0.04);
  ASSERT_LE(run("run " + rod_ + "-q --set tolerance=1e-10 --set points=12 -o tight").code, 1);
  const Json compared =
      Json::parse(run("compare r tight/released_rod.csv --of wire::rod.tip.position --json").out);
  EXPECT_GT(real_time["estimate"].get<double>() + 1e-9,
            0.5 * compared["quantities"][0]["max"].get<double>());
}

TEST_F(TimeBudget, ThatNoSettingKeepsIsSaid) {
  const Answer answer = run("run " + rod_ + "--real-time-factor 1e9 -o r");
  EXPECT_LE(answer.code, 1);
  EXPECT_NE(answer.err.find("the coarsest settings reach"), std::string::npos) << answer.err;
  EXPECT_FALSE(json("r/run.json")["real_time"]["kept_up"]);
  EXPECT_EQ(json("r/run.json")["real_time"]["runs"], 1);
  const std::string still = shipped("scenes/robots/csg_published.xml");
  EXPECT_EQ(run("run " + still + " --real-time-factor 1 -o s").code, 3);
  EXPECT_EQ(run("run " + rod_ + "--real-time-factor 0").code, 2);
}

}  // namespace
}  // namespace cprsim
