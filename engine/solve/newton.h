// SPDX-License-Identifier: BSD-3-Clause
// Nonlinear solvers and the ladder of them that finds a static equilibrium from the scene alone.
#pragma once

#include <limits>

#include "engine/solve/problem.h"
#include "engine/solve/report.h"

namespace cprsim {

/// Of one equilibrium: some ten to twenty seconds of work (docs/random_robots.md).
constexpr long kMostStaticWork = 100'000'000;

struct SolveOptions {
  double tolerance = 1e-9;  ///< converged: largest row <= tolerance
  int max_iterations = 30;  ///< per call of newton() or levenberg_marquardt()
  double max_merit =
      1e30;  ///< newton() gives up at once above this (a trial step that is hopeless)
  /// Every solver ends with kWorkLimit once the problem's work() is beyond this: ladders of rungs
  /// and of loads have no other end.
  long most_work = std::numeric_limits<long>::max();
  /// One full step even from a guess that meets the tolerance already, kept if it still does: in
  /// time steps the error of accepted guesses would add up.
  bool polish = false;
  /// newton() takes full steps whatever they do to the merit: past kinks, at which a merit that
  /// must fall stops.
  bool bold = false;
  /// relaxation() begins assembled and under full load, from a displaced equilibrium.
  bool assembled = false;
  /// relaxation() halves its drag wherever Newton's method has no trouble following.
  bool brisk = false;
};

/// Newton's method. A full step that lowers the merit is taken. One that raises it is given a
/// second chance (watchdog, Chamberlain et al., Math. Program. Study 16, 1982): if the step after
/// it ends below where both began, both are kept; stiff closed chains need that, their closure
/// being linear only in part. Otherwise the step is shortened until the merit falls by 1e-4 of what
/// the linear model promises; kStalled when it would be shorter than 1/1024.
SolveReport newton(Problem& problem, const SolveOptions& options);

/// Levenberg-Marquardt with gain-ratio control of mu (Nielsen 1999).
SolveReport levenberg_marquardt(Problem& problem, const SolveOptions& options);

/// Newton on a sequence of easier problems, fraction 0 → 1, step doubled after success and
/// quartered after failure.
SolveReport continuation(Problem& problem, const SolveOptions& options);

/// Newton on rods that stretch as easily as they bend at first and harden in small steps: where
/// many stiff legs of unequal length must be brought together.
SolveReport hardening(Problem& problem, const SolveOptions& options);

/// Implicit gradient flow (pseudo-transient continuation, Kelley & Keyes, SINUM 35, 1998) from the
/// start: drag falls as the residual does. Ends in a stable equilibrium.
SolveReport relaxation(Problem& problem, const SolveOptions& options);

/// newton, levenberg_marquardt, continuation, relaxation, in that order; the first that converges.
/// Where parts must be brought together, newton and levenberg_marquardt begin from a rough solution
/// with soft rods, newton a second time with rods bowed; hardening comes before continuation, and
/// relaxation once from soft rods before it begins from the scene's own start. At last each part is
/// brought to its place by itself, and newton and a brisk relaxation begin from there.
/// No rung is begun once most_work is reached.
SolveReport solve_statics(Problem& problem, const SolveOptions& options);

}  // namespace cprsim
