// SPDX-License-Identifier: BSD-3-Clause
// What the machine may do to a run: closed streams, full disks, failing calls, kills. Files have
// their names only when they are complete, and the answer is an exit code with a message.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/system/program.h"

namespace cprsim {
namespace {

using Json = nlohmann::json;

class Faults : public Program {
 protected:
  void SetUp() override { spill(folder_ / "swing.xml", swing()); }

  Outcome run_with_fault(const std::string& fault, const std::string& words) const {
    return run(words, "CPRSIM_FAULT=" + fault + " LD_PRELOAD='" CPRSIM_FAULTS "'");
  }

  /// Whatever has its final name is whole: JSON that parses, CSV that is the one of a good run.
  void expect_whole(const std::string& folder, const std::string& good_csv) const {
    const std::string report = contents(folder_ / (folder + "/run.json"));
    if (!report.empty()) {
      EXPECT_FALSE(Json::parse(report, nullptr, false).is_discarded()) << report;
    }
    const std::filesystem::path csv = folder_ / (folder + "/swing.csv");
    if (!std::filesystem::exists(csv)) return;
    const std::string text = contents(csv);
    EXPECT_EQ(text.back(), '\n');
    EXPECT_EQ(text, good_csv.substr(0, text.size()));
  }
};

// What is told on a stream that nobody reads is lost, not the run.
TEST_F(Faults, ClosedStreamsStopNoRun) {
  EXPECT_EQ(run("swing.xml -o a --duration 0.01 2>&- #").code, 0);
  EXPECT_EQ(run("swing.xml -o b --duration 0.01 2>/dev/full #").code, 0);
  for (const char* folder : {"a", "b"})
    EXPECT_EQ(Json::parse(contents(folder_ / (std::string(folder) + "/run.json")))["status"],
              "done");
  // what was asked for on standard output and cannot be delivered is an error, with the files whole
  const Outcome closed = run("swing.xml -o c --duration 0.01 >&- 2>err.txt #");
  EXPECT_EQ(closed.code, 5);
  EXPECT_TRUE(has(closed.err, "standard output")) << closed.err;
  EXPECT_EQ(contents(folder_ / "a/swing.csv"), contents(folder_ / "c/swing.csv"));
  EXPECT_EQ(run("swing.xml -o d --duration 0.01 >out.txt 2>&1 | true #").code, 0);
}

TEST_F(Faults, EveryCallThatTouchesTheDiskMayFail) {
  ASSERT_EQ(run("swing.xml -o good --duration 0.2 -qq").code, 0);
  const std::string good = contents(folder_ / "good/swing.csv");

  struct Case {
    const char* call;
    int error;
    const char* name;
    int calls, every;  ///< how many of them a run makes, at least; which of them count
  };

  // of a folder, whose fsync follows that of every file, systems may refuse it
  for (const Case& c :
       {Case{"write", ENOSPC, "No space left", 4, 1}, Case{"write", EIO, "Input/output", 4, 1},
        Case{"open", EACCES, "Permission denied", 4, 1}, Case{"fsync", EIO, "Input/output", 3, 2},
        Case{"rename", EIO, "Input/output", 3, 1}}) {
    for (int nth = 1; nth <= c.calls; nth += c.every) {
      const std::string fault =
          std::string(c.call) + ":" + std::to_string(nth) + ":" + std::to_string(c.error);
      const std::string folder =
          std::string(c.call) + std::to_string(c.error) + std::to_string(nth);
      const Outcome outcome = run_with_fault(fault, "swing.xml --duration 0.2 -qq -o " + folder);
      EXPECT_EQ(outcome.code, 5) << fault << outcome.err;
      EXPECT_TRUE(has(outcome.err, c.name)) << fault << outcome.err;
      expect_whole(folder, good);
    }
  }
  EXPECT_EQ(run_with_fault("write:2:4", "swing.xml -o eintr --duration 0.2 -qq").code, 0)
      << "EINTR";
}

// A result of an earlier run is not touched by one that cannot write.
TEST_F(Faults, EarlierResultsStayWhenNothingCanBeWritten) {
  ASSERT_EQ(run("swing.xml -o out --duration 0.01 -qq").code, 0);
  const std::string csv = contents(folder_ / "out/swing.csv"),
                    report = contents(folder_ / "out/run.json");
  for (const char* fault : {"open:1:30:on", "write:1:28:on", "write:1:5:on", "fsync:1:5:on"}) {
    const Outcome outcome = run_with_fault(fault, "swing.xml -o out --duration 0.02");
    EXPECT_EQ(outcome.code, 5) << fault;
    EXPECT_TRUE(has(outcome.err, "cprsim: error[E701]: cannot ")) << outcome.err;
    EXPECT_EQ(contents(folder_ / "out/swing.csv"), csv) << fault;
    EXPECT_EQ(contents(folder_ / "out/run.json"), report) << fault;
  }
}

// S4: the Nth allocation fails. Either somebody below can do without, or the run ends with code 5.
TEST_F(Faults, EveryAllocationMayFail) {
  int refused = 0;
  for (int nth = 1; nth < 40'000; nth = nth + 1 + nth / 3) {
    const std::string fault = "malloc:" + std::to_string(nth) + ":12";
    const Outcome outcome = run_with_fault(fault, "swing.xml --duration 0.05 -o out");
    const bool while_reading = outcome.code == 3 && has(outcome.err, "error[E105]");
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 5 || while_reading)
        << fault << " " << outcome.code << outcome.err;
    refused += outcome.code == 5;
    std::filesystem::remove_all(folder_ / "out");
  }
  EXPECT_GT(refused, 5);
}

TEST_F(Faults, AKillLeavesNoHalfFileUnderAFinalName) {
  ASSERT_EQ(run("swing.xml -o good -qq").code, 0);
  const std::string good = contents(folder_ / "good/swing.csv");
  int killed = 0;
  for (int k = 0; k < 100; ++k) {  // each at another millisecond
    const int status =
        run_and_signal({"swing.xml", "-qq", "-o", "killed"}, SIGKILL, 1 + (37 * k) % 101);
    expect_whole("killed", good);
    EXPECT_FALSE(WIFEXITED(status) && WEXITSTATUS(status) != 0) << "the folder is still ours";
    if (!WIFSIGNALED(status)) continue;
    ++killed;
    const std::string part = contents(folder_ / "killed/swing.csv.part");
    EXPECT_EQ(part, good.substr(0, part.size()));
  }
  EXPECT_GT(killed, 0);
}

}  // namespace
}  // namespace cprsim
