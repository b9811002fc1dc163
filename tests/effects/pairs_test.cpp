// SPDX-License-Identifier: BSD-3-Clause
// Every two effects that may be listed together, by every method, at rest and in motion: together
// they are what they are one by one, up to the product of both. With x(a, b) what a rod does under
// the shares a, b of two effects,
//   D(a, b) = x(a, b) - x(a, 0) - x(0, b) + x(0, 0) = O(a b)                                  (1)
// so that half of both leaves a quarter of D. An effect that is lost, counted twice or changed
// where another one is leaves half. What O(a b) is, no method knows from another: (2) they agree;
// and (3) a plane changes nothing.
#include <gtest/gtest.h>

#include <map>

#include "tests/effects/paired_effects.h"
#include "tests/support/methods.h"

namespace cprsim {
namespace {

using Answer = Eigen::Matrix<double, 6, 1>;

/// Where the tip is, over the length; the moment at the base, over EI / L.
Answer answer_of(const RodSample& rod) {
  Answer x;
  x << rod.points.back().position / 0.4, rod.points.front().moment / (0.1 / 0.4);
  return x;
}

/// Cut coarsely: (1) and (3) hold however a rod is cut.
Scene coarsely(Scene scene, Method method) {
  scene.solver.method = method;
  scene.solver.points = 12;
  scene.solver.order = 8;
  scene.solver.degree = 8;
  scene.solver.elements = method == Method::kCollocation ? 8 : 2;
  scene.solver.scheme = SchemeKind::kBackwardEuler;
  scene.solver.step = 0.01;
  return scene;
}

Answer solve(const Scene& scene) {
  if (scene.simulation.mode == Mode::kStatic) {
    const Equilibrium equilibrium(scene, 1e-12);
    EXPECT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
    return answer_of(equilibrium.rod());
  }
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return answer_of(end.rods[0]);
}

/// Of (1): so small that terms of higher order stay away, and what cutting errs by, too.
constexpr double kShare = 0.1, kNothing = 1e-7;

/// An effect of the list and its share; -1: none.
struct Share {
  int effect = -1;
  double share = 0;

  auto operator<=>(const Share&) const = default;
};

class PairsOfEffects : public ::testing::TestWithParam<bool> {
 protected:
  Answer answer(Method method, Share a, Share b = {}, bool plane = false) {
    const auto key = std::make_tuple(method, a, b, plane);
    const auto known = answers_.find(key);
    if (known != answers_.end()) return known->second;
    Scene scene = rod_for_pairs(moving());
    for (const Share& each : {a, b})
      if (each.effect >= 0) effects_[static_cast<std::size_t>(each.effect)].add(scene, each.share);
    if (plane) scene.planar_normal = Vec3::UnitY();
    return answers_[key] = solve(coarsely(scene, method));
  }

  bool moving() const { return GetParam(); }

  /// Calls with the indices of all pairs and their names.
  template <typename Check>
  void for_pairs(Check check) {
    const int n = static_cast<int>(effects_.size());
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < n; ++j) {
        const PairedEffect &a = effects_[static_cast<std::size_t>(i)],
                           &b = effects_[static_cast<std::size_t>(j)];
        if (!may_be_combined(a, b) || (!moving() && (a.moving || b.moving))) continue;
        SCOPED_TRACE(std::string(a.name) + " and " + b.name);
        check(i, a, j, b);
      }
  }

  std::vector<PairedEffect> effects_ = paired_effects();

 private:
  std::map<std::tuple<Method, Share, Share, bool>, Answer> answers_;
};

INSTANTIATE_TEST_SUITE_P(Grid, PairsOfEffects, ::testing::Bool(), [](const auto& of) {
  return std::string(of.param ? "Moving" : "AtRest");
});

// Else there would be nothing to disturb. Disks have no weight without gravity.
TEST_P(PairsOfEffects, ConsistOfEffects) {
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    const bool nothing =
        !moving() && (effects_[i].moving || effects_[i].name == std::string("disks"));
    const double change =
        (answer(Method::kShooting, {static_cast<int>(i), 1}) - answer(Method::kShooting, {}))
            .norm();
    if (nothing) {
      EXPECT_LT(change, 1e-9) << effects_[i].name;
    } else {
      EXPECT_GT(change, 1e-3) << effects_[i].name;
      EXPECT_LT(change, 0.2) << effects_[i].name;
    }
  }
}

TEST_P(PairsOfEffects, AddUpToTheProductOfBoth) {
  int pairs = 0;
  double least = HUGE_VAL;
  for (const Method method : kEveryMethod) {
    const Answer x = answer(method, {});
    for_pairs([&](int i, const PairedEffect& a, int j, const PairedEffect& b) {
      if (a.constrains || b.constrains) return;
      SCOPED_TRACE(method_name(method));
      const auto product = [&](double share) {
        const double of_a = a.whole ? 1 : share, of_b = b.whole ? 1 : share;
        return Answer(answer(method, {i, of_a}, {j, of_b}) - answer(method, {i, of_a}) -
                      answer(method, {j, of_b}) + x)
            .norm();
      };
      ++pairs;
      const double D = product(kShare);
      if (a.whole || b.whole) {
        const double scaled = (answer(method, {a.whole ? j : i, kShare}) - x).norm();
        EXPECT_LT(D, 0.25 * scaled);
        return;
      }
      if (D < kNothing) return;
      const double quotient = D / product(0.5 * kShare);
      least = std::min(least, quotient);
      EXPECT_GT(quotient, 3.5) << D;
    });
  }
  EXPECT_GT(pairs, 3 * (moving() ? 140 : 110));
  std::printf("%d pairs, half of both leaves at most 1/%.2f of what they do to each other\n", pairs,
              least);
}

TEST_P(PairsOfEffects, AreTheSameByEveryMethod) {
  double worst = 0;
  for_pairs([&](int i, const PairedEffect& a, int j, const PairedEffect& b) {
    // where a tendon sticks and slips in a swing, each method smooths the border in its own way
    const bool sticks = moving() && (a.name == std::string("tendon that rubs") ||
                                     b.name == std::string("tendon that rubs"));
    const Answer x = answer(Method::kShooting, {i, 1}, {j, 1});
    for (const Method method : {Method::kStrain, Method::kCollocation}) {
      const double apart = (answer(method, {i, 1}, {j, 1}) - x).norm();
      worst = std::max(worst, apart);
      EXPECT_LT(apart, sticks ? 2e-4 : 1e-8) << method_name(method);
    }
  });
  std::printf("methods differ by at most %.1e\n", worst);
}

TEST_P(PairsOfEffects, AreTheSameInAPlane) {
  double worst = 0;
  for (const Method method : kEveryMethod)
    for_pairs([&](int i, const PairedEffect& a, int j, const PairedEffect& b) {
      if (!a.in_plane || !b.in_plane) return;
      SCOPED_TRACE(method_name(method));
      const double apart =
          (answer(method, {i, 1}, {j, 1}, true) - answer(method, {i, 1}, {j, 1})).norm();
      worst = std::max(worst, apart);
      EXPECT_LT(apart, 1e-11);
    });
  std::printf("planes differ by at most %.1e\n", worst);
}

// What pulls a length in is a tension: given instead, it does the same, with each other effect.
TEST_P(PairsOfEffects, FindTheTensionThatWouldHaveToBeGiven) {
  if (moving()) GTEST_SKIP() << "a tension that changes is not given by one number";
  int held = 0;
  while (!effects_[static_cast<std::size_t>(held)].constrains)
    ++held;
  for (const Method method : kEveryMethod)
    for_pairs([&](int i, const PairedEffect& a, int j, const PairedEffect& b) {
      if (i != held && j != held) return;
      Scene scene = rod_for_pairs(false);
      a.add(scene, 1);
      b.add(scene, 1);
      scene = coarsely(scene, method);
      const Equilibrium found(scene, 1e-12);
      ASSERT_TRUE(found.report.converged()) << found.report.worst_row;
      for (DriveSpec& drive : scene.drives) {
        if (drive.quantity != DriveQuantity::kDisplacement) continue;
        drive.quantity = DriveQuantity::kTension;
        drive.profile.terms[0].value =
            found.robot.rods[0].model->tendons()[static_cast<std::size_t>(drive.tendon)].tension;
        EXPECT_GT(drive.profile.terms[0].value, 0.1);
      }
      EXPECT_LT((solve(scene) - answer_of(found.rod())).norm(), 1e-8) << method_name(method);
    });
}

// Slowly: a run without inertia ends where the equilibrium under the same loads is, with whichever
// two effects. Dry friction remembers how it came there: of a base that is left out, of a tendon it
// is little, for it is pulled in nearly all the time.
TEST_P(PairsOfEffects, EndInQuasiStaticsWhereStaticsIs) {
  if (moving()) GTEST_SKIP() << "once is enough";
  double worst = 0;
  int pairs = 0;
  for (const Method method : kEveryMethod)
    for_pairs([&](int i, const PairedEffect& a, int j, const PairedEffect& b) {
      const auto either = [&](const std::string& name) { return a.name == name || b.name == name; };
      if (either("sprung base that rubs")) return;
      SCOPED_TRACE(method_name(method));
      Scene scene = rod_for_pairs(true);
      scene.simulation.mode = Mode::kQuasistatic;
      for (const PairedEffect* each : {&a, &b})
        each->add(scene, 1);
      scene = coarsely(scene, method);
      scene.solver.step = 0.03;
      Simulation simulation(scene);
      const Snapshot end = run_to_end(simulation);
      ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
      const double apart = (answer_of(end.rods[0]) - answer(method, {i, 1}, {j, 1})).norm();
      worst = std::max(worst, apart);
      ++pairs;
      EXPECT_LT(apart, either("tendon that rubs") ? 2e-4 : 1e-8);
    });
  EXPECT_GT(pairs, 3 * 90);
  std::printf("%d pairs, quasi-statics ends within %.1e of statics\n", pairs, worst);
}

// Listed where a rod does not reach itself it changes nothing, whatever else there is, but what
// collocation errs by: it cuts rods that may touch in other places.
TEST_P(PairsOfEffects, AreNotDisturbedBySelfContactWithoutATouch) {
  for (int i = 0; i < static_cast<int>(effects_.size()); ++i) {
    const PairedEffect& effect = effects_[static_cast<std::size_t>(i)];
    if (effect.moving && !moving()) continue;
    for (const Method method : kEveryMethod) {
      const bool recut = method == Method::kCollocation;
      Scene scene = rod_for_pairs(moving());
      effect.add(scene, 1);
      scene = coarsely(scene, method);
      // in longer steps a rod moves farther than the search for contacts looks, which halves them
      if (recut) scene.solver.step = 0.005;
      const Answer alone = solve(scene);
      switch_on(scene, {Effect::kSelfContact});
      EXPECT_LT((solve(scene) - alone).norm(), recut ? 1e-7 : 1e-9)
          << effect.name << " by " << method_name(method);
    }
  }
}

// Else nothing would be known of it: what rubs holds the base back.
TEST_P(PairsOfEffects, FeelDryFrictionOfTheBase) {
  if (!moving()) GTEST_SKIP() << "equilibria at the start know none";
  int sprung = -1, rubs = -1;
  for (int i = 0; i < static_cast<int>(effects_.size()); ++i) {
    const std::string name = effects_[static_cast<std::size_t>(i)].name;
    if (name == "sprung base") sprung = i;
    if (name == "sprung base that rubs") rubs = i;
  }
  for (const Method method : kEveryMethod)
    EXPECT_GT((answer(method, {sprung, 1}) - answer(method, {rubs, 1})).norm(), 1e-3);
}

/// Of the wall beside the rod, which its tip is pressed against.
constexpr double kWall = 0.07;

// A rod that touches something has each effect, too: the wall lets nothing through, the law of
// friction holds, methods agree, and the effect is felt as a change of what presses on the wall.
TEST_P(PairsOfEffects, KeepTheLawsOfContact) {
  for (const double friction : {0., 0.2}) {
    if (friction > 0 && !moving()) continue;  // its sign is open at rest
    double alone = 0;
    for (int i = -1; i < static_cast<int>(effects_.size()); ++i) {
      const auto at = static_cast<std::size_t>(std::max(i, 0));
      if (i >= 0 && !moving() && (effects_[at].moving || effects_[at].name == std::string("disks")))
        continue;
      SCOPED_TRACE(i < 0 ? "alone" : effects_[at].name);
      double forces[3];
      for (const Method method : kEveryMethod) {
        SCOPED_TRACE(method_name(method));
        Scene scene = rod_for_pairs(moving());
        add_wall(scene, kWall, friction);
        if (i >= 0) effects_[at].add(scene, 1);
        Simulation simulation(coarsely(scene, method));
        const Snapshot end = run_to_end(simulation);
        ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
        const ContactSample& contact = end.contact;
        EXPECT_GE(contact.count, 1);
        EXPECT_LT(contact.penetration, 1e-6);
        EXPECT_LE(contact.friction, friction * contact.force + 1e-12);
        forces[static_cast<int>(method) - 1] = contact.force;
      }
      if (i < 0) alone = forces[0];
      EXPECT_GT(forces[0], 0.02);
      // where a tip sticks and slips, two methods may do so in unlike steps of the solver
      const bool rubs = i >= 0 && moving() && effects_[at].name == std::string("tendon that rubs");
      // one method's search for contacts halves a step, another's does not
      const double unlike = rubs ? 5e-3 : friction > 0 ? 2e-6 : 1e-7;
      EXPECT_NEAR(forces[1], forces[0], unlike);
      EXPECT_NEAR(forces[2], forces[0], unlike);
      if (i < 0) continue;
      EXPECT_GT(std::abs(forces[0] - alone), 1e-5);
    }
  }
}

}  // namespace
}  // namespace cprsim
