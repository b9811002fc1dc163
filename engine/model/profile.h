// SPDX-License-Identifier: BSD-3-Clause
// Functions of time that drives and loads follow: a sum of simple shapes, with first and second
// derivatives and the instants at which they are not smooth.
#pragma once

#include <vector>

#include "engine/model/expression.h"
#include "engine/model/place.h"

namespace cprsim {

enum class ShapeOfTime {
  kConstant,
  kStep,
  kRamp,
  kSmoothstep,
  kTrapezoid,
  kSine,
  kChirp,
  kKeyframes,
  kExpression
};
enum class Interpolation { kStep, kLinear, kPchip, kCubic };

/// One summand. Step: `from` before `start`, `to` after. Ramp and smoothstep (quintic) go from
/// `from` to `to` between start and end; so does the trapezoid, whose rate grows and falls by the
/// given acceleration and is constant in between. Sine: amplitude sin(2 pi frequency (t - start) +
/// phase) within [start, end], 0 outside. Chirp: likewise, its frequency growing linearly from
/// `frequency` to `last_frequency`. Keyframes hold their first and last value outside.
struct ProfileTerm {
  // Compiled once, in scene.cpp: dozens of files make and copy one.
  ProfileTerm();
  ProfileTerm(const ProfileTerm&);
  ProfileTerm(ProfileTerm&&) noexcept;
  ProfileTerm& operator=(const ProfileTerm&);
  ProfileTerm& operator=(ProfileTerm&&) noexcept;
  ~ProfileTerm();

  ShapeOfTime shape = ShapeOfTime::kConstant;
  double value = 0;  ///< constant
  double from = 0, to = 0, start = 0, end = 0;
  double amplitude = 0, frequency = 0, last_frequency = 0, phase = 0;  ///< Hz, rad
  double acceleration = 0;  ///< of a trapezoid, > 0; at least least_acceleration()
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<double> times, values, slopes;  ///< keyframes; slopes filled by finish_keyframes()
  Expression expression;
};

/// Value and derivatives of a profile at one instant.
struct ProfileValue {
  double value = 0, rate = 0, acceleration = 0;
};

struct Profile {
  std::vector<ProfileTerm> terms;
  Place place;

  /// One-sided from the right: at a jump the value after it. `before` takes the left limit instead,
  /// which is what an initial static equilibrium "before t = 0" sees.
  ProfileValue evaluate(double t, bool before = false) const;

  /// Instants in (0, end] or at 0 at which the value or a derivative up to the second jumps,
  /// ascending.
  std::vector<double> breakpoints(double end) const;
};

/// Below it a trapezoid does not arrive in time.
double least_acceleration(const ProfileTerm& trapezoid);

/// Of a spline, at its first and last key.
struct EndSlopes {
  double first = 0, last = 0;
};

/// Computes the slopes of pchip (Fritsch-Carlson) and cubic keyframes.
/// @param ends of the cubic spline; null: the natural one, whose second derivatives vanish there
void finish_keyframes(ProfileTerm& term, const EndSlopes* ends = nullptr);

}  // namespace cprsim
