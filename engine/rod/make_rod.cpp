// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/make_rod.h"

#include <stdexcept>

#include "engine/math/so3.h"
#include "engine/rod/collocation.h"
#include "engine/rod/fineness.h"
#include "engine/rod/planar.h"
#include "engine/rod/shooting.h"
#include "engine/rod/strain_basis.h"

namespace cprsim {
namespace {

ShootingOptions shooting_options(const RodPlan& plan) {
  const RodSpec& spec = *plan.spec;
  ShootingOptions o;
  o.integrator = plan.solver->integrator.value_or(kDefaultIntegrator);
  o.cells = shooting_cells(plan);
  o.extension = plan.extension;
  o.shear = plan.shear;
  o.rotary_inertia = plan.rotary_inertia;
  o.damping = plan.damping;
  o.drag = plan.drag;
  o.line_loads = plan.line_loads;
  if (plan.magnetic) o.magnets = spec.magnets;
  o.stations = plan.stations;
  o.tendons = plan.tendons;
  o.disks = spec.disks;
  o.along = plan.along;
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
  if (plan.plane)
    return std::make_unique<PlanarRod>(spec.name, hold_of(plan, spec.base, plan.X_WBase),
                                       hold_of(plan, spec.tip, plan.X_WTip), *plan.plane,
                                       plan.X_WBase, spin_frame(plan), plan.section, plan.length,
                                       shooting_options(plan));
  auto model = std::make_unique<ShootingRod>(spec.name, RodEnd(spec.base), RodEnd(spec.tip),
                                             plan.section, plan.length, shooting_options(plan));
  model->set_unloaded(plan.X_WBase);
  return model;
}

std::unique_ptr<RodModel> make_strain(const RodPlan& plan) {
  const RodSpec& spec = *plan.spec;
  StrainOptions o;
  o.order = strain_order(plan);
  o.elements = strain_elements(plan);
  o.extension = plan.extension;
  o.shear = plan.shear;
  o.rotary_inertia = plan.rotary_inertia;
  o.damping = plan.damping;
  o.drag = plan.drag;
  o.line_loads = plan.line_loads;
  if (plan.magnetic) o.magnets = spec.magnets;
  o.touches = plan.touches || plan.tied;
  o.stations = plan.stations;
  o.tendons = plan.tendons;
  o.disks = spec.disks;
  o.along = plan.along;
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
  o.degree = collocation_degree(plan);
  o.elements = collocation_elements(plan);
  o.weights = plan.solver->weights;
  o.extension = plan.extension;
  o.shear = plan.shear;
  o.rotary_inertia = plan.rotary_inertia;
  o.damping = plan.damping;
  o.drag = plan.drag;
  o.line_loads = plan.line_loads;
  if (plan.magnetic) o.magnets = spec.magnets;
  o.touches = plan.touches;
  o.tied = plan.tied;
  o.stations = plan.stations;
  o.tendons = plan.tendons;
  o.disks = spec.disks;
  o.along = plan.along;
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
