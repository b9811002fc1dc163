// SPDX-License-Identifier: BSD-3-Clause
// Accuracy against time: the released rod solved by every scheme at many steps, tolerances and
// numbers of cells, each compared with one fine solution.
//   cprsim_work_precision FOLDER           the whole study (minutes)
//   cprsim_work_precision --quick FOLDER   a few settings, to see that it works
//   gnuplot tests/bench/work_precision.gp  the picture, from the table in docs/accuracy
// The error is the largest distance of the tip from the reference over the second, once at the ends
// of steps and once between them. Time is that of the process, on one core, all told.
#include "tests/bench/work_precision.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <limits>

#include "tests/support/released_rod.h"

namespace cprsim {
namespace {

/// Snapshots that hold the tip and nothing else.
using Trajectory = std::vector<Snapshot>;

Snapshot tip_of(const Snapshot& whole) {
  Snapshot snapshot;
  snapshot.time = whole.time;
  snapshot.rods.resize(1);
  snapshot.rods[0].points.push_back(whole.rods[0].points.back());
  return snapshot;
}

const Vec3& position(const Snapshot& tip) {
  return tip.rods[0].points[0].position;
}

Vec3 position_at(const Trajectory& trajectory, double t) {
  auto after = std::lower_bound(trajectory.begin() + 1, trajectory.end(), t,
                                [](const Snapshot& s, double at) { return s.time < at; });
  if (after == trajectory.end()) --after;
  return position(interpolate(*(after - 1), *after, t));
}

/// Runs the second once.
Trajectory run(const Setting& setting, std::optional<double> residual, Outcome& out) {
  const std::clock_t begin = std::clock();
  Scene scene = released_rod_scene();
  scene.solver.scheme = setting.scheme;
  scene.solver.alpha = setting.alpha;
  scene.solver.points = setting.cells;
  scene.solver.residual_tolerance = residual;
  if (setting.step > 0)
    scene.solver.step = setting.step;
  else
    scene.solver.tolerance = setting.tolerance;
  Simulation simulation(scene);
  simulation.start();
  Trajectory tips{tip_of(simulation.now())};
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    tips.push_back(tip_of(simulation.now()));
  }
  out.cpu_seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const RunStatistics& statistics = simulation.statistics();
  out.steps = statistics.steps;
  out.retried = statistics.retried + statistics.rejected;
  out.iterations = statistics.iterations;
  out.section_evaluations = statistics.section_evaluations;
  out.failure = simulation.failure();
  return tips;
}

double error_at_steps(const Trajectory& tips, const Trajectory& reference, double from = 0) {
  double error = 0;
  for (const Snapshot& tip : tips)
    if (tip.time >= from)
      error = std::max(error, (position(tip) - position_at(reference, tip.time)).norm());
  return error;
}

double error_between_steps(const Trajectory& tips, const Trajectory& reference) {
  double error = 0;
  for (int k = 0; k < 2000; ++k) {
    const double t = (k + 0.5) / 2000;
    error = std::max(error, (position_at(tips, t) - position_at(reference, t)).norm());
  }
  return error;
}

Outcome measure(const Setting& setting, const Trajectory& reference) {
  constexpr int kRepetitions = 3;
  constexpr double kLong = 2;  // s: beyond, once is enough
  Outcome out;
  out.setting = setting;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kRepetitions && (i == 0 || best < kLong); ++i) {
    const Trajectory tips = run(setting, {}, out);
    best = std::min(best, out.cpu_seconds);
    if (i > 0) continue;
    out.error = error_at_steps(tips, reference);
    out.error_later = error_at_steps(tips, reference, 0.05);
    out.error_between = error_between_steps(tips, reference);
  }
  out.cpu_seconds = best;
  std::printf(
      "%-22s %2d cells  step %-6g tolerance %-6g  error/L %.2e (between %.2e)  %.4f s  %s\n",
      setting.scheme_name().c_str(), setting.cells, setting.step, setting.tolerance,
      out.error / 0.4, out.error_between / 0.4, out.cpu_seconds, out.failure.c_str());
  std::fflush(stdout);
  return out;
}

std::vector<Setting> schemes() {
  std::vector<Setting> all;
  for (const SchemeKind kind :
       {SchemeKind::kBackwardEuler, SchemeKind::kBdf2, SchemeKind::kBdfAlpha, SchemeKind::kBdfAlpha,
        SchemeKind::kGeneralizedAlpha, SchemeKind::kTrBdf2, SchemeKind::kEsdirk32,
        SchemeKind::kEsdirk43, SchemeKind::kRadau5}) {
    Setting setting;
    setting.scheme = kind;
    if (kind == SchemeKind::kBdfAlpha && all.back().scheme == kind) setting.alpha = -0.2;
    all.push_back(setting);
  }
  return all;
}

bool embedded(SchemeKind kind) {
  return kind == SchemeKind::kTrBdf2 || kind == SchemeKind::kEsdirk32 ||
         kind == SchemeKind::kEsdirk43;
}

std::vector<Setting> settings(bool quick) {
  const std::vector<int> cells = quick ? std::vector<int>{3} : std::vector<int>{3, 6, 12};
  const std::vector<double> steps =
      quick ? std::vector<double>{1e-2, 5e-3}
            : std::vector<double>{1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4};
  const std::vector<double> tolerances =
      quick ? std::vector<double>{1e-3}
            : std::vector<double>{1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8};
  std::vector<Setting> all;
  for (Setting setting : schemes()) {
    for (const int n : cells) {
      setting.cells = n;
      for (const double step : steps) {
        all.push_back(setting);
        all.back().step = step;
      }
      for (const double tolerance : tolerances) {
        if (!embedded(setting.scheme)) continue;
        all.push_back(setting);
        all.back().tolerance = tolerance;
      }
    }
    // down to the smallest steps, where classic shooting has long failed
    setting.cells = 6;
    if (quick) continue;
    all.push_back(setting);
    all.back().step = 1e-5;
    if (setting.scheme != SchemeKind::kGeneralizedAlpha) continue;
    all.push_back(setting);
    all.back().step = 1e-6;
  }
  return all;
}

// Adaptive, because the first instants after the release need steps a thousand times smaller than
// the rest.
Trajectory make_reference(bool quick, ReferenceFacts& facts) {
  constexpr double kResidual = 1e-12;
  Setting setting;
  setting.scheme = SchemeKind::kEsdirk43;
  setting.tolerance = facts.tolerance = quick ? 1e-8 : 1e-10;
  setting.cells = facts.cells = quick ? 6 : 12;
  Outcome out;
  const Trajectory reference = run(setting, kResidual, out);
  facts.to_independent_tip = (position(reference.back()) - kReleasedTipAfterOneSecond).norm();
  Setting coarser = setting, fewer = setting;
  coarser.tolerance = facts.coarser_tolerance = 10 * facts.tolerance;
  fewer.cells = facts.fewer_cells = facts.cells / 2;
  facts.to_coarser_tolerance = error_at_steps(run(coarser, kResidual, out), reference);
  facts.to_fewer_cells = error_at_steps(run(fewer, kResidual, out), reference);
  std::printf(
      "reference: %.2e m from the independent tip, %.2e from tolerance %g, %.2e from %d cells\n",
      facts.to_independent_tip, facts.to_coarser_tolerance, facts.coarser_tolerance,
      facts.to_fewer_cells, facts.fewer_cells);
  return reference;
}

}  // namespace

std::string Setting::scheme_name() const {
  std::string name = to_string(scheme);
  if (scheme == SchemeKind::kBdfAlpha) name += alpha == -0.4 ? "(-0.4)" : "(-0.2)";
  if (scheme == SchemeKind::kGeneralizedAlpha) name += "(0.8)";
  return name;
}

}  // namespace cprsim

int main(int argc, char** argv) {
  using namespace cprsim;
  const bool quick = argc == 3 && std::string(argv[1]) == "--quick";
  if (!quick && argc != 2) {
    std::fprintf(stderr, "usage: cprsim_work_precision [--quick] FOLDER\n");
    return 2;
  }
  try {
    Study study;
    const Trajectory reference = make_reference(quick, study.reference);
    bool failed = study.reference.to_independent_tip > 1e-6;
    for (const Setting& setting : settings(quick)) {
      study.outcomes.push_back(measure(setting, reference));
      failed = failed || !study.outcomes.back().failure.empty();
    }
    write_study(study, argv[argc - 1]);
    return failed ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
