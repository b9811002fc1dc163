// SPDX-License-Identifier: BSD-3-Clause
// The slider-crank for a very long time, by the program as it is shipped: nothing may grow. 10,000
// steps here; CPRSIM_SOAK_STEPS=1000000 soak_test takes a million and prints the figures of
// docs/soak.md.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/system/program.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4;        // m, of the beam
constexpr double kClosed = 1e-10;      // of it: how far the tip may be off the slider's axis
constexpr double kMostGrowth = 256e3;  // B; a leak of a byte in a step would be a MB in a million

/// What the system says of a process while it runs.
struct Use {
  double memory = 0;  ///< B of its own: pages of its program come and go
  long files = 0;
};

Use use_of(pid_t process) {
  const std::string folder = "/proc/" + std::to_string(process);
  Use use;
  std::ifstream status(folder + "/status");
  for (std::string word; status >> word;)
    if (word == "RssAnon:" && status >> use.memory) use.memory *= 1024;
  std::error_code ended;
  for (std::filesystem::directory_iterator at(folder + "/fd", ended), none; !ended && at != none;
       at.increment(ended))
    ++use.files;
  return use;
}

/// Whether a process still has its own program and files: at its beginning and end it has neither.
bool is_whole(const Use& use) {
  return use.memory > 0 && use.files > 0;
}

class Soak : public Program, public testing::WithParamInterface<const char*> {
 protected:
  static long steps() {
    const char* asked = std::getenv("CPRSIM_SOAK_STEPS");
    return asked ? std::stol(asked) : 10000;
  }

  /// The shipped robot, driven to and fro for ever, in space or in its plane.
  static std::string scene(bool planar) {
    std::string text = contents(std::string(CPRSIM_SOURCE_DIR) + "/scenes/robots/slider_crank.xml");
    text =
        replaced(text, "<accuracy>1e-9</accuracy>", "<time scheme=\"esdirk32\" step=\"0.001\"/>");
    text = replaced(text, "mode=\"quasistatic\"><duration>2</duration>",
                    "mode=\"dynamic\"><duration>" +
                        std::to_string(1e-3 * static_cast<double>(steps())) + "</duration>");
    text =
        replaced(text, "<smoothstep from=\"0\" to=\"1.5707963267948966\" start=\"0\" end=\"2\"/>",
                 "<sine amplitude=\"1.2\" frequency=\"1\"/>");
    if (!planar) text = replaced(text, "<planar normal=\"0 0 1\"/>", "");
    text = without(text, "cprsim:video");
    const std::string closed = "min=\"-4e-11\" max=\"4e-11\"/>", all = "min=\"-1e9\" max=\"1e9\"/>";
    return replaced(without(text, "cprsim:expect"), "<cprsim:record rate=\"50\"",
                    "<cprsim:expect name=\"soak\">"
                    "<bound of=\"robot::beam.tip.position.y\" " +
                        closed + "<bound of=\"robot::beam.tip.position.z\" " + closed +
                        "<bound of=\"robot::slider.position.y\" " + closed +
                        "<bound of=\"energy.total\" " + all +
                        "</cprsim:expect>"
                        "<cprsim:record rate=\"5\"");
  }

  static std::string without(const std::string& text, const std::string& element) {
    const std::string end = "</" + element + ">";
    const std::size_t from = text.find("<" + element), to = text.find(end);
    EXPECT_NE(to, std::string::npos) << element;
    return text.substr(0, from) + text.substr(to + end.size());
  }

  /// Runs the program to its end and looks at it all the while.
  std::vector<Use> watch(int* code) const {
    const pid_t child = fork();
    if (child == 0) {
      const std::string name = std::string(CPRSIM_BINARY_DIR) + "/bin/cprsim";
      if (chdir(folder_.path().c_str()) != 0) _exit(99);
      execl(name.c_str(), name.c_str(), "soak.xml", "-o", "out", "-qq", nullptr);
      _exit(99);
    }
    const auto pause = std::chrono::milliseconds(steps() > 100000 ? 100 : 2);
    std::vector<Use> uses;
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
      if (const Use use = use_of(child); is_whole(use)) uses.push_back(use);
      std::this_thread::sleep_for(pause);
    }
    *code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return uses;
  }
};

TEST_P(Soak, NothingGrows) {
  const bool planar = GetParam() == std::string("planar");
  spill(folder_ / "soak.xml", scene(planar));
  int code = -1;
  const std::vector<Use> uses = watch(&code);
  const auto report = nlohmann::json::parse(contents(folder_ / "out/run.json"));
  EXPECT_EQ(code, 0) << report["status"] << report["expectations"];
  EXPECT_EQ(report["statistics"]["steps"], steps());
  EXPECT_EQ(report["method"]["kernel"], planar ? "planar" : "spatial");
  double off = 0, most_energy = 0;
  for (const auto& check : report["expectations"][0]["checks"]) {
    const double value = std::abs(check["value"].get<double>());
    (check["channel"] == "energy.total" ? most_energy : off) =
        std::max(check["channel"] == "energy.total" ? most_energy : off, value);
  }
  EXPECT_LE(off, kClosed * kLength);

  // what is there after a third of the run is there at its end
  ASSERT_GT(uses.size(), 20U);
  const auto part = [&](std::size_t from, std::size_t to, auto value) {
    double most = 0;
    for (std::size_t i = from; i < to; ++i)
      most = std::max(most, static_cast<double>(value(uses[i])));
    return most;
  };
  const auto memory = [](const Use& use) { return use.memory; };
  const auto files = [](const Use& use) { return use.files; };
  const std::size_t third = uses.size() / 3, end = uses.size();
  const double growth = part(third, end, memory) - part(0, third, memory);
  EXPECT_LE(growth, kMostGrowth);
  EXPECT_LE(part(third, end, files), part(0, third, files));

  // nothing dissipates but the scheme, and the drive keeps feeding
  const double balance = report["energy"]["worst_relative_balance"];
  EXPECT_LE(balance, 0.01);
  if (steps() != 10000 && !HasFailure())
    std::printf("| %s | %ld | %.1f MB | %.0f kB | %.0f | %.2g | %.4g | %.2g |\n", GetParam(),
                steps(), part(0, end, memory) * 1e-6, growth * 1e-3, part(0, end, files),
                off / kLength, most_energy, balance);
}

// After a million steps their sum is off by 1e-5 of a step: that is no step of its own.
TEST_P(Soak, EndsWithAWholeStep) {
  spill(folder_ / "soak.xml", scene(GetParam() == std::string("planar")));
  for (const char* duration : {"0.00999999", "0.01", "0.01000001"}) {
    const Outcome outcome = run(std::string("soak.xml -o short -qq --duration ") + duration);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto report = nlohmann::json::parse(contents(folder_ / "short/run.json"));
    EXPECT_EQ(report["statistics"]["steps"], 10) << duration;
    EXPECT_EQ(report["time"], std::stod(duration));
  }
}

INSTANTIATE_TEST_SUITE_P(SliderCrank, Soak, testing::Values("planar", "spatial"),
                         [](const auto& of) { return std::string(of.param); });

}  // namespace
}  // namespace cprsim
