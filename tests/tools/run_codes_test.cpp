// SPDX-License-Identifier: BSD-3-Clause
// Every code that a run may end with or warn of, by a run that does.
#include <algorithm>
#include <map>
#include <sstream>

#include "tests/tools/program.h"

namespace cprsim {
namespace {

class RunCodes : public ProgramTest {
 protected:
  /// A cantilever that stands; `world` is added to its world.
  void write(const std::string& file, const std::string& mode, const std::string& time,
             const std::string& world = "") const {
    spill(folder_ / file, R"(<?xml version="1.0"?>
<sdf version="1.11" xmlns:cprsim="urn:cprsim:1"><world name="stick"><gravity>0 0 -9.81</gravity>
<physics name="default" type="bullet"><max_step_size>0.005</max_step_size>
<cprsim:solver method="shooting"><space points="6"/>)" +
                              time + R"(</cprsim:solver></physics>
<cprsim:simulation mode=")" + mode +
                              R"("><duration>0.05</duration></cprsim:simulation>
<cprsim:effects><gravity/></cprsim:effects>
<model name="m"><link name="base"><pose>0 0 0 0 1.2 0</pose></link>
<joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
<cprsim:rod name="beam"><base attached_to="base" joint="fixed"/><length>0.4</length>
<cross_section><circle><radius>0.002</radius></circle></cross_section>
<material><density>8000</density><youngs_modulus>200e9</youngs_modulus><shear_modulus>80e9</shear_modulus></material>
</cprsim:rod></model>)" + world +
                              "</world></sdf>");
  }

  /// As a shell would see it; `prefix` before the program.
  Answer shell(const std::string& prefix, const std::string& words) const {
    const std::string command = "cd '" + folder_.path().string() + "' && " + prefix + " '" +
                                CPRSIM_BINARY_DIR "/bin/cprsim' " + words + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder_ / "out.txt"),
            contents(folder_ / "err.txt")};
  }
};

TEST_F(RunCodes, AreAllSeenAndExplained) {
  write(
      "stick.xml", "dynamic", R"(<time scheme="backward_euler" step="0.005"/>)",
      R"(<cprsim:expect name="rises"><bound of="m::beam.tip.position.z" min="10"/></cprsim:expect>)");
  const std::string record =
      R"(<cprsim:record rate="10" prefix="x"><channel>energy.*</channel><csv/></cprsim:record>)";
  write("named.xml", "dynamic", "", record + record);
  write("still.xml", "static", "");
  write(
      "filmed.xml", "dynamic", "",
      R"(<cprsim:camera name="c"><eye>1 -1 1</eye><look_at>0 0 0</look_at></cprsim:camera><cprsim:video camera="c" fps="30" file="film.mp4"/>)");
  std::filesystem::create_directory(folder_ / "mine");
  spill(folder_ / "mine/thesis.tex", "x");
  const std::string column = shipped("scenes/paths/euler_column.xml"),
                    floor = shipped("scenes/contact/rod_on_floor.xml");
  // two cells and a fall that no sheet stops
  spill(folder_ / "sheet.xml",
        with(contents(shipped("scenes/contact/thin_sheet.xml")), "points=\"24\"", "points=\"2\""));
  const std::map<std::string, std::pair<std::string, int>> runs{
      {"E601", {"run still.xml --set 'gravity=0 0 -1e14'", 4}},
      {"E602", {"run " + floor + " --set 'bench/frame[start]/pose#3=0.0001' --no-video", 4}},
      {"E603", {"run stick.xml --set 'gravity=0 0 -1e12'", 4}},
      {"E604", {"run sheet.xml --set 'gravity=0 0 -2e6' --no-video", 4}},
      {"E605", {"run stick.xml --duration 10000 --max-wall 0.2", 4}},
      {"E607", {"run stick.xml", 1}},
      {"E701", {"run stick.xml -o /proc/nowhere", 5}},
      {"E702", {"run stick.xml -o mine", 5}},
      {"E703", {"run named.xml", 5}},
      {"W601", {"run stick.xml --set scheme=bdf2 --set step=0.005 --set accuracy=1e-9", 1}},
      {"W602", {"run stick.xml --set step=0.02 --duration 1", 1}},
      {"W603", {"run " + column + " --set 'column/load/force#3=-4.12'", 0}},
      {"W604", {"run stick.xml --real-time-factor 1e9", 1}},
      {"W605", {"run stick.xml --duration 600 --trace trace.json", 1}},
  };
  std::vector<std::string> seen;
  for (const auto& [code, expected] : runs) {
    const Answer answer = run(expected.first);
    EXPECT_TRUE(answer.complains("[" + code + "]: ")) << code << "\n" << answer.out << answer.err;
    EXPECT_EQ(answer.code, expected.second) << code;
    seen.push_back(code);
  }
  // without an encoder
  EXPECT_TRUE(shell("PATH=/nowhere", "run stick.xml --video x.mp4").complains("error[E704]: "));
  const Answer unfilmed = shell("PATH=/nowhere", "run filmed.xml");
  EXPECT_TRUE(unfilmed.complains("warning[W701]: ")) << unfilmed.err;
  // in the foreground: the shell, in whose group it is, must live to wait for it
  EXPECT_TRUE(shell("timeout --foreground -s INT 0.5", "run stick.xml --duration 10000")
                  .complains("error[E606]: "));
  for (const char* code : {"E704", "W701", "E606"})
    seen.emplace_back(code);

  std::istringstream all(run("explain").out);
  for (std::string line; std::getline(all, line);)
    if (line[1] == '6' || line[1] == '7') {
      EXPECT_NE(std::find(seen.begin(), seen.end(), line.substr(0, 4)), seen.end()) << line;
    }
}

TEST_F(RunCodes, StandInTheReport) {
  write("stick.xml", "dynamic", R"(<time scheme="bdf2" step="0.005"/>)");
  ASSERT_EQ(run("run stick.xml --set 'gravity=0 0 -1e12' -o r").code, 4);
  EXPECT_EQ(json("r/run.json")["failure"]["code"], "E603");
}

// Massless spin: a heap of loose rods stops, and the message says what it wants.
TEST_F(RunCodes, AFailedHeapNamesTheInertiaThatIsMissing) {
  const Answer heap =
      run("run " + shipped("scenes/contact/pile.xml") + " --without rotary_inertia --no-video");
  EXPECT_EQ(heap.code, 4);
  EXPECT_TRUE(heap.complains("list <rotary_inertia/>")) << heap.err;
}

}  // namespace
}  // namespace cprsim
