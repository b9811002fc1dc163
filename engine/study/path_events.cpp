// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/path_events.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace cprsim {
namespace {

constexpr int kHalvings = 12;    // of a step in which several things happen
constexpr double kApart = 1e-6;  // of arclength
constexpr int kFailures = 6;
constexpr int kSearch = 40;         // evaluations of a root's search
constexpr double kExact = 1e-10;    // of arclength, in steps
constexpr double kSingular = 1e-6;  // likewise: as near as this a root may be too singular to solve

/// Of lambda along the path.
double slope(const PathStation& at) {
  return at.tangent.y[at.tangent.y.size() - 1];
}

class Search {
 public:
  explicit Search(PathSystem& system) : system_(system) {}

  void between(const PathStation& a, const PathStation& b, int depth) {
    const int change = std::abs(b.unstable - a.unstable);
    const bool turns = slope(a) * slope(b) < 0;
    if (change == 0 && !turns) return;
    const bool simple = system_.problem().free_drives ? change + (turns ? 1 : 0) == 1 : change == 1;
    PathStation middle;
    if (!simple && depth < kHalvings && system_.advance(a, 0.5 * (b.s - a.s), middle)) {
      judged_point(system_.study(), middle, &a);
      between(a, middle, depth + 1);
      between(middle, b, depth + 1);
      return;
    }
    PathEvent event;
    event.kind = turns                           ? PathEventKind::kFold
                 : system_.problem().free_drives ? PathEventKind::kStability
                                                 : PathEventKind::kBranchPoint;
    event.before = a.unstable;
    event.after = b.unstable;
    const Eigen::Index which = std::min(a.unstable, b.unstable);
    event.station = root(a, b, [&](const PathStation& at) {
      return turns ? slope(at) : which < at.stiffnesses.size() ? at.stiffnesses[which] : 0.0;
    });
    describe(event);
    found.push_back(std::move(event));
  }

  std::vector<PathEvent> found;

 private:
  /// Where value() is zero. Regula falsi, Illinois variant, in arclength from a. It ends where the
  /// points beside the root cannot be told apart, or where the linear system is singular to
  /// round-off: the root itself.
  template <typename Value>
  PathStation root(const PathStation& a, const PathStation& b, const Value& value) {
    const double step = system_.distance(a, b);
    double low = 0, high = step, f_low = value(a), f_high = value(b);
    std::vector<PathStation> known{a, b};
    // a stiffness that was none may have passed zero before a
    for (int i = 0; i < 4 && f_low * f_high > 0; ++i) {
      low -= step;
      PathStation at;
      if (!system_.advance(a, low, at)) return a;
      judged_point(system_.study(), at, &a);
      f_low = value(at);
      known.push_back(at);
    }
    if (f_low * f_high > 0) return a;
    double last = -1;
    int side = 0, failures = 0;
    bool halve = true;  // first a third point to interpolate from
    for (int i = 0; i < kSearch && high - low > kExact * step; ++i) {
      double sigma = (low * f_high - high * f_low) / (f_high - f_low);
      if (halve || !(sigma > low && sigma < high)) sigma = 0.5 * (low + high);
      if (std::abs(sigma - last) < kExact * step) break;
      last = sigma;
      halve = false;
      PathStation at;
      const std::vector<const PathStation*> near = nearest(a, sigma, known);
      if (!system_.interpolate(a, sigma, near, at)) {
        if (std::abs(system_.distance(a, *near.front()) - sigma) < kSingular * step) break;
        if (++failures > kFailures) break;
        halve = true;
        continue;
      }
      judged_point(system_.study(), at, &a);
      const double f = value(at);
      known.push_back(std::move(at));
      if (f == 0) break;
      const int now = (f < 0) == (f_low < 0) ? -1 : 1;
      (now < 0 ? low : high) = sigma;
      (now < 0 ? f_low : f_high) = f;
      // the end that stays twice counts half (Illinois)
      if (now == side) (now < 0 ? f_high : f_low) *= 0.5;
      side = now;
    }
    return *std::min_element(known.begin(), known.end(), [&](const auto& one, const auto& other) {
      return std::abs(value(one)) < std::abs(value(other));
    });
  }

  /// At most four, none of which is so close to another that their difference is noise.
  std::vector<const PathStation*> nearest(const PathStation& a, double sigma,
                                          const std::vector<PathStation>& known) const {
    std::vector<std::pair<double, const PathStation*>> sorted;
    for (const PathStation& one : known)
      sorted.emplace_back(std::abs(system_.distance(a, one) - sigma), &one);
    std::sort(sorted.begin(), sorted.end());
    std::vector<const PathStation*> chosen;
    for (const auto& each : sorted) {
      const PathStation* one = each.second;
      const bool apart = std::all_of(chosen.begin(), chosen.end(), [&](const PathStation* other) {
        return std::abs(system_.distance(*other, *one)) > kApart;
      });
      if (apart && chosen.size() < 4) chosen.push_back(one);
    }
    return chosen;
  }

  void describe(PathEvent& event) {
    event.point = judged_point(system_.study(), event.station, nullptr);
    system_.study().restore(event.station.state);
    if (!critical_motion(system_, kCriticalMotion, event.direction, event.displaced)) {
      // no direction: branches and releases that ask for it find nothing, and say so
      event.direction.u.setZero();
      event.displaced = event.station.state;
      return;
    }
    for (Eigen::Index b = 0; b < static_cast<Eigen::Index>(system_.study().robot().bodies.size());
         ++b) {
      Vec6 motion = event.direction.u.segment<6>(6 * b);
      motion.tail<3>() *= system_.study().robot().scale.length;
      event.bodies.push_back(motion);
    }
    system_.study().restore(event.station.state);
  }

  PathSystem& system_;
};

/// Every rod bent and every body moved a little, without any symmetry.
void shake(StaticStudy& study, double amount) {
  std::mt19937 random(1);
  const auto uniform = [&] { return 2 * (static_cast<double>(random()) / 4294967296.0) - 1; };
  RobotUnknowns x = study.equations().unknowns();
  for (std::size_t r = 0; r < x.rods.size(); ++r)
    for (double& value : x.rods[r].values)
      value += amount / study.robot().rods[r].length * uniform();
  for (Pose& X : x.bodies)
    for (int c = 0; c < 3; ++c)
      X.p[c] += amount * study.robot().scale.length * uniform();
  study.equations().set_unknowns(x);
  study.equations().evaluate();
}

}  // namespace

PathPoint judged_point(StaticStudy& study, PathStation& at, const PathStation* before) {
  study.restore(at.state);
  const Stability judged = judge(study);
  at.stiffnesses = judged.stiffnesses;
  const double nothing = no_stiffness(study);
  int negative = 0, none = 0;
  for (const double value : at.stiffnesses) {
    negative += value < -nothing ? 1 : 0;
    none += std::abs(value) <= nothing ? 1 : 0;
  }
  at.unstable = std::clamp(before != nullptr ? before->unstable : 0, negative, negative + none);
  return {at.state, at.lambda(), at.s, judged.verdict, judged.unstable, judged.softest};
}

bool critical_motion(PathSystem& system, double amount, PathDirection& direction,
                     StaticStudy::State& displaced) {
  // springs of this fraction of the robot's own stiffness; motions stiffer than that are filtered
  // out by the ratio, once in every pass
  constexpr double kSpring = 1e-3;
  constexpr double kSmall = 1e-4;
  constexpr int kPasses = 6;
  StaticStudy& study = system.study();
  Equations& equations = study.equations();
  const StaticStudy::State here = study.state();
  direction = system.forward();
  direction.y.setZero();
  shake(study, kSmall);
  for (int pass = 0; pass < kPasses; ++pass) {
    equations.set_relaxation(kSpring);  // rest where the shape now is
    equations.set_unknowns(here.unknowns);
    equations.evaluate();
    const bool found = equations.find_direction(0);
    equations.set_relaxation(0);
    equations.keep();
    if (found) equations.move(1);
    equations.evaluate();
    const double size = system.motion(equations.unknowns(), here.unknowns).norm();
    if (!found || !(size > 0)) {
      study.restore(here);
      return false;
    }
    equations.move((pass + 1 < kPasses ? kSmall : amount) / size);
    equations.evaluate();
  }
  displaced = study.state();
  direction.u = system.motion(displaced.unknowns, here.unknowns);
  direction.u /= direction.u.norm();
  study.restore(here);
  return true;
}

std::vector<PathEvent> events_between(PathSystem& system, const PathStation& from,
                                      const PathStation& to) {
  Search search(system);
  search.between(from, to, 0);
  return std::move(search.found);
}

}  // namespace cprsim
