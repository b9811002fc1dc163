// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/axis_law.h"

#include <algorithm>
#include <cmath>

namespace cprsim {
namespace {

// of the scale of q: what a default stop gives under the robot's effort, over which width a stop
// stiffens, how far a joint that sticks can move. Small against what anybody measures on a robot.
constexpr double kStopGives = 1e-3, kStopWidth = 1e-4, kStickRange = 1e-5;

// s; slow against the vibration of a body held by friction (F / k_f = 1e-5 at 1 m/s²: 3 ms)
constexpr double kStickTime = 1e-2;

}  // namespace

void AxisLaw::set_scale(const AxisSpec& spec, double scale, double effort) {
  stop_stiffness_ = spec.stop_stiffness.value_or(effort / (kStopGives * scale));
  stop_width_ = kStopWidth * scale;
  stick_range_ = kStickRange * scale;
}

AxisEffort AxisLaw::spring(const AxisSpec& spec, double q, double q_t) const {
  return {-spec.spring_stiffness * (q - spec.spring_reference) - spec.damping * q_t,
          -spec.spring_stiffness, -spec.damping};
}

double AxisLaw::past_stop(const AxisSpec& spec, double q, double& sign) const {
  sign = q > spec.upper ? 1 : -1;
  if (q > spec.upper) return q - spec.upper;
  return q < spec.lower ? spec.lower - q : 0;
}

double AxisLaw::pressed(double x) const {
  return x < stop_width_ ? x * x / (2 * stop_width_) : x - 0.5 * stop_width_;
}

AxisEffort AxisLaw::stop(const AxisSpec& spec, double q, double q_t) const {
  double sign = 1;
  const double x = past_stop(spec, q, sign);
  if (x <= 0) return {};
  const double factor = std::max(0.0, 1 + spec.stop_dissipation * sign * q_t);
  const double force = stop_stiffness_ * pressed(x);
  AxisEffort tau;
  tau.value = -sign * force * factor;
  tau.by_q = -stop_stiffness_ * std::min(1.0, x / stop_width_) * factor;
  if (factor > 0) tau.by_rate = -force * spec.stop_dissipation;
  return tau;
}

double AxisLaw::held(const AxisSpec& spec, double q) const {
  return spec.friction > 0 && sticks_ ? std::clamp(q - anchor_, -stick_range_, stick_range_) : 0;
}

AxisEffort AxisLaw::friction(const AxisSpec& spec, double q, double q_t) const {
  if (!sticks_ || spec.friction <= 0) return {};
  const double k = spec.friction / stick_range_, z = held(spec, q);
  const double trial = k * (z + kStickTime * q_t);
  if (std::abs(trial) >= spec.friction) return {-std::copysign(spec.friction, trial), 0, 0};
  return {-trial, std::abs(q - anchor_) < stick_range_ ? -k : 0, -k * kStickTime};
}

AxisEffort AxisLaw::total(const AxisSpec& spec, double q, double q_t) const {
  AxisEffort tau = spring(spec, q, q_t);
  tau += stop(spec, q, q_t);
  tau += friction(spec, q, q_t);
  return tau;
}

double AxisLaw::stored(const AxisSpec& spec, double q) const {
  const double stretch = q - spec.spring_reference;
  double sign = 1, energy = 0.5 * spec.spring_stiffness * stretch * stretch;
  const double x = past_stop(spec, q, sign), w = stop_width_;
  if (x <= 0) return energy;
  energy += stop_stiffness_ * (x < w ? x * x * x / (6 * w) : 0.5 * x * (x - w) + w * w / 6);
  return energy;
}

double AxisLaw::stored_in_friction(const AxisSpec& spec, double q) const {
  const double z = held(spec, q);
  return 0.5 * spec.friction / stick_range_ * z * z;
}

double AxisLaw::loss(const AxisSpec& spec, double q, double q_t) const {
  double sign = 1;
  const double x = past_stop(spec, q, sign);
  double power = spec.damping * q_t * q_t;
  if (x > 0) power -= (stop(spec, q, q_t).value + sign * stop_stiffness_ * pressed(x)) * q_t;
  return power;
}

}  // namespace cprsim
