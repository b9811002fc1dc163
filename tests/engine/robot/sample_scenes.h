// SPDX-License-Identifier: BSD-3-Clause
// Small scenes made in code, with numbers near 1 and nothing symmetric, and generic states of them.
#pragma once

#include <random>
#include <string>

#include "engine/model/scene.h"
#include "engine/robot/equations.h"

namespace cprsim {

/// Numbers in [-1, 1], the same in every run.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}

  double next() { return 2.0 * static_cast<double>(engine_()) / 4294967295.0 - 1.0; }

  Vec3 vec3() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }

  Vec6 vec6() {
    Vec6 v;
    for (int i = 0; i < 6; ++i)
      v[i] = next();
    return v;
  }

  /// A rotation by up to about `angle`, and a shift by up to `shift`.
  Pose pose(double angle, double shift);

 private:
  std::mt19937 engine_;
};

Profile constant_profile(double value);

/// Length 1, bending stiffness 1 and 1.4 N m², 0.3 kg/m, with damping should the effect be on.
RodSpec sample_rod(const std::string& name);

RodEndSpec rod_end(EndJoint joint, int body, const Pose& X_BF);

/// Any inertia, centre of mass off the link's origin.
BodySpec sample_body(const std::string& name, const Pose& X_WB, double mass);

/// One rod from the ground to the ground.
Scene grounded_rod(const RodEndSpec& base, const RodEndSpec& tip);

/// Ground - rod - body - rod - body - rod - ground.
Scene chain_of_rods(EndJoint base, EndJoint tip);

/// Ground - joint - arm - rod - ground. The arm carries a joint to a second arm, held by a rod too.
Scene jointed_arms(JointKind first, JointKind second);

/// Tracks at rest where the robot is, then moving; histories as a step of length h sets them.
StageRates start_step(Robot& robot, Equations& equations, SchemeKind scheme, double h,
                      Numbers& numbers);

/// Moves every unknown of the robot by about `size`, so that no row is left zero.
void disturb(Robot& robot, Equations& equations, Numbers& numbers, double size);

/// Ties the rods of a chain to each other: two ends in one section of the middle rod, arms of any
/// length, one at a tip.
void tie_chain(Scene& scene);

/// By a method whose contacts are at the borders of its elements, six of them.
void cut_for_contact(Scene& scene, Method method);

}  // namespace cprsim
