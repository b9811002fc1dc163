// SPDX-License-Identifier: BSD-3-Clause
// Paths of equilibria through folds and branch points: pseudo-arclength continuation with
// predictor along the tangent and adaptive steps (Keller, Applications of Bifurcation Theory,
// 1977), on the system of path_system.h; stability of every point by the signs of its second
// variation (stability.h); events located where a function of arclength vanishes:
//
//   fold         lambda' = 0: the path turns                            (lambda: the parameter)
//   branch point a stiffness passes zero where the path does not turn: another path crosses
//   stability    the same on a path of prescribed poses, on which drives yield: with drives locked
//                the robot becomes unstable, though the path goes on
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/study/path_system.h"
#include "engine/study/stability.h"

namespace cprsim {

enum class PathEventKind { kFold, kBranchPoint, kStability };

const char* to_string(PathEventKind kind);

struct PathPoint {
  StaticStudy::State state;
  double lambda = 0;
  double s = 0;  ///< arclength
  StabilityVerdict verdict = StabilityVerdict::kStable;
  int unstable = 0;
  double softest = 0;  ///< N/m, as in Stability
};

struct PathEvent {
  PathEventKind kind = PathEventKind::kFold;
  PathPoint point;
  int before = 0, after = 0;  ///< unstable directions
  /// The critical motion, unit in the metric of the arclength: of bodies (rotation, translation),
  /// and the robot displaced along it by kCriticalMotion.
  std::vector<Vec6> bodies;
  StaticStudy::State displaced;
  PathDirection direction;
  PathStation station;
};

enum class PathEnd {
  kArrived,  ///< lambda = 1
  kLow,      ///< lambda fell to PathOptions::low
  kPointLimit,
  kEventLimit,
  kStopped,  ///< by the observer
  kNoStart,  ///< no equilibrium to begin with
  kStuck     ///< no further point was found with the smallest step
};

const char* to_string(PathEnd end);

struct PathOptions {
  double first_step = 0.02, largest_step = 0.1, smallest_step = 1e-6;  ///< of arclength
  double low = -1;  ///< lambda at which a path that goes back ends
  int max_points = 2000;
  int max_events = 1000;
  double turn = 0.25;  ///< most angle between the tangents of neighbours, rad
  /// Called with every point and event; false ends the path.
  std::function<bool(const PathPoint&)> observe;
};

struct Path {
  std::vector<PathPoint> points;
  std::vector<PathEvent> events;  ///< ascending in s
  PathEnd end = PathEnd::kNoStart;
  int refused = 0;  ///< steps that were taken again, smaller

  bool complete() const { return end != PathEnd::kNoStart && end != PathEnd::kStuck; }
};

/// Unit of a displaced shape's motion in the metric of the arclength.
constexpr double kCriticalMotion = 0.02;

/// From the study's present equilibrium, which must be that of the problem's start.
Path follow_path(StaticStudy& study, const PathProblem& problem, const PathOptions& options = {});

/// The other path through an event's point, towards `side` (+1, -1) times the critical motion.
Path follow_branch(StaticStudy& study, const PathProblem& problem, const PathEvent& event, int side,
                   const PathOptions& options = {});

/// Where the robot goes from an unstable point with its parameters locked.
struct Release {
  SolveReport solve;  ///< relaxation(): implicit gradient flow, not dynamics
  PathPoint end;
  double moved = 0;  ///< in the metric of the arclength
};

/// From `point`, displaced by `side` (+1, -1) times the critical motion of the event at which
/// stability was lost, downhill to a stable equilibrium.
Release release(StaticStudy& study, const PathProblem& problem, const PathPoint& point,
                const PathEvent& event, int side);

/// The motion against which the study's present equilibrium is nearest to yielding, by inverse
/// iteration on the robot's own linear system: positions are held by weak springs whose rest is
/// moved, and what follows them most is kept. @param displaced the shape moved by `amount` in the
/// metric. @return false where the linear system is singular
bool critical_motion(PathSystem& system, double amount, PathDirection& direction,
                     StaticStudy::State& displaced);

}  // namespace cprsim
