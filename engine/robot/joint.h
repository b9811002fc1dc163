// SPDX-License-Identifier: BSD-3-Clause
// Rigid joints between bodies, with multipliers. The only place where action and reaction are
// written down.
//
// Joint frames: J_P = X_WP X_PJ E_1(q_1) .. E_n(q_n) on the parent, J_C = X_WC X_CJ on the child.
// E_i turns by q_i about a fixed axis, or slides along it, or both in proportion (screw); slides
// come before turns. Unknowns: the wrench lambda = (moment, force) that the parent exerts on the
// child at J_C, world axes, and the q_i that nothing prescribes. Rows:
//   log(R_JP^T R_JC) = 0,   R_JP^T (p_JC - p_JP) = 0                    (closure, six) (1)
//   a_i · lambda = tau_i(q_i, q_i,t)                            (where q_i is unknown) (2)
// with a_i the twist of dq_i in the world, tau_i a drive's effort plus engine/robot/axis_law.h.
// A ball has no q. Its first three rows are, with e = log(R_JP^T R_JC), in the axes of J_C,
//   R_JC^T m + k e + c omega = 0                                                       (3)
// omega the relative angular velocity, integrated like that of a body (engine/robot/body.cpp).
#pragma once

#include <vector>

#include "engine/math/types.h"
#include "engine/model/action_spec.h"
#include "engine/model/body_spec.h"
#include "engine/robot/axis_law.h"
#include "engine/time/scheme.h"

namespace cprsim {

using Mat36 = Eigen::Matrix<double, 3, 6>;
using Mat63 = Eigen::Matrix<double, 6, 3>;

class Joint {
 public:
  enum class Motion { kFree, kPosition, kVelocity };  ///< what prescribes q

  /// One coordinate: turns by `turn` q about the axis and slides by `slide` q along it.
  struct Freedom {
    const AxisSpec* spec = nullptr;
    Vec3 axis;
    double turn = 0, slide = 0;
    Motion motion = Motion::kFree;
    double effort = 0;  ///< of an effort drive, at the current instant
    int unknown = -1;   ///< among the joint's unknown coordinates, -1 if prescribed
    AxisLaw law;

    bool measured_as_length() const { return turn == 0; }
  };

  Joint(const JointSpec& spec, int parent_body, int child_body, const Pose& X_parent_J,
        const Pose& X_child_J);

  const JointSpec* spec = nullptr;
  int parent = kWorld, child = kWorld;  ///< Newton bodies, kWorld for the ground
  std::vector<Freedom> freedoms;        ///< none of a ball
  Vec3 q = Vec3::Zero();                ///< the first freedoms.size() count
  Vec6 lambda = Vec6::Zero();
  Track track{Track::Kind::kLinear};   ///< of q
  Track spin{Track::Kind::kRotation};  ///< of a ball

  /// Takes over those coordinates that nothing prescribes.
  void set_unknown_q(const Vec3& values) {
    for (std::size_t k = 0; k < freedoms.size(); ++k)
      if (freedoms[k].unknown >= 0)
        q[static_cast<Eigen::Index>(k)] = values[static_cast<Eigen::Index>(k)];
  }

  /// q at the start of the step.
  const Vec3& accepted_q() const { return accepted_q_; }

  bool is_ball() const { return spec->kind == JointKind::kBall; }

  /// After what prescribes q has been said: numbers the unknown coordinates.
  void count_unknowns();

  int unknown_coordinates() const { return unknown_coordinates_; }

  /// In space; in a plane three fewer.
  int unknowns() const { return 6 + unknown_coordinates_; }

  void set_scale(double length, double moment, double force);

  /// Linearised rows (1) or (3), and (2), dimensionless with the given length, moment and force
  /// units; those of (2) by freedom, also of prescribed ones.
  struct Rows {
    Vec6 closure;
    Mat3 axes;                 ///< of closure in the world
    Mat6 by_parent, by_child;  ///< of closure, by (phi, dp) of the bodies' centres of mass
    Mat6 by_lambda;
    Mat63 by_q;
    Vec3 effort;
    Mat36 effort_by_lambda, effort_by_parent;
    Mat3 effort_by_q;
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

  /// World motion that takes the child from q = 0 to the present q.
  Pose displacement(const Pose& X_W_parent) const;

  /// What an observer sees: by freedom, or of a ball the rotation vector, the relative angular
  /// velocity and the moment on the child, in the axes of the parent's joint frame.
  struct Observed {
    Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();
    Vec3 effort = Vec3::Zero();  ///< of lambda along the freedom: drive, spring, stop, friction
    Vec3 stop = Vec3::Zero();    ///< of that, what the limits exert
  };

  Observed observe(const Pose& X_W_parent, const Pose& X_W_child) const;

  /// Of springs and stops, J; friction's elastic range apart.
  double stored_energy() const;
  double friction_energy() const;
  /// Power lost to dampers and stops, W.
  double loss() const;
  /// Effort of dry friction along each freedom.
  Vec3 friction_effort() const;

  /// Coordinates and relative attitude now become the start of the motion; `twist` of the child
  /// relative to the parent at the joint, world axes.
  void start_tracks(const Pose& X_W_parent, const Pose& X_W_child, const Vec6& twist);
  void engage_friction();
  void fill_tracks(const Pose& X_W_parent, const Pose& X_W_child, const StageRates& rates);
  /// The step is final.
  void accept(const Pose& X_W_parent, const Pose& X_W_child);

  void visit(Archive& archive);

  /// Origin of J_C.
  Vec3 place(const Pose& X_W_child) const { return (X_W_child * X_CJ_).p; }

 private:
  Pose parent_frame(const Pose& X_W_parent) const;
  Mat63 twists(const Pose& X_W_parent) const;
  Mat3 relative_attitude(const Pose& X_W_parent, const Pose& X_W_child) const;
  void add_efforts(Rows& rows, const Pose& X_W_parent, const StageRates& rates, double moment,
                   double force) const;
  void make_ball(Rows& rows, const Pose& J_P, const Pose& J_C, const StageRates& rates,
                 double moment) const;

  Pose X_PJ_, X_CJ_;
  int unknown_coordinates_ = 0;
  Vec3 accepted_q_ = Vec3::Zero();
  Mat3 Q_start_ = Mat3::Identity();  ///< R_JP^T R_JC at the start of the step, of a ball
  Vec3 ball_position_ = Vec3::Zero();
};

}  // namespace cprsim
