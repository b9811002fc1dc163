// SPDX-License-Identifier: BSD-3-Clause
// The program as people and scripts meet it: words in; exit code, streams and files out.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/tools/scratch_folder.h"

namespace cprsim {
namespace {

using Json = nlohmann::json;

/// A cantilever with a ball at its tip that swings for 0.1 s.
constexpr const char* kScene = R"(<?xml version="1.0"?>
<sdf version="1.11" xmlns:cprsim="urn:cprsim:1">
  <world name="swing">
    <gravity>0 0 -9.81</gravity>
    <physics name="default" type="bullet">
      <max_step_size>0.005</max_step_size>
      <cprsim:solver method="shooting"><space points="20"/><time scheme="bdf_alpha" step="0.005"/></cprsim:solver>
    </physics>
    <cprsim:simulation mode="dynamic"><duration>0.1</duration><initial solve="none"/></cprsim:simulation>
    <cprsim:effects><gravity/></cprsim:effects>
    <model name="m">
      <link name="base"><pose>0 0 1 0 1.5707963267948966 0</pose>
        <inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
      <joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
      <cprsim:rod name="beam">
        <base attached_to="base" joint="fixed"/>
        <length>0.4</length>
        <cross_section><circle><radius>0.002</radius></circle></cross_section>
        <material><density>8000</density><youngs_modulus>200e9</youngs_modulus><shear_modulus>80e9</shear_modulus></material>
      </cprsim:rod>
    </model>
    <cprsim:record rate="200" prefix="swing">
      <channel>m::beam.tip.position</channel>
      <channel>energy.total</channel>
      <csv/><vtk every="10"/>
    </cprsim:record>
    <cprsim:expect name="falls"><bound of="m::beam.tip.position.z" max="1.001" min="0.9"/><converged/></cprsim:expect>
  </world>
</sdf>
)";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

struct Outcome {
  int code = -1;
  std::string out, err;
};

class Cprsim : public testing::Test {
 protected:
  void SetUp() override { spill(folder_ / "swing.xml", kScene); }

  /// Runs the program in the test's folder; `words` as one would type them in a shell.
  Outcome run(const std::string& words) const {
    const std::string command = "cd '" + folder_.path().string() + "' && unset GITHUB_ACTIONS && " +
                                program() + " " + words + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder_ / "out.txt"),
            contents(folder_ / "err.txt")};
  }

  Json report(const std::string& path = "out/swing/run.json") const {
    return Json::parse(contents(folder_ / path));
  }

  static std::string program() { return std::string("'") + CPRSIM_BINARY_DIR + "/bin/cprsim'"; }

  ScratchFolder folder_;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(Cprsim, HelpFitsAScreenAndStartsWithExamples) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.code, 0);
  EXPECT_LE(std::count(help.out.begin(), help.out.end(), '\n'), 40);
  EXPECT_LT(help.out.find("Examples"), help.out.find("Usage"));
  for (const char* command : {"run", "check", "info", "explain", "doctor"}) {
    const Outcome own = run(std::string(command) + " --help");
    EXPECT_EQ(own.code, 0);
    EXPECT_LE(std::count(own.out.begin(), own.out.end(), '\n'), 45) << command;
  }
}

TEST_F(Cprsim, CompletesCommandsAndTheirOptionsInAShell) {
  const auto completed = [&](const std::string& words, int at) {
    spill(folder_ / "complete.sh", run("completion bash").out + "COMP_WORDS=(" + words +
                                       ")\nCOMP_CWORD=" + std::to_string(at) +
                                       "\n_cprsim\necho \"${COMPREPLY[@]}\"\n");
    const std::string command = "cd '" + folder_.path().string() +
                                "' && PATH='" CPRSIM_BINARY_DIR
                                "/bin':$PATH bash complete.sh >words.txt 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return contents(folder_ / "words.txt");
  };
  EXPECT_EQ(completed("cprsim swe", 1), "sweep\n");
  EXPECT_EQ(completed("cprsim sw", 1), "swing.xml sweep\n");
  EXPECT_EQ(completed("cprsim sweep --no", 2), "--norm\n");
  EXPECT_EQ(completed("cprsim swing.xml --real", 2), "--real-time-factor\n");
  for (const char* shell : {"zsh", "fish"})
    EXPECT_TRUE(has(run(std::string("completion ") + shell).out, "cprsim completion options"));
  EXPECT_EQ(run("completion csh").code, 2);
}

TEST_F(Cprsim, SuggestsCommandsAndOptionsAndAnswersTwo) {
  const Outcome command = run("rnu");
  EXPECT_EQ(command.code, 2);
  EXPECT_TRUE(has(command.err, "Did you mean 'run'?"));
  const Outcome option = run("swing.xml --durtion 1");
  EXPECT_EQ(option.code, 2);
  EXPECT_TRUE(has(option.err, "Did you mean '--duration'?"));
  for (const char* words : {"", "run", "swing.xml --duration", "swing.xml --duration -1",
                            "swing.xml --step nan", "swing.xml --step 1,5", "swing.xml another",
                            "swing.xml --set length", "swing.xml --color maybe", "compare a b"}) {
    EXPECT_EQ(run(words).code, 2) << words;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(Cprsim, SaysWhenAnEquilibriumIsUnstable) {
  const std::string scene = std::string(CPRSIM_SOURCE_DIR) + "/scenes/paths/euler_column.xml";
  const Outcome below = run(scene + " --set 'column/load/force#3=-4.1'");  // P_E is 4.1123 N
  EXPECT_EQ(below.code, 0) << below.err;
  EXPECT_TRUE(has(below.out, "stable static equilibrium")) << below.out;
  EXPECT_FALSE(has(below.out + below.err, "unstable"));
  const Outcome above = run(scene + " --set 'column/load/force#3=-4.12'");
  EXPECT_EQ(above.code, 0) << above.err;
  EXPECT_TRUE(has(above.out, "unstable static equilibrium")) << above.out;
  EXPECT_TRUE(has(above.err, "unstable in 1 direction:")) << above.err;
}

TEST_F(Cprsim, RunsAFileNamedFirstOrAfterRunOrAfterAnOption) {
  for (const char* words : {"swing.xml --no-video", "run swing.xml --no-video",
                            "--no-video swing.xml", "-q run swing.xml", "run - < swing.xml"}) {
    EXPECT_EQ(run(words).code, 0) << words;
  }
}

TEST_F(Cprsim, WritesWhatTheSceneAsksFor) {
  const Outcome outcome = run("swing.xml");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "swing: 0.100 s simulated in"));
  EXPECT_TRUE(has(outcome.out, "effects    bending torsion gravity"));
  EXPECT_TRUE(has(outcome.out, "expect     1 of 1 met"));
  const std::string csv = contents(folder_ / "out/swing/swing.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "time [s],m::beam.tip.position.x [m],m::beam.tip.position.y [m],"
            "m::beam.tip.position.z [m],energy.total [J]");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 21);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/swing/swing_vtk/000002.vtp"));

  const Json json = report();
  EXPECT_EQ(json["schema"], "cprsim-run/1");
  EXPECT_EQ(json["status"], "done");
  EXPECT_EQ(json["time"], 0.1);
  EXPECT_TRUE(json["effects"]["gravity"]["on"]);
  EXPECT_FALSE(json["effects"]["damping"]["on"]);
  EXPECT_GT(json["statistics"]["steps"], 0);
  EXPECT_EQ(json["expectations"][0]["verdict"], "met");
  EXPECT_FALSE(json["scene"]["hash"].get<std::string>().empty());
  for (const Json& file : json["files"]) {
    EXPECT_TRUE(
        std::filesystem::exists(folder_ / ("out/swing/" + file["name"].get<std::string>())));
  }
}

TEST_F(Cprsim, WritesTheSameBytesEveryTime) {
  ASSERT_EQ(run("swing.xml -o a").code, 0);
  ASSERT_EQ(run("swing.xml -o b -j 1").code, 0);
  EXPECT_EQ(contents(folder_ / "a/swing.csv"), contents(folder_ / "b/swing.csv"));
  EXPECT_EQ(contents(folder_ / "a/swing_vtk/000002.vtp"),
            contents(folder_ / "b/swing_vtk/000002.vtp"));
  Json a = report("a/run.json"), b = report("b/run.json");
  a.erase("timings");
  b.erase("timings");
  EXPECT_EQ(a.dump(), b.dump());
}

TEST_F(Cprsim, PrintsTheReportAsJson) {
  const Outcome outcome = run("swing.xml --json");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(Json::parse(outcome.out), report());
}

TEST_F(Cprsim, AnswersOneWhenAnExpectationIsNotMet) {
  spill(folder_ / "swing.xml", with(kScene, "max=\"1.001\"", "max=\"0.95\""));
  const Outcome outcome = run("swing.xml");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(has(outcome.out, "not met: 'falls'"));
  EXPECT_TRUE(has(outcome.out, "m::beam.tip.position.z = "));
  EXPECT_EQ(report()["exit_code"], 1);
}

TEST_F(Cprsim, AnswersThreeAndTheLineForAnInvalidSceneAndWritesNothing) {
  spill(folder_ / "swing.xml", with(kScene, "<length>0.4</length>", "<lenght>0.4</lenght>"));
  for (const char* words : {"swing.xml", "check swing.xml", "info swing.xml", "swing.xml --json"}) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 3) << words;
    EXPECT_TRUE(has(outcome.err, "swing.xml:17:")) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "did you mean <length>?")) << outcome.err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  EXPECT_EQ(run("missing.xml").code, 3);
}

TEST_F(Cprsim, ChecksSeveralFiles) {
  spill(folder_ / "bad.xml", "<sdf/>");
  EXPECT_EQ(run("check swing.xml").code, 0);
  const Outcome both = run("check bad.xml swing.xml --json");
  EXPECT_EQ(both.code, 3);
  const Json json = Json::parse(both.out);
  EXPECT_EQ(json["invalid"], 1);
  EXPECT_FALSE(json["files"][0]["valid"]);
  EXPECT_TRUE(json["files"][1]["valid"]);
}

TEST_F(Cprsim, AnswersFourAndKeepsWhatWasComputedWhenTimeIsUp) {
  const Outcome outcome = run("swing.xml --duration 1000 --max-wall 0.3");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(has(outcome.err, "--max-wall"));
  EXPECT_EQ(report()["status"], "wall time exceeded");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/swing/swing.csv"));
}

TEST_F(Cprsim, AnswersFourAndSaysWhereAndWhyWhenAStepHasNoSolution) {
  const Outcome outcome = run("swing.xml --set 'gravity=0 0 -1e12'");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(has(outcome.err, "m::beam")) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "residual")) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "at         t = ")) << outcome.err;
  const Json json = report();
  EXPECT_EQ(json["status"], "failed");
  EXPECT_FALSE(json["failure"]["solve"]["worst_row"].get<std::string>().empty());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/swing/swing.csv"));
}

TEST_F(Cprsim, AnswersFiveWhereItMayNotWrite) {
  std::filesystem::create_directory(folder_ / "mine");
  spill(folder_ / "mine/thesis.tex", "x");
  const Outcome refused = run("swing.xml -o mine");
  EXPECT_EQ(refused.code, 5);
  EXPECT_TRUE(has(refused.err, "mine"));
  EXPECT_EQ(run("swing.xml -o /proc/nowhere").code, 5);
  EXPECT_EQ(run("info swing.xml --json >/dev/full 2>err.txt #").code, 5);
}

TEST_F(Cprsim, LeavesNoHalfFileWhenTheDiskIsFull) {
  spill(folder_ / "swing.xml", with(kScene, "<vtk every=\"10\"/>", ""));
  // a limit of 20 blocks of 512 bytes: room for run.json, not for four seconds of CSV
  const std::string words = "swing.xml --duration 4 >out.txt 2>err.txt";
  const std::string command =
      "cd '" + folder_.path().string() + "' && ulimit -f 20 && " + program() + " " + words;
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 5);
  EXPECT_TRUE(has(contents(folder_ / "err.txt"), "swing.csv.part"))
      << contents(folder_ / "err.txt");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/swing/swing.csv"));
  EXPECT_EQ(report()["status"], "output failed");
}

TEST_F(Cprsim, ReplacesItsOwnOutput) {
  ASSERT_EQ(run("swing.xml").code, 0);
  spill(folder_ / "out/swing/notes.txt", "mine");
  ASSERT_EQ(run("swing.xml --no-record").code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/swing/swing.csv"));
  EXPECT_EQ(contents(folder_ / "out/swing/notes.txt"), "mine");
}

TEST_F(Cprsim, ClosesItsFilesWhenInterrupted) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(folder_.path().c_str()) != 0) _exit(99);
      execl((std::string(CPRSIM_BINARY_DIR) + "/bin/cprsim").c_str(), "cprsim", "swing.xml", "-qq",
            "--duration", "100000", static_cast<char*>(nullptr));
      _exit(99);
    }
    // it is under way once its run.json says so
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!std::filesystem::exists(folder_ / "out/swing/swing.pvd") &&
           std::chrono::steady_clock::now() < patience) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    kill(child, signal);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 128 + signal);
    EXPECT_TRUE(report()["interrupted"]);
    const std::string csv = contents(folder_ / "out/swing/swing.csv");
    EXPECT_EQ(csv.back(), '\n');
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/swing/swing.csv.part"));
    std::filesystem::remove_all(folder_ / "out");
  }
}

TEST_F(Cprsim, AppliesWhatFlagsChange) {
  ASSERT_EQ(
      run("swing.xml --duration 0.05 --step 0.001 --set m::beam/length=0.3 --without gravity").code,
      0);
  const Json json = report();
  EXPECT_EQ(json["time"], 0.05);
  EXPECT_EQ(json["method"]["step"], 0.001);
  EXPECT_FALSE(json["effects"]["gravity"]["on"]);
  EXPECT_EQ(json["options"].size(), 4u);
  EXPECT_EQ(run("swing.xml --set m::baem/length=0.3").code, 3);
}

TEST_F(Cprsim, LeavesExpectationsOpenThatAShortenedRunDoesNotReach) {
  spill(folder_ / "swing.xml", with(kScene, "max=\"1.001\"", "max=\"1.001\" from=\"0.08\""));
  const Outcome outcome = run("swing.xml --duration 0.05");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "1 not reached")) << outcome.out;
}

TEST_F(Cprsim, TellsWhatIsInASceneAndWhichLineAskedForAnEffect) {
  const Outcome info = run("info swing.xml");
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_TRUE(has(info.out, "swing.xml:10"));
  EXPECT_TRUE(has(info.out, "first frequency"));
  EXPECT_TRUE(has(info.out, "growth exponent"));
  const Json json = Json::parse(run("info swing.xml --json").out);
  EXPECT_EQ(json["schema"], "cprsim-info/1");
  // EI of a round steel rod, r = 2 mm: E pi r^4 / 4
  EXPECT_NEAR(json["rods"][0]["bending_x"].get<double>(), 200e9 * 3.14159265358979 * 4e-12, 1e-9);
  EXPECT_NEAR(json["rods"][0]["mass"].get<double>(), 8000 * 3.14159265358979 * 4e-6 * 0.4, 1e-12);
}

TEST_F(Cprsim, ExplainsCodesAndElements) {
  EXPECT_TRUE(has(run("explain").out, "E301"));
  EXPECT_TRUE(has(run("explain E301").out, "element"));
  EXPECT_EQ(run("explain cprsim:rod").code, 0);
  EXPECT_EQ(run("explain E999").code, 2);
}

TEST_F(Cprsim, FilmsAndPhotographsWhereTheMachineCan) {
  const bool can = run("doctor").code == 0;
  const Outcome outcome = run("swing.xml --video film.mp4 --still shot.png@0.05 --still end.png");
  EXPECT_EQ(outcome.code, can ? 0 : 5) << outcome.err;
  if (!can) return;
  EXPECT_EQ(contents(folder_ / "film.mp4").substr(4, 4), "ftyp");
  EXPECT_EQ(contents(folder_ / "shot.png").substr(1, 3), "PNG");
  EXPECT_NE(contents(folder_ / "shot.png"), contents(folder_ / "end.png"));
}

}  // namespace
}  // namespace cprsim
