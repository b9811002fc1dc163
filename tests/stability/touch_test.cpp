// SPDX-License-Identifier: BSD-3-Clause
// Rods that touch: at rest, at speed, across each other at any angle, and where they must not
// begin.
#include "engine/math/so3.h"
#include "engine/run/simulation.h"
#include "scenes/loader/load.h"
#include "tests/stability/measure.h"

namespace cprsim {
namespace {

Scene contact_scene(const std::string& name) {
  LoadResult loaded =
      load_scene(std::string(CPRSIM_SOURCE_DIR) + "/scenes/contact/" + name + ".xml");
  EXPECT_TRUE(loaded.scene);
  return *loaded.scene;
}

// N21: ten seconds on a floor, held by nothing.
TEST(Touch, ARodLiesStillOnAFloor) {
  Simulation simulation(by_method(contact_scene("rod_on_floor")));
  simulation.start();
  const RodSample begun = simulation.now().rods[0];
  const double radius = 0.001, length = begun.length;
  double sink = 0, drift = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    sink = std::max(sink, simulation.now().contact.penetration / radius);
    for (const RodPoint& point : simulation.now().rods[0].points)
      for (const RodPoint& was : begun.points)
        if (point.s == was.s)
          drift = std::max(drift, (point.position - was.position).head<2>().norm() / length);
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone);
  measure("sink / r", sink, 1e-3);
  measure("drift / L", drift, 1e-6);
}

// Of a round solid rod that rolls a third is spin, which only <rotary_inertia/> knows of.
TEST(Touch, InertiaOfLooseRodsIsJudgedByRolling) {
  EXPECT_NEAR(Simulation(contact_scene("slope")).facts().rods[0].rolling_number, 1. / 3, 1e-12);
  EXPECT_EQ(Simulation(contact_scene("capstan")).facts().rods[0].rolling_number, 0);
}

// N22: nothing asks for short steps while a rod falls; the one that meets the floor begins far
// above.
TEST(Touch, ARodFallsOntoAFloorInALongStep) {
  Scene scene = contact_scene("rod_on_floor");
  const double radius = 0.001, height = 0.3;
  scene.rods[0].base.at.X_BF = {exp_so3(Vec3(0, 1.2, 0)), Vec3(0, 0, height + radius)};
  scene.solver.scheme = SchemeKind::kEsdirk32;
  scene.solver.step.reset();
  scene.solver.tolerance = 1e-5;
  Simulation simulation(by_method(scene));
  simulation.start();
  double longest = 0, before = 0;
  while (simulation.status() == RunStatus::kRunning && simulation.now().contact.count == 0) {
    longest = std::max(longest, simulation.time() - before);
    before = simulation.time();
    simulation.advance();
  }
  ASSERT_NE(simulation.status(), RunStatus::kFailed);
  EXPECT_GT(longest, 10 * scene.max_step_size);
  EXPECT_GT(simulation.now().contact.count, 0);
  EXPECT_NEAR(simulation.time(), std::sqrt(2 * height / 9.81), 1.5 * scene.max_step_size);
  measure("depth / r", simulation.now().contact.penetration / radius, 1e-3);
}

// N22: 20 m/s onto a tenth of a millimetre.
TEST(Touch, AThinSheetStopsAFastRod) {
  Simulation simulation(by_method(contact_scene("thin_sheet")));
  simulation.start();
  double lowest = 1, gain = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    for (const RodPoint& point : simulation.now().rods[0].points)
      lowest = std::min(lowest, point.position.z());
    gain = std::max(gain, simulation.now().energy.balance);
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone);
  // the sheet's top is at 0.05 mm
  measure("depth / r", (0.00105 - lowest) / 0.001, 1e-3);
  measure("energy gained, J", gain, 1e-6);
}

/// What a soft rope's fall leaves: see falling_rope.xml.
struct Fall {
  double gain = 0;   ///< most energy made in one step, over what it fell with
  double depth = 0;  ///< deepest, m
};

Fall fall(int cells, double pitch, double modulus, double mu) {
  Scene scene = contact_scene("falling_rope");
  scene.solver.points = cells;
  scene.rods[0].base.at.X_BF = {exp_so3(Vec3(0, pitch, 0)), Vec3(0, 0, 0.3)};
  scene.rods[0].material->youngs_modulus = modulus;
  scene.rods[0].material->shear_modulus = 0.4 * modulus;
  scene.rods[0].surface.friction = mu;
  scene.effects.set(Effect::kFriction, mu > 0);
  Simulation simulation(by_method(scene));
  simulation.start();
  Fall out;
  const double fallen = 1000 * 0.4 * 5.03e-5 * 9.81 * 0.3;  // J
  double balance = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    const Snapshot& now = simulation.now();
    out.gain = std::max(out.gain, (now.energy.balance - balance) / fallen);
    balance = now.energy.balance;
    out.depth = std::max(out.depth, now.contact.penetration);
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return out;
}

// Whatever its stiffness, friction, grid and slope, with steps that the scheme chooses.
TEST(Touch, ASoftRopeWhipsOntoAFloor) {
  struct Case {
    int cells;
    double pitch, modulus, mu;
  };

  double gain = 0, depth = 0;
  for (const Case& c : {Case{4, 0.7, 5e6, 0.3}, Case{8, 1.2, 1e6, 1}, Case{12, 0.7, 5e6, 1},
                        Case{12, 0.3, 1e7, 0.3}, Case{24, 1.2, 5e6, 0.3}, Case{24, 1.5, 5e6, 1},
                        Case{24, 0, 1e7, 0}, Case{48, 1.5, 1e9, 0.3}, Case{40, 1.2, 5e6, 0}}) {
    const Fall found = fall(c.cells, c.pitch, c.modulus, c.mu);
    gain = std::max(gain, found.gain);
    if (c.cells >= 12) depth = std::max(depth, found.depth);
  }
  measure("energy gained in a step / m g h", gain, 1e-3);
  measure("depth / r, 12 cells and more", depth / 0.004, 0.3);
}

/// The force of crossing.xml at its end, the upper rod turned by `angle`.
double pressed_across(double angle) {
  Scene scene = contact_scene("crossing");
  const Mat3 turn = exp_so3(Vec3(0, 0, angle));
  for (JointSpec& joint : scene.joints) {
    BodySpec& yoke = scene.bodies[static_cast<std::size_t>(joint.child)];
    yoke.X_WB = {turn * yoke.X_WB.R, turn * yoke.X_WB.p};
    joint.X_PJ = {turn * joint.X_PJ.R, turn * joint.X_PJ.p};
  }
  Simulation simulation(by_method(scene));
  simulation.start();
  while (simulation.status() == RunStatus::kRunning)
    simulation.advance();
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << angle << ": " << simulation.failure();
  return simulation.now().contact.force;
}

// N23: both rods give way by half, whatever the angle.
TEST(Touch, CrossedRodsPressAlikeAtAnyAngle) {
  const double square = pressed_across(0);
  double change = 0;
  for (int k = 1; k <= 8; ++k)
    change = std::max(change, std::abs(pressed_across(k * std::acos(-1.0) / 18) / square - 1));
  measure("change of the force from 90 to 10 degrees", change, 0.05);
}

// N25: half a radius inside, or wholly.
TEST(Touch, ARodThatBeginsInsideIsNamed) {
  for (const double depth : {0.5, 3.0}) {
    Scene scene = contact_scene("rod_on_floor");
    scene.rods[0].base.at.X_BF.p.z() -= depth * 0.001;
    Simulation simulation(by_method(scene));
    simulation.start();
    EXPECT_EQ(simulation.status(), RunStatus::kFailed) << depth;
    EXPECT_NE(simulation.failure().find("begins inside"), std::string::npos)
        << simulation.failure();
  }
}

}  // namespace
}  // namespace cprsim
