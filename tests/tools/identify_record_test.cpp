// SPDX-License-Identifier: BSD-3-Clause
// cprsim identify from the record of one run: stiffness and damping of the released rod.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "engine/run/observe.h"
#include "scenes/loader/load.h"
#include "tests/tools/identify_fixture.h"
#include "tools/cprsim/build_simulation.h"
#include "tools/cprsim/identify_model.h"

namespace cprsim {
namespace {

const std::string kReleased = kScenes + "released_rod.xml";

/// The generator of Park and Miller with the normal deviates of Box and Muller: the same on every
/// machine.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed * 7919 + 12345) {
    for (int i = 0; i < 10; ++i)
      uniform();
  }

  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::acos(-1.0) * uniform());
  }

 private:
  double uniform() {
    state_ = state_ * 48271 % 2147483647;
    return static_cast<double>(state_) / 2147483647;
  }

  std::uint64_t state_;
};

/// The released rod for a seventh of a second, in fixed steps: 5 ms, so that 21 fits take seconds.
class ReleasedRod : public IdentifyTest {
 protected:
  const Words kShort{"--duration", "0.15", "--step", "0.005"};
  static constexpr double kDamping = 0.0001570796326794897, kSigma = 1e-3;

  /// The tip every 5 ms with normal noise on every number.
  std::string record(std::uint64_t seed) const {
    LoadOptions load;
    load.duration = 0.15;
    load.step = 0.005;
    const auto scene = load_scene(kReleased, load).scene;
    const auto simulation = build_simulation(*scene);
    const std::vector<Channel> tip = find_channels(*scene, "wire::rod.tip.position");
    Noise noise(seed);
    std::string table = "time [ms],wire::rod.tip.position.x [mm],wire::rod.tip.position.z [mm]\n";
    simulation->start();
    while (simulation->status() == RunStatus::kRunning) {
      simulation->advance();
      const auto seen = [&](std::size_t i) {
        return 1000 * (evaluate(tip[i], *scene, simulation->now()) + kSigma * noise.normal());
      };
      table += fmt::format("{:.12g},{:.4f},{:.4f}\n", 1000 * simulation->time(), seen(0), seen(2));
    }
    return table;
  }

  Json identify(std::uint64_t seed, const Words& more = {}) {
    spill(folder_ / "record.csv", record(seed));
    Words words{kReleased, path("record.csv"),
                "--fit",   kStiffness + "=190e9:150e9:250e9",
                "--fit",   "wire::rod/damping/bending=3e-4:1e-5:1e-2"};
    words.insert(words.end(), kShort.begin(), kShort.end());
    EXPECT_EQ(run(words, more), 0) << errors_;
    return report();
  }
};

TEST_F(ReleasedRod, GivesBackStiffnessAndDampingAsOftenAsItPromises) {
  constexpr int kSeeds = 20;
  int inside = 0;
  double squares = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Json values = identify(static_cast<std::uint64_t>(seed))["values"];
    const double truth[] = {kE, kDamping};
    for (const std::size_t j : {0U, 1U}) {
      ASSERT_TRUE(values[j]["determined"].get<bool>()) << seed;
      const double low = values[j]["interval"][0], high = values[j]["interval"][1];
      inside += low <= truth[j] && truth[j] <= high ? 1 : 0;
      const double error = values[j]["value"].get<double>() - truth[j];
      squares += std::pow(error / values[j]["standard_error"].get<double>(), 2);
    }
  }
  RecordProperty("intervals_that_hold", inside);
  RecordProperty("squares", std::to_string(squares));
  // 40 intervals of 95 %: 38 expected, fewer than 34 once in 500 times
  EXPECT_GE(inside, 34);
  // chi-square with 40 degrees of freedom: 17.9 and 73.4 bound all but a thousandth on either side
  EXPECT_GT(squares, 17.9);
  EXPECT_LT(squares, 73.4);
}

// Steps that adapt would jump between the two runs of a difference, by about their tolerance.
TEST_F(ReleasedRod, DifferentiatesStepsThatAdaptAsExactlyAsFixedOnes) {
  spill(folder_ / "record.csv", record(1));
  for (const Words& more : {Words{}, Words{"--step", "0.002"}}) {
    Words words{kReleased,    path("record.csv"),
                "--fit",      kStiffness + "=190e9:150e9:250e9",
                "--duration", "0.15",
                "-qq",        "--no-plot"};
    words.insert(words.end(), more.begin(), more.end());
    const auto options = parse_identify_options(words);
    const auto study = prepare_study(std::get<IdentifyOptions>(options), Console({}));
    ASSERT_TRUE(std::holds_alternative<Study>(study));
    SceneFit model(std::get<Study>(study));
    EXPECT_FALSE(model.chooses_steps());
    VecX r;
    ASSERT_TRUE(model.residuals(model.start(), r)) << model.failure();
    MatX fine, middle, coarse;
    ASSERT_TRUE(model.derivative(model.start(), r, model.step(), fine));
    ASSERT_TRUE(model.derivative(model.start(), r, 2e-3, middle));
    ASSERT_TRUE(model.derivative(model.start(), r, 4e-3, coarse));
    EXPECT_NEAR((coarse - fine).norm() / (middle - fine).norm(), 4, 0.2);
    // what is left of a difference of second order where nothing jumps
    EXPECT_LT((middle - fine).norm(), 1e-5 * fine.norm());
  }
}

TEST_F(ReleasedRod, TakesSigmasAsGivenAndDoubtsThemIfTheyAreTooSmall) {
  const Words good{"--sigma", "wire::rod.tip.position.x=1", "--sigma",
                   "wire::rod.tip.position.z=1"};
  const Json json = identify(1, good);
  EXPECT_TRUE(json["sigma_known"].get<bool>());
  EXPECT_NEAR(json["reduced_chi_square"].get<double>(), 1, 0.5);
  EXPECT_EQ(json["measured"][0]["sigma"], 1e-3);
}

TEST_F(ReleasedRod, RefusesRecordsThatDoNotFit) {
  const auto refused = [&](const std::string& table, const Words& more, const char* says) {
    spill(folder_ / "record.csv", table);
    EXPECT_EQ(run({kReleased, path("record.csv"), "--fit", kStiffness}, more), 2) << says;
    EXPECT_TRUE(complains(says)) << errors_;
  };
  const std::string head = "time [s],wire::rod.tip.position.x [m]\n";
  refused(head + "0.2,0\n0.1,0\n", {}, "record.csv:3: time 0.1 s after 0.2 s");
  refused(head + "0.5,0\n1.5,0\n", {}, "after the end of the run");
  refused(head + ",0\n", {}, "without a time");
  refused(head + "0.5,0\n", {"--input", "time=wire::rod/length"}, "--input");
}

}  // namespace
}  // namespace cprsim
