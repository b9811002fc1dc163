// SPDX-License-Identifier: BSD-3-Clause
// A sweep spread over processes by mpirun: the same files as by one.
#include "tests/tools/program.h"

namespace cprsim {
namespace {

using Json = nlohmann::json;

class Ranks : public ProgramTest {
 protected:
  int run_on_four(const std::string& words) const {
    const std::string command =
        "cd '" + folder_.path().string() +
        "' && mpirun --allow-run-as-root --oversubscribe -n 4 '" CPRSIM_BINARY_DIR "/bin/cprsim' " +
        words + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  /// Without what depends on the machine.
  static Json without_times(Json sweep) {
    for (const char* name : {"seconds", "jobs", "host", "timings", "pareto", "words", "decades"})
      sweep.erase(name);
    for (Json& one : sweep["runs"])
      for (const char* name : {"cpu_seconds", "cpu", "cheapest"})
        one.erase(name);
    return sweep;
  }

  const std::string sweep_ = "sweep " + shipped("scenes/mechanics/released_rod.xml") +
                             " --duration 0.05 --repeat 1 --vary scheme=esdirk32,bdf2 "
                             "--vary step=4e-3,2e-3,1e-3 -q ";
};

TEST_F(Ranks, FourFindWhatOneFinds) {
  ASSERT_EQ(run(sweep_ + "-o alone").code, 0);
  ASSERT_EQ(run_on_four(sweep_ + "-o four"), 0) << contents(folder_ / "err.txt");
  const Json alone = without_times(json("alone/sweep.json")),
             four = without_times(json("four/sweep.json"));
  EXPECT_EQ(alone["runs"].size(), 6U);
  EXPECT_EQ(alone["runs"], four["runs"]);
  EXPECT_FALSE(exists("four/sweep.journal.1"));
  EXPECT_TRUE(exists("four/sweep.html"));
}

TEST_F(Ranks, AJournalOfAProcessThatIsGoneIsTakenUp) {
  ASSERT_EQ(run_on_four(sweep_ + "-o whole"), 0) << contents(folder_ / "err.txt");
  std::filesystem::copy(folder_ / "whole", folder_ / "broken");
  // signature, spread of the references, then a run a line
  std::vector<std::string> lines;
  std::istringstream journal(contents(folder_ / "whole/sweep.journal"));
  for (std::string line; std::getline(journal, line);)
    lines.push_back(line + "\n");
  ASSERT_EQ(lines.size(), 8U);
  spill(folder_ / "broken/sweep.journal", lines[0] + lines[1] + lines[2]);
  spill(folder_ / "broken/sweep.journal.3", lines[0] + lines[1] + lines[5] + lines[7]);
  ASSERT_EQ(run(sweep_ + "--resume -o broken").code, 0);
  const Json whole = json("whole/sweep.json"), again = json("broken/sweep.json");
  int kept = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(whole["runs"][i]["errors"], again["runs"][i]["errors"]);
    kept += whole["runs"][i]["cpu_seconds"] == again["runs"][i]["cpu_seconds"] ? 1 : 0;
  }
  EXPECT_EQ(kept, 3);
  EXPECT_FALSE(exists("broken/sweep.journal.3"));
}

TEST_F(Ranks, AMistakeEndsAllOfThem) {
  EXPECT_NE(run_on_four(sweep_ + "--measure nothing -o wrong"), 0);
  EXPECT_NE(contents(folder_ / "err.txt").find("nothing"), std::string::npos);
}

}  // namespace
}  // namespace cprsim
