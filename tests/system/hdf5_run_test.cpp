// SPDX-License-Identifier: BSD-3-Clause
// Runs that record HDF5: full disks, kills, going on from a state, comparing.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>

#include "tests/system/program.h"
#include "tools/hdf5/hdf5_input.h"

namespace cprsim {
namespace {

class Hdf5Run : public Program {
 protected:
  void SetUp() override {
    spill(folder_ / "swing.xml", replaced(swing(), "<csv/>", "<csv/><hdf5/>"));
  }

  std::vector<double> numbers(const std::string& folder, const std::string& array) const {
    return Hdf5Input(folder_ / (folder + "/swing.h5")).numbers(array);
  }
};

TEST_F(Hdf5Run, ComparesAndPlotsLikeCsv) {
  ASSERT_EQ(run("swing.xml -o r --duration 0.1 -qq").code, 0);
  const Outcome same = run("compare r/swing.h5 r/swing.csv --of m::bob.position --max 1e-300 -o c");
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_TRUE(has(same.out, "101 instants")) << same.out;
  EXPECT_EQ(run("compare r r/swing.h5 --of m::bob.position --max 1e-300 -o d").code, 0);
  ASSERT_EQ(run("swing.xml -o again --duration 0.1 -qq").code, 0);
  EXPECT_TRUE(contents(folder_ / "again/swing.h5") == contents(folder_ / "r/swing.h5"));
  spill(folder_ / "swing.xml", replaced(swing(), "<csv/>", "<hdf5/>"));
  ASSERT_EQ(run("swing.xml -o only --duration 0.1 -qq").code, 0);
  EXPECT_EQ(run("compare only r/swing.csv --of m::bob.position --max 1e-300 -o e").code, 0);
  EXPECT_EQ(run("plot only/swing.h5 -c m::bob.position -o p").code, 0);
}

TEST_F(Hdf5Run, GoesOnFromAStateAsIfNothingHadHappened) {
  ASSERT_EQ(run("swing.xml -o whole -qq --duration 1.5 --checkpoint-every 1.0005").code, 0);
  ASSERT_EQ(run("swing.xml -o rest -qq --duration 1.5 --from whole/checkpoint.state").code, 0);
  for (const char* array : {"time", "channels/m::bob.orientation.w", "rods/m::beam/position",
                            "rods/m::beam/quaternion", "rods/m::beam/m"}) {
    const auto whole = numbers("whole", array), rest = numbers("rest", array);
    ASSERT_GT(rest.size(), 400u);
    EXPECT_TRUE(std::equal(rest.rbegin(), rest.rend(), whole.rbegin())) << array;
  }
}

// But for the moment in which a block is being written: that is a few per cent of the time here,
// where nearly all that a run does is to record.
TEST_F(Hdf5Run, AKillLeavesAFileThatCanBeRead) {
  int readable = 0;
  for (const int milliseconds : {300, 310, 320, 330, 340}) {
    std::filesystem::remove_all(folder_ / "killed");
    const int status = run_and_signal({"swing.xml", "-qq", "-o", "killed", "--duration", "1000"},
                                      SIGKILL, milliseconds);
    ASSERT_TRUE(WIFSIGNALED(status));
    try {
      const Hdf5Input file(folder_ / "killed/swing.h5.part");
      const auto time = file.numbers("time");
      EXPECT_EQ(time.size() % 128, 0u);
      EXPECT_EQ(file.numbers("rods/m::beam/position").size() % (128 * 3), 0u);
      readable += !time.empty() && time.back() == 0.001 * static_cast<double>(time.size() - 1);
    } catch (const Hdf5Error&) {
    }
  }
  EXPECT_GE(readable, 2);
  ASSERT_EQ(run("swing.xml -qq -o killed").code, 0) << "the folder is still ours";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "killed/swing.h5.part"));
}

#ifdef CPRSIM_FAULTS
TEST_F(Hdf5Run, EveryCallThatTouchesTheDiskMayFail) {
  struct Case {
    const char *call, *error, *name;
    int calls;
  };

  for (const Case& c :
       {Case{"write", "28", "No space left", 12}, Case{"fsync", "5", "", 6},
        Case{"open", "13", "Permission denied", 4}, Case{"rename", "5", "Input/output", 3}}) {
    int failed = 0;
    for (int nth = 1; nth <= c.calls; ++nth) {
      const std::string fault =
          std::string(c.call) + ":" + std::to_string(nth) + ":" + c.error + ":on";
      const Outcome outcome = run("swing.xml --duration 0.2 -qq -o out",
                                  "CPRSIM_FAULT=" + fault + " LD_PRELOAD='" CPRSIM_FAULTS "'");
      EXPECT_TRUE(outcome.code == 5 || outcome.code == 0) << fault << " " << outcome.code;
      failed += outcome.code == 5;
      if (outcome.code == 5) {
        EXPECT_TRUE(has(outcome.err, c.name)) << fault << outcome.err;
        EXPECT_FALSE(has(outcome.err, "HDF5-DIAG")) << outcome.err;
      }
      if (std::filesystem::exists(folder_ / "out/swing.h5")) {
        EXPECT_EQ(numbers("out", "time").size(), 201u) << fault;
      }
      std::filesystem::remove_all(folder_ / "out");
    }
    EXPECT_GT(failed, 1) << c.call;
  }
}
#endif

}  // namespace
}  // namespace cprsim
