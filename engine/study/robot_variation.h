// SPDX-License-Identifier: BSD-3-Clause
// Second variation of energy, and kinetic energy, of the whole robot about an equilibrium, on the
// motions that its joints allow.
//
// Each rod's coordinates x (RodVariation) are written by those that remain when its ends' joints
// hold: x = Z xi + X (y_A, y_B), with y the motions (phi, d) of the bodies at its ends. Bodies and
// joint coordinates y then obey the rigid joints, C y = 0. Where a joint lets an end turn or a
// body's arm swings, its reaction adds to the form what the second order of that motion costs:
//   position held, arm r on the body       + f·(phi_B × (phi_B × r))                   (1)
//   rotation held in part, reaction m      + m·(phi_B × phi_E) + alpha beta m·(a × b)  (2)
// with f, m the force and moment on the rod's end, and alpha, beta the turns of a universal joint
// about a then b: the second order of exp(phi_B) exp(alpha a) exp(beta b).
#pragma once

#include <vector>

#include "engine/robot/robot.h"
#include "engine/study/rod_variation.h"

namespace cprsim {

/// One rod, in (xi, y_A, y_B): six columns for each body at its ends, unused ones zero.
struct ReducedRod {
  MatX K, M;
  MatX expand;             ///< x by (xi, y_A, y_B)
  MatX nodes;              ///< (phi, d) at the cells' ends by (xi, y_A, y_B); not with kMetric
  MatX demands;            ///< rows on (y_A, y_B) that must vanish for the rod to follow
  Eigen::Index inner = 0;  ///< number of xi
  int base_body = -1, tip_body = -1;
};

struct RobotVariation {
  std::vector<ReducedRod> rods;
  MatX K, M;              ///< of bodies (six each), then joint coordinates, without rods
  MatX C;                 ///< rows that rigid joints, and rods that cannot follow, demand of them
  bool potential = true;  ///< no torques of fixed direction, no followers

  Eigen::Index outer() const { return K.rows(); }

  Eigen::Index inner() const;

  /// Everything in one form over (xi of rod 0, xi of rod 1, ..., z) with y = free() z.
  MatX free() const;
  void assemble(MatX& stiffness, MatX& mass) const;
};

enum class Inertia {
  kReal,    ///< the robot's own: rods with rotary inertia if the scene lists it, bodies, no gravity
  kMetric,  ///< mean square displacement of rods' material; bodies count like the mean of all rods
};

RobotVariation robot_variation(const Robot& robot, Inertia inertia);

}  // namespace cprsim
