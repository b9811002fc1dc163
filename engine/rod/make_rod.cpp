// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/make_rod.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/math/so3.h"
#include "engine/rod/collocation.h"
#include "engine/rod/planar.h"
#include "engine/rod/shooting.h"
#include "engine/rod/strain_basis.h"

namespace cprsim {
namespace {

// Measured on the published Stewart-Gough robot (rods bent by about a radian): N cells of gauss6
// leave an error of 3.4e-8 L (6 / N)^6. An accuracy asked for gets ten times less; without one, 6
// cells. Other integrators are there to be compared with and get cells for about the same cost. The
// error depends on how far a cell turns: a rod wound up by `turn` > 1 rad gets as many times more.
int default_cells(ArcIntegrator integrator, const std::optional<double>& accuracy, double length,
                  double turn) {
  const double winding = std::max(1.0, turn);
  double cells = integrator == ArcIntegrator::kGauss6 ? 6 : 12;
  if (integrator == ArcIntegrator::kGauss6 && accuracy)
    cells = std::clamp(std::ceil(6 * std::pow(3.4e-7 * length / *accuracy, 1.0 / 6)), 3.0, 60.0);
  return static_cast<int>(std::clamp(std::ceil(cells * winding), 3.0, 600.0));
}

// Measured on the same robot: 8 elements of degree 2, 3, ... leave an error of kSplineError L, E
// elements (8 / E)^order of it, where order is p for even p and p + 1 for odd p.
constexpr double kSplineError[] = {2.4e-3, 4.5e-6, 7.2e-6, 4.5e-7, 1.5e-7, 2e-9, 3.3e-10};

int default_elements(int degree, const std::optional<double>& accuracy, double length,
                     double turn) {
  double elements = 4;
  if (accuracy) {
    const double error = kSplineError[degree - kLeastDegree] * length;
    const int order = degree + degree % 2;
    elements = std::clamp(std::ceil(8 * std::pow(10 * error / *accuracy, 1.0 / order)), 2.0, 200.0);
  }
  return static_cast<int>(std::clamp(std::ceil(elements * std::max(1.0, turn)), 2.0, 400.0));
}

ShootingOptions shooting_options(const RodPlan& plan) {
  ShootingOptions o;
  const double length = plan.spec->length;
  o.integrator = plan.solver->integrator.value_or(kDefaultIntegrator);
  o.cells = plan.solver->points.value_or(default_cells(o.integrator, plan.solver->accuracy, length,
                                                       length * plan.section.u_rest.norm()));
  o.extension = plan.extension;
  o.shear = plan.shear;
  o.rotary_inertia = plan.rotary_inertia;
  o.damping = plan.damping;
  o.stations = plan.stations;
  return o;
}

PlanarHold hold_of(const RodPlan& plan, const RodEndSpec& end, const Pose& X_WE) {
  const std::optional<PlanarHold> hold = planar_hold(end, X_WE.R.transpose() * plan.plane->col(2));
  if (!hold)
    throw std::invalid_argument("a joint of rod '" + plan.spec->name +
                                "' turns neither about the plane's normal nor across it");
  return *hold;
}

/// Section axes in a plane, up to a turn in it: those of the end that holds the rod's spin.
Mat3 spin_frame(const RodPlan& plan) {
  const bool by_tip = holds_spin(plan.spec->tip) && !holds_spin(plan.spec->base);
  return by_tip ? plan.X_WTip.R : plan.X_WBase.R;
}

/// The unloaded rod's beginning in a plane: spun like spin_frame(), tangent as at the base.
Pose section_frame(const RodPlan& plan) {
  const Mat3 R = spin_frame(plan);
  return {rotation_between(R.col(2), plan.X_WBase.R.col(2)) * R, plan.X_WBase.p};
}

std::unique_ptr<RodModel> make_shooting(const RodPlan& plan) {
  const RodSpec& spec = *plan.spec;
  if (plan.plane) {
    return std::make_unique<PlanarRod>(spec.name, hold_of(plan, spec.base, plan.X_WBase),
                                       hold_of(plan, spec.tip, plan.X_WTip), *plan.plane,
                                       plan.X_WBase, spin_frame(plan), plan.section, plan.length,
                                       shooting_options(plan));
  }
  auto model = std::make_unique<ShootingRod>(spec.name, RodEnd(spec.base), RodEnd(spec.tip),
                                             plan.section, plan.length, shooting_options(plan));
  model->set_unloaded(plan.X_WBase);
  return model;
}

std::unique_ptr<RodModel> make_strain(const RodPlan& plan) {
  const RodSpec& spec = *plan.spec;
  StrainOptions o;
  o.order = plan.solver->order.value_or(o.order);
  o.elements = plan.solver->elements.value_or(o.elements);
  o.extension = plan.extension;
  o.shear = plan.shear;
  o.rotary_inertia = plan.rotary_inertia;
  o.damping = plan.damping;
  o.stations = plan.stations;
  if (!plan.plane)
    return std::make_unique<StrainRod>(spec.name, EndCondition(spec.base), EndCondition(spec.tip),
                                       plan.plane, plan.X_WBase, plan.section, plan.length, o);
  const EndCondition base(hold_of(plan, spec.base, plan.X_WBase), *plan.plane),
      tip(hold_of(plan, spec.tip, plan.X_WTip), *plan.plane);
  return std::make_unique<StrainRod>(spec.name, base, tip, plan.plane, section_frame(plan),
                                     plan.section, plan.length, o);
}

std::unique_ptr<RodModel> make_collocation(const RodPlan& plan) {
  const RodSpec& spec = *plan.spec;
  CollocationOptions o;
  o.degree = plan.solver->degree.value_or(kDefaultDegree);
  o.elements = plan.solver->elements.value_or(default_elements(
      o.degree, plan.solver->accuracy, spec.length, spec.length * plan.section.u_rest.norm()));
  o.extension = plan.extension;
  o.shear = plan.shear;
  o.rotary_inertia = plan.rotary_inertia;
  o.damping = plan.damping;
  o.stations = plan.stations;
  if (!plan.plane)
    return std::make_unique<CollocationRod>(spec.name, EndCondition(spec.base),
                                            EndCondition(spec.tip), plan.plane, plan.X_WBase,
                                            plan.section, plan.length, o);
  const EndCondition base(hold_of(plan, spec.base, plan.X_WBase), *plan.plane),
      tip(hold_of(plan, spec.tip, plan.X_WTip), *plan.plane);
  return std::make_unique<CollocationRod>(spec.name, base, tip, plan.plane, section_frame(plan),
                                          plan.section, plan.length, o);
}

}  // namespace

MethodChoice choose_method(const RodSpec& rod, const SolverSpec& solver) {
  if (rod.method && *rod.method != Method::kAuto) return {*rod.method, "the rod asks for it"};
  if (!rod.method && solver.method != Method::kAuto)
    return {solver.method, "the solver asks for it"};
  return {Method::kShooting, "auto"};
}

std::unique_ptr<RodModel> make_rod(Method method, const RodPlan& plan) {
  switch (method) {
    case Method::kStrain:
      return make_strain(plan);
    case Method::kCollocation:
      return make_collocation(plan);
    case Method::kAuto:
    case Method::kShooting:
      break;
  }
  return make_shooting(plan);
}

}  // namespace cprsim
