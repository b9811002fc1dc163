// SPDX-License-Identifier: BSD-3-Clause
// What resists motion along one freedom of a joint, q in rad or m, tau in N m or N:
//   spring and damper    tau = -k (q - q_ref) - c q_t
//   stops at the limits  tau = -k_s s(x) (1 + d x_t)+ outwards, x = q - upper or lower - q (1)
//   dry friction         tau = -clamp(k_f (z + T q_t), -F, F),  z = clamp(q - a, -F/k_f, F/k_f) (2)
// (1) is the law of Hunt and Crossley (J. Appl. Mech. 42, 1975) as SDF's stiffness and dissipation
// mean it in Simbody: loss grows with speed, no pull on the way out. s(x) = x²/2w below w, then
// x - w/2, so that the tangent is continuous.
// (2) is Coulomb friction by return mapping: within an elastic range F/k_f about the anchor a the
// joint truly sticks, held by a spring; beyond it slips at F and takes the anchor along
// (a <- q - z once a step is accepted). T q_t damps the spring's own vibration.
#pragma once

#include "engine/math/archive.h"
#include "engine/model/body_spec.h"

namespace cprsim {

/// An effort and its derivatives.
struct AxisEffort {
  double value = 0, by_q = 0, by_rate = 0;

  AxisEffort& operator+=(const AxisEffort& other) {
    value += other.value;
    by_q += other.by_q;
    by_rate += other.by_rate;
    return *this;
  }
};

class AxisLaw {
 public:
  /// @param scale of q: 1 rad or the robot's length; @param effort the robot's moment or force.
  /// A stop without stiffness of its own gives by 1e-3 of the scale under the robot's effort.
  void set_scale(const AxisSpec& spec, double scale, double effort);

  AxisEffort spring(const AxisSpec& spec, double q, double q_t) const;
  AxisEffort stop(const AxisSpec& spec, double q, double q_t) const;
  AxisEffort friction(const AxisSpec& spec, double q, double q_t) const;

  AxisEffort total(const AxisSpec& spec, double q, double q_t) const;

  /// Energy in the spring and in the stops.
  double stored(const AxisSpec& spec, double q) const;
  /// Energy in the elastic range of friction.
  double stored_in_friction(const AxisSpec& spec, double q) const;

  /// Power that damper and stops turn into heat.
  double loss(const AxisSpec& spec, double q, double q_t) const;

  /// Friction acts from here on, without effort at q.
  void engage_friction(double q) {
    sticks_ = true;
    anchor_ = q;
  }

  /// The step that ends at q is final.
  void accept(const AxisSpec& spec, double q) { anchor_ = q - held(spec, q); }

  void visit(Archive& archive) {
    archive(anchor_);
    archive(sticks_);
  }

 private:
  double held(const AxisSpec& spec, double q) const;
  double past_stop(const AxisSpec& spec, double q, double& sign) const;
  double pressed(double x) const;

  double stop_stiffness_ = 0, stop_width_ = 1, stick_range_ = 1;
  double anchor_ = 0;
  bool sticks_ = false;
};

}  // namespace cprsim
