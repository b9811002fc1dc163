// SPDX-License-Identifier: BSD-3-Clause
// One point of a path of equilibria: the equilibrium together with the path's own unknowns.
//
//   unknowns   x   robot (drives locked),   y   n numbers, the last of them lambda, the path's
//                                               parameter
//   rows       F(x, y) = 0                      equilibrium
//              g(x, y) = 0                      n - 1 rows: a frame is where lambda wants it
//              t_u · (u(x) - u_0) + t_y · (y - y_0) = sigma      arclength (Keller 1977)     (1)
//
// Block elimination: with the robot's own Newton direction at y and at y + h e_i,
//   x_0 = x - F_x^-1 F,      x_i - x_0 = -h F_x^-1 F_y e_i      (difference of two directions)
// a small system in dy alone remains, and x_0 + sum (dy_i / h) (x_i - x_0) is the step. Rods stay
// condensed, and nothing but solves with F_x is needed: no second linear system beside that of
// engine/robot. Where F_x is singular (folds, branch points) the elimination loses as many digits
// as F_x has lost, which the next iteration, with the residual of the whole, restores; it fails
// only within round-off of the singular point itself, which a path steps over.
//
// Arclength is measured in u: motions of bodies (rotation, translation / L), joint coordinates and
// the root mean square of the rods' nodes / L; and in y over its units. L is the robot's length.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/study/inverse.h"
#include "engine/study/static_study.h"

namespace cprsim {

/// What changes along a path. The parameter lambda, last of y, goes from 0 to 1.
struct PathProblem {
  VecX start;  ///< y at lambda = 0
  VecX units;  ///< of y: a large change
  std::function<void(StaticStudy&, const VecX& y)> apply;
  /// n - 1 rows, dimensionless.
  std::function<VecX(const StaticStudy&, const VecX& y)> rows;
  bool free_drives = false;  ///< a pose is prescribed: turning back and instability are two things

  Eigen::Index size() const { return start.size(); }
};

/// Parameters on the straight line from `from` to `to`.
PathProblem along_line(const StaticStudy& study, const std::vector<Parameter>& parameters,
                       const VecX& from, const VecX& to);

/// The frame of `from` on the straight line to the pose of `to`, angles linear too, by as many free
/// parameters as freedoms are asked; start holds the parameters' present values.
/// @throws std::invalid_argument if the numbers differ
PathProblem along_pose(const StaticStudy& study, const std::vector<Parameter>& parameters,
                       const PoseGoal& from, const PoseGoal& to);

/// A direction in (u, y / units).
struct PathDirection {
  VecX u, y;

  double dot(const PathDirection& other) const { return u.dot(other.u) + y.dot(other.y); }
};

/// A converged point with its linearisation.
struct PathStation {
  StaticStudy::State state;
  VecX y;
  double s = 0;                      ///< arclength from the path's start
  PathDirection tangent;             ///< unit
  VecX stiffnesses;                  ///< ascending, N/m; once judged
  int unstable = 0;                  ///< how many are negative, see path_events.h
  std::vector<RobotUnknowns> sides;  ///< x_0, then x_i
  VecX differences;                  ///< h of each, in y

  double lambda() const { return y[y.size() - 1]; }
};

class PathSystem {
 public:
  PathSystem(StaticStudy& study, PathProblem problem);

  const PathProblem& problem() const { return problem_; }

  StaticStudy& study() { return study_; }

  /// Motion from `reference` to x in the metric of the arclength.
  VecX motion(const RobotUnknowns& x, const RobotUnknowns& reference) const;

  /// Only lambda.
  PathDirection forward() const;

  /// The point at distance sigma along the plane's normal from `from`, sought from the tangent.
  /// @return false if Newton's method does not find it, or far from where it was expected
  bool advance(const PathStation& from, double sigma, PathStation& to);

  /// Distance of a point from `from` along its tangent: the sigma of advance().
  double distance(const PathStation& from, const PathStation& to) const;

  /// The same as advance(), sought from the polynomial through points whose distances from `from`
  /// are known. Close to a singular point a guess must be good: the elimination multiplies its
  /// residual by the inverse of what is singular.
  bool interpolate(const PathStation& from, double sigma,
                   const std::vector<const PathStation*>& near, PathStation& to);

  /// The point of the plane (1) of `normal` through `origin`, sought from the study's present shape
  /// and y. @param along orients the tangent
  bool correct(const StaticStudy::State& origin, const VecX& origin_y, const PathDirection& normal,
               double sigma, VecX y, const PathDirection& along, PathStation& to);

  int iterations() const { return iterations_; }  ///< of the last correction

 private:
  bool linearize(const VecX& y, PathStation& at);
  void place(const PathStation& at, const VecX& dy);
  bool solve_small(const PathStation& at, const StaticStudy::State& origin, const VecX& origin_y,
                   const PathDirection& normal, double sigma, VecX& dy) const;
  void put(const StaticStudy::State& shape, const VecX& y);
  bool find_tangent(PathStation& at, const PathDirection& along) const;

  StaticStudy& study_;
  PathProblem problem_;
  std::vector<VecX> side_rows_;  ///< g at x_0, then at x_i
  int iterations_ = 0;
};

}  // namespace cprsim
