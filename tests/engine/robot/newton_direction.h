// SPDX-License-Identifier: BSD-3-Clause
// The whole linearisation at once: along the Newton direction d at a state x where no row vanishes,
//   d merit(x + alpha d) / d alpha = -2 merit at alpha = 0
// holds if and only if sum r_i (J d + r)_i = 0, which an error in any derivative breaks.
#pragma once

#include <gtest/gtest.h>

#include "tests/engine/robot/direction_error.h"
#include "tests/engine/robot/sample_scenes.h"
#include "tests/support/methods.h"

namespace cprsim::newton_direction {

enum class Rates { kStatic, kBackwardEuler, kGeneralizedAlpha };

struct Setting {
  Rates mode = Rates::kStatic;
  double h = 1. / 300;
  double relaxation = 0, softness = 0, fraction = 1;
  bool bodies_held = false;
};

inline StageRates rates_of(const Setting& setting, Robot& robot, Equations& equations,
                           Numbers& numbers) {
  if (setting.mode == Rates::kStatic) return StageRates{};
  const bool euler = setting.mode == Rates::kBackwardEuler;
  return start_step(robot, equations,
                    euler ? SchemeKind::kBackwardEuler : SchemeKind::kGeneralizedAlpha, setting.h,
                    numbers);
}

/// |slope of merit / (-2 merit) - 1| at a generic state; 1 if there is no direction.
inline double slope_error(const Scene& scene, const Setting& setting, unsigned seed) {
  Numbers numbers(seed);
  Robot robot = build_robot(scene);
  Equations equations(robot, 1e-9);
  equations.set_instant(0, true, StageRates{});
  equations.mark_start();
  const StageRates rates = rates_of(setting, robot, equations, numbers);
  equations.hold_bodies(setting.bodies_held);
  equations.set_instant(0, true, rates);
  disturb(robot, equations, numbers, 0.05);
  equations.evaluate();
  if (setting.fraction < 1) equations.set_fraction(setting.fraction);
  if (setting.relaxation > 0) equations.set_relaxation(setting.relaxation);
  if (setting.softness > 0) equations.set_softness(setting.softness);
  equations.set_instant(0, true, rates);  // now that there are states, segments are cut
  disturb(robot, equations, numbers, 0.05);
  return direction_error(equations);
}

// fourth-order differences reach 1e-9 and better; round-off of stiff inertia is most of that
inline constexpr double kTolerance = 1e-7;

/// Of rods discretised in every way, or in the scene's.
inline void expect_exact(Scene scene, const Setting& setting, const std::string& what) {
  std::vector<Method> methods{scene.solver.method};
  if (scene.solver.method == Method::kAuto)
    methods.assign(std::begin(kEveryMethod), std::end(kEveryMethod));
  scene.solver.order = 3;
  for (Method method : methods)
    for (unsigned seed = 1; seed <= 3; ++seed) {
      scene.solver.method = method;
      EXPECT_LT(slope_error(scene, setting, seed), kTolerance)
          << what << ", state " << seed << ", " << method_name(method);
    }
}

inline void set_all_effects(Scene& scene) {
  for (Effect e : {Effect::kGravity, Effect::kExtension, Effect::kShear, Effect::kRotaryInertia,
                   Effect::kDamping})
    scene.effects.set(e, true);
}

inline LoadSpec sample_load(bool follower) {
  LoadSpec load;
  load.follower = follower;
  load.force = {0.8, -0.5, 0.6};
  load.torque = {-0.3, 0.4, 0.5};
  load.R_expressed = Eigen::AngleAxisd(0.7, Vec3::UnitX()).toRotationMatrix();
  return load;
}

}  // namespace cprsim::newton_direction
