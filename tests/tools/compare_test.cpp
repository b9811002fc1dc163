// SPDX-License-Identifier: BSD-3-Clause
// cprsim compare: files in; a table, a verdict and a picture out.
#include <numbers>

#include "tests/tools/program.h"

namespace cprsim {
namespace {

class Compare : public ProgramTest {
 protected:
  void SetUp() override {
    spill(folder_ / "run.csv",
          "time [s],a.position.x [m],a.position.y [m],a.position.z [m],b.length [m]\n"
          "0,0,0,0,1\n1,1,0,0,1\n2,2,0,0,1\n");
    spill(folder_ / "reference.csv",
          "t [ms],a.position.x [mm],a.position.y [mm],a.position.z [mm]\n"
          "500,500,30,40\n1500,1500,0,0\n9000,0,0,0\n");
  }
};

TEST_F(Compare, TellsErrorsWhenTheyWereLargestAndWhatWasLeftOut) {
  const Answer answer = run("compare run.csv reference.csv --length 2");
  EXPECT_EQ(answer.code, 0) << answer.err;
  const auto report = json("out/run_compare/compare.json");
  const auto quantity = report["quantities"][0];
  EXPECT_EQ(quantity["name"], "a.position");
  EXPECT_EQ(quantity["unit"], "m");
  EXPECT_NEAR(quantity["max"], 0.05, 1e-12);
  EXPECT_NEAR(quantity["max_time"], 0.5, 1e-12);
  EXPECT_NEAR(quantity["rms"], 0.05 / std::sqrt(2), 1e-12);
  EXPECT_NEAR(quantity["max_percent_of_length"], 2.5, 1e-9);
  EXPECT_EQ(quantity["left_out"], 1);
  EXPECT_TRUE(exists("out/run_compare/compare.csv"));
  EXPECT_TRUE(answer.says("1 of them left out"));
}

TEST_F(Compare, AnswersOneIfALimitIsNotKept) {
  EXPECT_EQ(run("compare run.csv reference.csv --max 0.051 --rms a.position=0.036").code, 0);
  const Answer answer = run("compare run.csv reference.csv --max 0.049 --json");
  EXPECT_EQ(answer.code, 1);
  const auto report = nlohmann::json::parse(answer.out);
  EXPECT_FALSE(report["kept"]);
  EXPECT_NEAR(report["limits"][0]["value"], 0.05, 1e-12);
}

TEST_F(Compare, ARunComparedWithItselfIsExact) {
  ASSERT_EQ(run("run " + shipped("scenes/mechanics/released_rod.xml") +
                " --duration 0.05 --no-video -o r")
                .code,
            0);
  const Answer answer =
      run("compare r r/released_rod.csv --of wire::rod.tip.position --max 1e-15 --json");
  EXPECT_EQ(answer.code, 0) << answer.err;
  const auto report = nlohmann::json::parse(answer.out);
  EXPECT_EQ(report["quantities"].size(), 1U);
  EXPECT_EQ(report["quantities"][0]["samples"], 51);
  EXPECT_NEAR(report["length"], 0.4, 1e-12);
}

TEST_F(Compare, TellsFrequencyAmplitudeAndDampingOfWhatVibrates) {
  const auto record = [](double frequency, double amplitude, double zeta) {
    std::string text = "time [s],a.position.x [m],a.position.y [m],a.position.z [m]\n";
    for (int k = 0; k <= 2000; ++k) {
      const double t = 0.001 * k, omega = 2 * std::numbers::pi * frequency;
      text += std::to_string(t) + ",0," +
              std::to_string(amplitude * std::exp(-zeta * omega * t) * std::cos(omega * t)) +
              ",1\n";
    }
    return text;
  };
  spill(folder_ / "here.csv", record(10.1, 1.1, 0.02));
  spill(folder_ / "there.csv", record(10, 1, 0.01));
  const Answer answer = run("compare here.csv there.csv --json");
  EXPECT_EQ(answer.code, 0) << answer.err;
  const auto vibrations = nlohmann::json::parse(answer.out)["vibrations"];
  ASSERT_EQ(vibrations.size(), 1U);
  EXPECT_EQ(vibrations[0]["name"], "a.position.y");
  EXPECT_NEAR(vibrations[0]["run"]["frequency"], 10.1, 0.01);
  EXPECT_NEAR(vibrations[0]["reference"]["frequency"], 10, 0.01);
  EXPECT_NEAR(vibrations[0]["run"]["damping_ratio"], 0.02, 5e-4);
  EXPECT_NEAR(vibrations[0]["reference"]["damping_ratio"], 0.01, 5e-4);
  EXPECT_TRUE(run("compare here.csv there.csv").says("10.1 Hz, reference 10"));
}

TEST_F(Compare, TakesTumUnderAnotherNameInAnotherFrame) {
  // the frame of the TUM file lies 1 m up and is turned by 90 degrees about z
  spill(folder_ / "mocap.tum", "0 0 0 -1 0 0 0 1\n1 0 -1 -1 0 0 0 1\n2 0 -2 -1 0 0 0 1\n");
  const Answer known =
      run("compare run.csv mocap.tum --map a= --ref-frame 0,0,1,0,0,90deg --max 1e-12");
  EXPECT_EQ(known.code, 0) << known.err << known.out;
  EXPECT_EQ(run("compare run.csv mocap.tum --map a= --align yaw --max 1e-12").code, 0);
  EXPECT_EQ(run("compare run.csv mocap.tum --map a= --align translation --max 1e-12").code, 1);
}

TEST_F(Compare, UnitsThatAHeaderDoesNotNameAreAskedFor) {
  spill(folder_ / "plain.csv", "t,a.position.x,a.position.y,a.position.z\n1,1000,0,0\n");
  EXPECT_EQ(run("compare run.csv plain.csv --max 1e-12").code, 1);
  EXPECT_EQ(run("compare run.csv plain.csv --ref-units deg,mm --max 1e-12").code, 0);
}

TEST_F(Compare, WrongWordsAreAnsweredWithWhatWouldBeRight) {
  spill(folder_ / "other.csv", "t,speed\n1,2\n2,3\n");
  spill(folder_ / "force.csv", "t,b.length [N]\n1,2\n");
  for (const auto& [words, part] :
       {std::pair("run.csv other.csv", "the run has a.position, b.length"),
        std::pair("run.csv force.csv", "is in N"), std::pair("run.csv none.csv", "none.csv"),
        std::pair("run.csv reference.csv --max x=1", "'x' is not compared"),
        std::pair("run.csv reference.csv --map a=q", "called 'q'"),
        std::pair("run.csv reference.csv --align sideways", "se3"),
        std::pair("run.csv reference.csv --ref-frame 1,2", "ROLL")}) {
    const Answer answer = run(std::string("compare ") + words);
    EXPECT_EQ(answer.code, 2) << words;
    EXPECT_TRUE(answer.complains(part)) << answer.err;
  }
  EXPECT_FALSE(exists("out"));
  EXPECT_EQ(run("compare . reference.csv").code, 5);
  for (const char* text :
       {R"({"schema": 1})", R"({"schema": "cprsim-run/1", "files": [5]})",
        R"({"schema": "cprsim-run/1", "method": {"rods": [{"length": "a"}]}})"}) {
    spill(folder_ / "run.json", text);
    const Answer answer = run("compare . reference.csv");
    EXPECT_EQ(answer.code, 5) << text;
    EXPECT_TRUE(answer.complains("./run.json is not as cprsim writes it")) << answer.err;
  }
}

}  // namespace
}  // namespace cprsim
