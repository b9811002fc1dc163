// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/path.h"

#include <algorithm>
#include <cmath>

#include "engine/solve/newton.h"
#include "engine/study/path_events.h"

namespace cprsim {
namespace {

constexpr int kEasy = 4;  // corrections of so many iterations let the step grow
constexpr double kGrow = 1.5;

}  // namespace

const char* to_string(PathEventKind kind) {
  switch (kind) {
    case PathEventKind::kFold:
      return "fold";
    case PathEventKind::kBranchPoint:
      return "branch point";
    case PathEventKind::kStability:
      break;
  }
  return "stability";
}

const char* to_string(PathEnd end) {
  switch (end) {
    case PathEnd::kArrived:
      return "arrived";
    case PathEnd::kLow:
      return "went back";
    case PathEnd::kPointLimit:
      return "point limit";
    case PathEnd::kEventLimit:
      return "event limit";
    case PathEnd::kStopped:
      return "stopped";
    case PathEnd::kNoStart:
      return "no start";
    case PathEnd::kStuck:
      break;
  }
  return "stuck";
}

namespace {

class Follower {
 public:
  Follower(PathSystem& system, const PathOptions& options) : system_(system), options_(options) {}

  Path run(PathStation start) {
    here_ = std::move(start);
    add(judged_point(system_.study(), here_, nullptr));
    double step = std::min(options_.first_step, options_.largest_step);
    while (path_.end == PathEnd::kNoStart) {
      PathStation next;
      const double angle = try_step(step, next);
      if (angle < 0 || angle > options_.turn) {
        ++path_.refused;
        step *= 0.5;
        if (step < options_.smallest_step) path_.end = PathEnd::kStuck;
        continue;
      }
      const int iterations = system_.iterations();
      const bool last = leaves(next);
      take(next);
      if (last) break;
      if (iterations <= kEasy && angle < 0.6 * options_.turn)
        step = std::min(kGrow * step, options_.largest_step);
      if (iterations > kEasy + 2) step *= 0.5;
    }
    return std::move(path_);
  }

 private:
  /// The angle between tangents, or -1 where no point was found.
  double try_step(double step, PathStation& next) {
    if (!system_.advance(here_, step, next)) return -1;
    return std::acos(std::clamp(here_.tangent.dot(next.tangent), -1.0, 1.0));
  }

  /// Ends the path on the limit of lambda, if `next` passes one.
  bool leaves(PathStation& next) {
    const bool high = next.lambda() >= 1, low = next.lambda() <= options_.low;
    if (!high && !low) return false;
    path_.end = high ? PathEnd::kArrived : PathEnd::kLow;
    const double limit = high ? 1 : options_.low;
    const PathDirection forward = system_.forward();
    const double part = (limit - here_.lambda()) / (next.lambda() - here_.lambda());
    PathStation at;
    const double unit = system_.problem().units[system_.problem().size() - 1];
    system_.study().restore(next.state);
    VecX origin = VecX::Zero(next.y.size());
    if (system_.correct(next.state, origin, forward, limit / unit, next.y, next.tangent, at)) {
      at.s = here_.s + part * (next.s - here_.s);
      next = at;
    }
    return true;
  }

  void take(PathStation& next) {
    const PathPoint point = judged_point(system_.study(), next, &here_);
    for (PathEvent& event : events_between(system_, here_, next))
      path_.events.push_back(std::move(event));
    here_ = next;
    add(point);
    if (path_.end != PathEnd::kNoStart) return;
    if (static_cast<int>(path_.points.size()) >= options_.max_points)
      path_.end = PathEnd::kPointLimit;
    if (static_cast<int>(path_.events.size()) >= options_.max_events)
      path_.end = PathEnd::kEventLimit;
  }

  void add(const PathPoint& point) {
    path_.points.push_back(point);
    if (options_.observe && !options_.observe(point)) path_.end = PathEnd::kStopped;
  }

  PathSystem& system_;
  const PathOptions& options_;
  PathStation here_;
  Path path_;
};

}  // namespace

Path follow_path(StaticStudy& study, const PathProblem& problem, const PathOptions& options) {
  PathSystem system(study, problem);
  const PathDirection forward = system.forward();
  const StaticStudy::State origin = study.state();
  PathStation start;
  if (!system.correct(origin, problem.start, forward, 0, problem.start, forward, start)) return {};
  return Follower(system, options).run(start);
}

Path follow_branch(StaticStudy& study, const PathProblem& problem, const PathEvent& event, int side,
                   const PathOptions& options) {
  PathSystem system(study, problem);
  PathDirection normal = event.direction;
  normal.u *= side;
  normal.y *= side;
  // the smaller the first step, the nearer the guess, and the worse the linear system
  for (double amount = kCriticalMotion; amount > 1e-4; amount *= 0.5) {
    study.restore(event.station.state);
    study.equations().predict(
        {&event.station.state.unknowns, &event.displaced.unknowns},
        {1 - side * amount / kCriticalMotion, side * amount / kCriticalMotion});
    PathStation start;
    if (!system.correct(event.station.state, event.station.y, normal, amount, event.station.y,
                        normal, start))
      continue;
    start.s = amount;
    return Follower(system, options).run(start);
  }
  return {};
}

Release release(StaticStudy& study, const PathProblem& problem, const PathPoint& point,
                const PathEvent& event, int side) {
  PathSystem system(study, problem);
  study.restore(point.state);
  study.equations().predict(
      {&point.state.unknowns, &event.displaced.unknowns, &event.station.state.unknowns},
      {1, 1.0 * side, -1.0 * side});
  study.restore(study.state());
  SolveOptions options;
  options.tolerance = study.tolerance();
  options.max_iterations = 40;
  options.assembled = true;
  Release out;
  out.solve = relaxation(study.equations(), options);
  PathStation end;
  end.state = study.state();
  end.y = VecX::Constant(1, point.lambda);
  end.s = point.s;
  out.end = judged_point(study, end, nullptr);
  out.moved = system.motion(end.state.unknowns, point.state.unknowns).norm();
  return out;
}

}  // namespace cprsim
