// SPDX-License-Identifier: BSD-3-Clause
// A heavy rope without bending stiffness that slides over a drum, against its differential
// equations. Its axis lies at R + r from the drum's; phi counts from the light side's lift-off, at
// the level of the drum's axis; friction acts at R, and the moment r mu N that it has about the
// rope's axis is a shear force in the rope:
//   dT/dphi = mu R N + w (R + r) cos(phi)                                                   (1)
//   dN/dphi = ((T + w (R + r) sin(phi)) - (R + r) N) / (mu r),   N per length                (2)
// For r = 0 this is h2 = e^(mu pi) h1 + R 2 mu / (1 + mu^2) (e^(mu pi) + 1) in heights T / w.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/run/simulation.h"
#include "scenes/loader/load.h"

namespace cprsim {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Capstan {
  double R = 0, r = 0, w = 0, mu = 0;

  /// Tension where the rope leaves the drum after `angle`, light at a height h1.
  double tension(double h1, double angle) const {
    constexpr int kSteps = 20000;
    const double axis = R + r, d = angle / kSteps;
    double T = w * h1, N = T / axis;
    for (int i = 0; i < kSteps; ++i) {
      const double phi = (i + 1) * d;
      T += d * (mu * R * N + w * axis * std::cos(phi - 0.5 * d));
      // (2) is stiff: implicitly
      const double pull = d * axis / (mu * std::max(r, 1e-12));
      N = (N + pull * (T / axis + w * std::sin(phi))) / (1 + pull);
    }
    return T;
  }
};

TEST(Capstan, ItsEquationsHaveTheKnownLimit) {
  const double mu = 0.3, R = 0.05, h1 = 0.15, e = std::exp(mu * kPi);
  const double h2 = e * h1 + R * 2 * mu / (1 + mu * mu) * (e + 1);
  EXPECT_NEAR((Capstan{R, 0, 1, mu}.tension(h1, kPi)) / h2, 1, 1e-4);
}

TEST(Capstan, AHeavyRopeSlidesWithItsForce) {
  const LoadResult loaded =
      load_scene(std::string(CPRSIM_SOURCE_DIR) + "/scenes/contact/capstan.xml");
  ASSERT_TRUE(loaded.scene);
  Simulation simulation(*loaded.scene);
  simulation.start();
  const double R = 0.025, r = 0.005, w = 1000 * 9.81 * kPi * r * r;
  const Capstan capstan{R, r, w, 0.1};
  int compared = 0;
  double worst = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    const double angle = std::min(0.5 * simulation.time(), 1.0) * kPi;
    if (angle < 0.2) continue;
    const RodPoint &base = simulation.now().rods[0].points.front(),
                   &tip = simulation.now().rods[0].points.back();
    const double on_drum = capstan.tension(-tip.position.z(), angle);
    const double pull = on_drum + w * (base.position.z() - (R + r) * std::sin(angle));
    worst = std::max(worst, std::abs(base.force.norm() - pull) / on_drum);
    ++compared;
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_GT(compared, 100);
  EXPECT_LT(worst, 5e-3);
}

/// capstan_at_rest.xml with another coefficient of friction and with `part` of what would pull the
/// rope off, `lifted` of it until t = 0.
Scene hanging_rope(double mu, double part, double lifted) {
  const LoadResult loaded =
      load_scene(std::string(CPRSIM_SOURCE_DIR) + "/scenes/contact/capstan_at_rest.xml");
  Scene scene = *loaded.scene;
  constexpr double R = 0.05, r = 1e-3, above = 5e-4, axis = R + r + above, h1 = 0.15;
  const double h2 = part * Capstan{R, r, 1, mu}.tension(h1, kPi), fall = 0.5 * kPi * above;
  for (BodySpec& body : scene.bodies)
    for (ColliderSpec& collider : body.colliders)
      collider.surface.friction = mu;
  RodSpec& rope = scene.rods[0];
  const double light = h1 - fall, wound = kPi * axis;
  rope.length = light + wound + h2 - fall;
  scene.solver.points = static_cast<int>(std::lround(rope.length / 6e-4));
  rope.start.clear();
  const int samples = scene.solver.points.value() / 4;
  for (int i = 0; i <= samples; ++i) {
    const double s = rope.length * i / samples, phi = std::clamp((s - light) / axis, 0.0, kPi);
    const double hangs = std::max(light - s, s - light - wound);
    rope.start.push_back({static_cast<double>(i) / samples,
                          {-axis * std::cos(phi), 0, hangs > 0 ? -hangs : axis * std::sin(phi)}});
  }
  LoadSpec hand;
  hand.rod = 0;
  hand.rod_s = 1;
  hand.force = Vec3(0, 0, lifted * h2 * 1000 * 9.81 * kPi * r * r);
  hand.has_profile = true;
  ProfileTerm step;
  step.shape = ShapeOfTime::kStep;
  step.from = 1;
  hand.profile.terms.push_back(step);
  if (lifted > 0) scene.loads.push_back(hand);
  return scene;
}

double light_end(const Simulation& simulation) {
  return simulation.now().rods[0].points.front().position.z();
}

class HangingRope : public ::testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(Friction, HangingRope, ::testing::Values(0.1, 0.3, 0.6));

// Inside the limit it does not move by a micrometre in two seconds.
TEST_P(HangingRope, StaysWithinTheLimit) {
  Simulation simulation(hanging_rope(GetParam(), 0.98, 0));
  simulation.start();
  ASSERT_EQ(simulation.status(), RunStatus::kRunning) << simulation.failure();
  const double from = light_end(simulation);
  double most = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    most = std::max(most, std::abs(light_end(simulation) - from));
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_EQ(simulation.time(), 2);
  // what hangs is what was asked for, but for the way that the rope sank to the drum
  const double limit = Capstan{0.05, 1e-3, 1, GetParam()}.tension(-from, kPi),
               heavy = -simulation.now().rods[0].points.back().position.z();
  EXPECT_NEAR(heavy / limit, 0.98, 5e-3);
  EXPECT_LT(most, 1e-6);
}

// Beyond it, let go by a hand that bore some of it, it slides, ever faster.
TEST_P(HangingRope, SlidesOffBeyondTheLimit) {
  Scene scene = hanging_rope(GetParam(), 1.02, 0.08);
  scene.simulation.duration = 0.2;
  Simulation simulation(scene);
  simulation.start();
  ASSERT_EQ(simulation.status(), RunStatus::kRunning) << simulation.failure();
  const double from = light_end(simulation);
  double early = 0, late = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    late = light_end(simulation) - from;
    if (simulation.time() < 0.11) early = late;
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_GT(early, 1e-4);
  EXPECT_GT(late, 3 * early);
}

}  // namespace
}  // namespace cprsim
