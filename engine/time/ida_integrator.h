// SPDX-License-Identifier: BSD-3-Clause
// Time steps by IDA of SUNDIALS: backward differentiation formulas of orders 1 to 5 with variable
// order and step, in fixed leading coefficient form. IDA keeps y = (x, v) of all tracks and their
// derivatives, controls the error and predicts; every nonlinear solve is ours. What it asks there,
//   y_t = y_t,predicted + c (y - y_predicted),
// is (1) of engine/time/scheme.h with c_v = c_w = c,
//   x_h = x_t,predicted - c x_predicted,      v_h = v_t,predicted - c v_predicted,
// so that rods, bodies and joints need not know. Multipliers and whatever else has no derivative
// stay out of y. Rotation vectors are measured from one frame through many steps: begin() again
// before they get long.
// Source: Hindmarsh et al., "SUNDIALS", ACM TOMS 31 (2005), sections 2.3 and 3.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/time/scheme.h"

namespace cprsim {

/// How much of a track counts in the error: its first coordinates, in a unit.
struct TrackError {
  Eigen::Index coordinates = 0;
  double unit = 1;
};

class IdaIntegrator {
 public:
  /// Solves the equations at a time. On success x of all tracks, and v of rotations, are filled.
  using Solve = std::function<bool(double time, const StageRates& rates)>;

  /// @param errors one for each track
  /// @param tolerance of the local error of a step, of positions and of velocities times the step
  IdaIntegrator(std::vector<Track*> tracks, std::vector<TrackError> errors, double tolerance,
                Solve solve);
  ~IdaIntegrator();
  IdaIntegrator(const IdaIntegrator&) = delete;
  IdaIntegrator& operator=(const IdaIntegrator&) = delete;

  /// From x, x_t, v and a of the tracks, at order 1; rotation vectors are measured from here on.
  /// @param step the first one
  void begin(double time, double step);

  bool begun() const { return begun_; }

  /// The next step starts anew.
  void stop() { begun_ = false; }

  /// One step, which does not go beyond `end`. On success the tracks hold it.
  /// @return the time reached, or nothing: the step became too small, or solves do not converge;
  /// the tracks then hold where it began
  std::optional<double> advance(double end);

  /// Steps that IDA has tried in vain since the last call.
  long take_rejected();

  /// Of the step that comes next.
  double next_step() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
  bool begun_ = false;
};

}  // namespace cprsim
