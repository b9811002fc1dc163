// SPDX-License-Identifier: BSD-3-Clause
// Rigid joints between bodies, with multipliers. The only place where action and reaction are
// written down.
//
// Joint frames: J_P = X_WP X_PJ exp(A q) on the parent, J_C = X_WC X_CJ on the child. Unknowns: the
// wrench lambda = (moment, force) that the parent exerts on the child at J_C, world axes, and q
// where nothing prescribes it. Rows:
//   log(R_JP^T R_JC) = 0,   R_JP^T (p_JC - p_JP) = 0                    (closure, six) (1) a ·
//   lambda = tau(q, q_t)                                            (where q is unknown) (2)
// with a the axis in the world and tau = effort - damping q_t - stiffness (q - q_ref).
#pragma once

#include "engine/math/types.h"
#include "engine/model/action_spec.h"
#include "engine/model/body_spec.h"
#include "engine/time/scheme.h"

namespace cprsim {

using Row6 = Eigen::Matrix<double, 1, 6>;

class Joint {
 public:
  enum class Freedom { kNone, kRevolute, kPrismatic };
  enum class Motion { kFree, kPosition, kVelocity };  ///< what prescribes q

  Joint(const JointSpec& spec, int parent_body, int child_body, const Pose& X_parent_J,
        const Pose& X_child_J);

  const JointSpec* spec = nullptr;
  int parent = kWorld, child = kWorld;  ///< Newton bodies, kWorld for the ground
  Freedom freedom = Freedom::kNone;
  Motion motion = Motion::kFree;
  double effort = 0;  ///< given by an effort drive, at the current instant
  double q = 0;
  Vec6 lambda = Vec6::Zero();
  Track track{Track::Kind::kLinear};  ///< of q

  bool q_unknown() const { return freedom != Freedom::kNone && motion == Motion::kFree; }

  /// In space; in a plane three fewer.
  int unknowns() const { return q_unknown() ? 7 : 6; }

  /// Linearised closure (1) and effort row (2), dimensionless with the given length, moment and
  /// force units.
  struct Rows {
    Vec6 closure;
    Mat3 axes;                 ///< of closure in the world
    Mat6 by_parent, by_child;  ///< of closure, by (phi, dp) of the bodies' centres of mass
    Vec6 by_q;
    double effort = 0;
    Row6 effort_by_lambda;
    Row6 effort_by_parent;
    double effort_by_q = 0;
  };

  Rows rows(const Pose& X_W_parent, const Pose& X_W_child, const StageRates& rates, double length,
            double moment, double force) const;

  /// lambda on the bodies, about their centres of mass, and its derivatives.
  struct Wrenches {
    Vec6 on_parent, on_child;
    Mat6 parent_by_lambda, child_by_lambda;
    Mat6 parent_by_parent, parent_by_child, child_by_child;
  };

  Wrenches wrenches(const Pose& X_W_parent, const Pose& X_W_child) const;

  /// Component of lambda along the freedom, i.e. what drives it, and the axis in the world.
  double axial_effort(const Pose& X_W_parent) const;

  /// World motion that takes the child from q = 0 to the present q.
  Pose displacement(const Pose& X_W_parent) const;

  /// What spring and damper take of that at rate q_t.
  double passive_effort(double q_t) const {
    return spec->spring_stiffness * (q - spec->spring_reference) + spec->damping * q_t;
  }

 private:
  Pose parent_frame(const Pose& X_W_parent) const;

  Pose X_PJ_, X_CJ_;
  Vec3 axis_;
};

}  // namespace cprsim
