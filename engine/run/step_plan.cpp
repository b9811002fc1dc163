// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "engine/run/facts.h"

namespace cprsim {
namespace {

bool embedded(SchemeKind kind) {
  return kind == SchemeKind::kTrBdf2 || kind == SchemeKind::kEsdirk32 ||
         kind == SchemeKind::kEsdirk43;
}

}  // namespace

StepPlan plan_steps(const Scene& scene) {
  StepPlan plan;
  const SolverSpec& spec = scene.solver;
  plan.scheme.kind = spec.scheme.value_or(SchemeKind::kEsdirk32);
  plan.scheme.alpha = spec.alpha.value_or(-0.4);
  plan.scheme.rho_inf = spec.rho_inf.value_or(0.8);
  plan.adaptive = embedded(plan.scheme.kind) && !spec.step;
  plan.step = spec.step.value_or(scene.max_step_size);
  if (!plan.adaptive) return plan;
  plan.tolerance = spec.tolerance.value_or(1e-5);
  if (spec.accuracy && !spec.tolerance) {
    double length = 0;
    for (const RodSpec& rod : scene.rods)
      length = std::max(length, rod.length);
    // local errors add up: a tenth of what is asked for
    plan.tolerance = 0.1 * *spec.accuracy / (length > 0 ? length : 1);
  }
  return plan;
}

}  // namespace cprsim
