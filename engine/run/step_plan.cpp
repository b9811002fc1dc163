// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "engine/run/facts.h"

namespace cprsim {
namespace {

/// Where a scene does not say: below this error, over the rod's length, the fourth order is the
/// cheaper one (docs/accuracy.md).
SchemeKind scheme_for(const Scene& scene) {
  constexpr double kFine = 3e-5;
  const auto& accuracy = scene.solver.accuracy;
  return accuracy && *accuracy < kFine * longest_rod(scene) ? SchemeKind::kEsdirk43
                                                            : SchemeKind::kEsdirk32;
}

constexpr double kHighestOrder = 4;  // of what is taken where an accuracy is asked for

}  // namespace

StepPlan plan_steps(const Scene& scene) {
  StepPlan plan;
  const SolverSpec& spec = scene.solver;
  plan.scheme.kind = spec.scheme.value_or(scheme_for(scene));
  plan.scheme.alpha = spec.alpha.value_or(-0.4);
  plan.scheme.rho_inf = spec.rho_inf.value_or(0.8);
  plan.adaptive = adapts(plan.scheme.kind) && !spec.step;
  plan.step = spec.step.value_or(scene.max_step_size);
  if (!plan.adaptive) return plan;
  plan.tolerance = spec.tolerance.value_or(1e-5);
  if (spec.accuracy && !spec.tolerance) {
    // local errors add up: a tenth of what is asked for
    plan.tolerance = 0.1 * *spec.accuracy / longest_rod(scene);
    plan.longest = scene.simulation.duration * std::pow(plan.tolerance, 1 / kHighestOrder);
  }
  return plan;
}

std::vector<double> break_times(const Scene& scene, double end) {
  std::vector<double> breaks{end};
  const auto take = [&](const Profile& profile) {
    for (const double b : profile.breakpoints(end))
      breaks.push_back(b);
  };
  for (const DriveSpec& drive : scene.drives)
    take(drive.profile);
  for (const LoadSpec& load : scene.loads)
    if (load.has_profile) take(load.profile);
  for (const MagneticFieldSpec& field : scene.magnetic_fields)
    if (field.has_profile) take(field.profile);
  for (const RodSpec& rod : scene.rods)
    if (rod.temperature && rod.temperature->has_profile) take(rod.temperature->profile);
  std::sort(breaks.begin(), breaks.end());
  return breaks;
}

// PI control (Söderlind, ACM TOMS 29, 2003) with the usual limits.
double controlled_step(const StepPlan& plan, double step, double error, double last_error,
                       int order) {
  const double k = order;
  const double now_ratio = plan.tolerance / std::max(error, 1e-14);
  const double old_ratio =
      last_error > 0 ? plan.tolerance / std::max(last_error, 1e-14) : now_ratio;
  const double factor = 0.9 * std::pow(now_ratio, 0.7 / k) * std::pow(old_ratio, -0.4 / k) *
                        std::pow(now_ratio, 0.3 / k);
  return std::min(plan.longest, step * std::clamp(factor, 0.2, 4.0));
}

void visit(RunStatistics& s, Archive& archive) {
  for (long* x : {&s.steps, &s.rejected, &s.retried, &s.iterations, &s.max_iterations,
                  &s.start_iterations, &s.section_evaluations, &s.factorizations})
    archive(*x);
  for (double* x : {&s.worst_residual, &s.smallest_step, &s.largest_step})
    archive(*x);
}

SolveOptions static_options(const SolverSpec& spec) {
  SolveOptions options;
  options.tolerance = spec.residual_tolerance.value_or(options.tolerance);
  options.max_iterations = std::max(40, spec.max_iterations.value_or(0));
  return options;
}

SolveOptions step_options(const SolverSpec& spec) {
  SolveOptions options;
  options.tolerance = spec.residual_tolerance.value_or(options.tolerance);
  options.max_iterations = spec.max_iterations.value_or(15);
  options.polish = true;
  return options;
}

}  // namespace cprsim
