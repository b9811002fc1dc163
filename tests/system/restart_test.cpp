// SPDX-License-Identifier: BSD-3-Clause
// A run that was stopped, or asked for checkpoints, goes on from its state as if nothing had
// happened: the bytes of its recordings are those of the whole run.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/system/program.h"

namespace cprsim {
namespace {

class Restart : public Program {
 protected:
  void SetUp() override { spill(folder_ / "swing.xml", swing()); }

  static std::string without_header(const std::string& csv) {
    return csv.substr(csv.find('\n') + 1);
  }

  std::string csv(const std::string& folder) const {
    return contents(folder_ / (folder + "/swing.csv"));
  }
};

TEST_F(Restart, IsTheSameToTheLastBit) {
  for (const char* scheme : {"esdirk32", "generalized_alpha", "bdf_alpha"}) {
    spill(folder_ / "swing.xml", swing(scheme));
    // 2,000 steps with a checkpoint after 1,001 of them
    const Outcome whole = run("swing.xml -o whole -qq --hash --checkpoint-every 1.0005");
    ASSERT_EQ(whole.code, 0) << whole.err;
    const Outcome rest = run("swing.xml -o rest -qq --hash --from whole/checkpoint.state");
    ASSERT_EQ(rest.code, 0) << rest.err;
    EXPECT_EQ(std::count(rest.out.begin(), rest.out.end(), '\n'), 999) << scheme;
    EXPECT_TRUE(whole.out.ends_with(rest.out)) << scheme << ": hashes of every step";
    const std::string tail = without_header(csv("rest"));
    EXPECT_EQ(std::count(tail.begin(), tail.end(), '\n'), 999) << scheme;
    EXPECT_TRUE(csv("whole").ends_with(tail)) << scheme;
  }
}

TEST_F(Restart, GoesOnAfterASignal) {
  ASSERT_EQ(run("swing.xml -o whole -qq").code, 0);
  for (const int signal : {SIGTERM, SIGINT}) {
    std::filesystem::remove_all(folder_ / "stopped");
    const int status =
        run_and_signal({"swing.xml", "-qq", "-o", "stopped", "--duration", "2"}, signal, 60);
    ASSERT_TRUE(WIFEXITED(status));
    if (WEXITSTATUS(status) == 0) continue;  // it was faster
    EXPECT_EQ(WEXITSTATUS(status), 128 + signal);
    if (!std::filesystem::exists(folder_ / "stopped/checkpoint.state")) continue;
    ASSERT_EQ(run("swing.xml -o rest -qq --from stopped/checkpoint.state").code, 0);
    EXPECT_EQ(csv("stopped") + without_header(csv("rest")), csv("whole"));
  }
}

TEST_F(Restart, RefusesWhatIsNoStateOfTheScene) {
  ASSERT_EQ(run("swing.xml -o a -qq --duration 0.1 --checkpoint-every 0.05").code, 0);
  const std::string state = contents(folder_ / "a/checkpoint.state");
  const std::string kept = csv("a");
  spill(folder_ / "cut.state", state.substr(0, state.size() / 2));
  std::string changed = state;
  changed[changed.size() - 9] ^= 1;
  spill(folder_ / "changed.state", changed);
  spill(folder_ / "other.xml", replaced(swing(), "0.05</mass>", "0.06</mass>"));
  for (const char* words :
       {"swing.xml -o b --from cut.state", "swing.xml -o b --from changed.state",
        "swing.xml -o b --from missing.state", "swing.xml -o b --from /dev/zero",
        "swing.xml -o b --from swing.xml", "other.xml -o b --from a/checkpoint.state",
        "swing.xml -o b --from a/checkpoint.state --set world/physics/cprsim:solver/space@points=5",
        "swing.xml -o a --from a/checkpoint.state"}) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 3) << words << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "b")) << words;
  }
  EXPECT_EQ(csv("a"), kept);
}

// How well such runs do is judged over the whole of them: they may begin anew with other steps.
TEST_F(Restart, IsRefusedToRunsThatChooseTheirSettings) {
  spill(folder_ / "swing.xml", swing("esdirk32", ""));
  ASSERT_EQ(run("swing.xml -o a -qq --duration 0.1 --checkpoint-every 0.05").code, 0);
  for (const auto& [words, reason] :
       {std::pair{"--accuracy 1e-3", "an <accuracy> cannot go on from a state"},
        {"--real-time-factor 1", "a --real-time-factor cannot go on from a state"}}) {
    const Outcome outcome =
        run(std::string("swing.xml -o b --from a/checkpoint.state --duration 0.1 ") + words);
    EXPECT_EQ(outcome.code, 3) << words << outcome.err;
    EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "b")) << words;
  }
  const Outcome judged =
      run("swing.xml -o c --duration 0.1 --accuracy 1e-3 --checkpoint-every 0.05 --hash");
  ASSERT_EQ(judged.code, 0) << judged.err;
  EXPECT_NE(judged.err.find("no checkpoints are written"), std::string::npos) << judged.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "c/checkpoint.state"));
  EXPECT_NE(judged.out.find(" 0.1 "), std::string::npos) << "a hash of the last step";
}

// A state is left behind that fails again, at once, at the same place.
TEST_F(Restart, ReproducesAFailure) {
  spill(folder_ / "swing.xml",
        replaced(swing(), "<force>0.2 0.1 0</force><step from=\"1\" to=\"0\" at=\"0.3\"/>",
                 "<force>1e9 0 0</force><step from=\"0\" to=\"1\" at=\"0.3\"/>"));
  const Outcome failed = run("swing.xml -o failed -q");
  ASSERT_EQ(failed.code, 4) << failed.err;
  ASSERT_TRUE(std::filesystem::exists(folder_ / "failed/failure.state"));
  const Outcome again = run("swing.xml -o again -q --from failed/failure.state");
  EXPECT_EQ(again.code, 4);
  for (const Outcome* outcome : {&failed, &again}) {
    EXPECT_TRUE(has(outcome->err, "step failed at t = 0.3 s")) << outcome->err;
    EXPECT_TRUE(has(outcome->err, "balance of m::bob, force x")) << outcome->err;
  }
  EXPECT_EQ(without_header(csv("again")), "") << "no step was taken before";
  const auto report = nlohmann::json::parse(contents(folder_ / "failed/run.json"));
  EXPECT_FALSE(report["failure"]["solve"]["residual_history"].empty());
  EXPECT_FALSE(report["failure"]["likely_causes"].empty());
}

}  // namespace
}  // namespace cprsim
