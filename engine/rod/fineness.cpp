// SPDX-License-Identifier: BSD-3-Clause
// Errors were measured on the published Stewart-Gough robot, whose rods bend by about a radian
// (docs/methods.md); an accuracy asked for gets ten times less.
#include "engine/rod/fineness.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/rod/collocation.h"
#include "engine/rod/tableau.h"

namespace cprsim {
namespace {

/// Radians that the unloaded rod is wound up by.
double turn_of(const RodPlan& plan) {
  if (plan.along) return plan.along->turn(plan.spec->length);
  return plan.spec->length * plan.section.u_rest.norm();
}

/// Of the pieces between stations, a fraction of the length.
double longest_span(std::vector<double> stations) {
  stations.insert(stations.end(), {0, 1});
  std::sort(stations.begin(), stations.end());
  double longest = 0;
  for (std::size_t i = 1; i < stations.size(); ++i)
    longest = std::max(longest, stations[i] - stations[i - 1]);
  return longest;
}

// Spline collocation: 8 elements of degree 2, 3, ... leave an error of kSplineError L, E elements
// (8 / E)^order of it, where order is p for even p and p + 1 for odd p.
constexpr double kSplineError[] = {2.4e-3, 4.5e-6, 7.2e-6, 4.5e-7, 1.5e-7, 2e-9, 3.3e-10};

// Strain basis: on a rod bent by a radian or two degree N leaves less than 10^-(N + 1.5) of the
// length, and one element follows about four radians of winding as well. A degree for every power
// of ten: ten times less error asked for must not be the same rod again.
constexpr double kFirstDigits = 1.5, kTurnPerElement = 4;

// Contact is where elements meet: they must be short against what is touched, not of high degree.
constexpr int kTouchingElements = 20, kTouchingOrder = 3, kTouchingDegree = 4;

// w L³ / EI from which shooting was seen to find other equilibria, or none (S11 in
// docs/reference_cases.md)
constexpr double kLimp = 1000;

Method fitting_method(const RodPlan& plan, std::string& why) {
  const SolverSpec& solver = *plan.solver;
  if (solver.points || solver.integrator) {
    why = "auto: <space> is shooting's";
    return Method::kShooting;
  }
  const bool splines = solver.basis == Basis::kBspline || solver.basis == Basis::kNurbs;
  if (solver.order || (solver.basis && !splines)) {
    why = "auto: <space> is the strain basis's";
    return Method::kStrain;
  }
  if (solver.degree || splines) {
    why = "auto: <space> is collocation's";
    return Method::kCollocation;
  }
  if (plan.limpness > kLimp && !plan.touches) {
    why = "auto: it hangs like a cable, to which shooting does not find its way";
    return Method::kStrain;
  }
  why = "auto: shooting takes the least time for its accuracy (docs/methods.md)";
  return Method::kShooting;
}

bool fineness_given(Method method, const SolverSpec& solver) {
  if (method == Method::kShooting) return solver.points.has_value();
  if (method == Method::kStrain) return solver.order.has_value();
  return solver.elements.has_value();
}

}  // namespace

// N cells of gauss6 leave an error of 3.4e-8 L (6 / N)^6; without an accuracy there are 6. Other
// integrators are there to be compared with and get cells for about the same cost. The error
// depends on how far a cell turns: a rod wound up by `turn` > 1 rad gets as many times more.
// Between its ties a rod bends like one of that length.
int shooting_cells(const RodPlan& plan) {
  if (plan.spec->cut) return plan.spec->cut->elements;
  const SolverSpec& solver = *plan.solver;
  if (solver.points) return *solver.points;
  const bool best = solver.integrator.value_or(kDefaultIntegrator) == ArcIntegrator::kGauss6;
  const double span = plan.tied ? longest_span(plan.stations) : 1;
  double cells = (best ? 6 : 12) * std::sqrt(span);
  const bool asked = best && solver.accuracy;
  if (asked) cells = 6 * std::pow(3.4e-7 * span * plan.spec->length / *solver.accuracy, 1.0 / 6);
  // an accuracy that is asked for is checked: one cell may do
  const double least = asked ? 1 : 3;
  cells = std::clamp(std::ceil(cells), plan.tied ? std::min(2.0, least) : least, 60.0) / span;
  return static_cast<int>(
      std::clamp(std::ceil(cells * std::max(1.0, turn_of(plan))), least, 600.0));
}

int strain_order(const RodPlan& plan) {
  if (plan.spec->cut) return plan.spec->cut->order;
  const SolverSpec& solver = *plan.solver;
  if (solver.order) return *solver.order;
  if (!solver.accuracy) return plan.touches ? kTouchingOrder : 6;
  const double digits = std::log10(10 * plan.spec->length / *solver.accuracy);
  return static_cast<int>(std::clamp(std::ceil(digits - kFirstDigits), 3.0, 16.0));
}

int strain_elements(const RodPlan& plan) {
  if (plan.spec->cut) return plan.spec->cut->elements;
  const int wound = static_cast<int>(std::min(std::ceil(turn_of(plan) / kTurnPerElement), 100.0));
  return plan.solver->elements.value_or(std::max(plan.touches ? kTouchingElements : 1, wound));
}

int collocation_degree(const RodPlan& plan) {
  return plan.solver->degree.value_or(plan.touches ? kTouchingDegree : kDefaultDegree);
}

int collocation_elements(const RodPlan& plan) {
  if (plan.spec->cut) return plan.spec->cut->elements;
  const SolverSpec& solver = *plan.solver;
  if (solver.elements) return *solver.elements;
  const int degree = collocation_degree(plan);
  double elements = 4;
  if (solver.accuracy) {
    const double error = kSplineError[degree - kLeastDegree] * plan.spec->length;
    const int order = degree + degree % 2;
    elements =
        std::clamp(std::ceil(8 * std::pow(10 * error / *solver.accuracy, 1.0 / order)), 2.0, 200.0);
  }
  if (plan.touches) elements = std::max<double>(elements, kTouchingElements);
  return static_cast<int>(
      std::clamp(std::ceil(elements * std::max(1.0, turn_of(plan))), 2.0, 400.0));
}

MethodChoice choose_method(const RodPlan& plan) {
  const RodSpec& rod = *plan.spec;
  const SolverSpec& solver = *plan.solver;
  MethodChoice choice;
  if (rod.method.value_or(solver.method) == Method::kAuto)
    choice.method = fitting_method(plan, choice.why);
  else
    choice = {rod.method.value_or(solver.method),
              rod.method ? "the rod asks for it" : "the solver asks for it"};
  std::ostringstream why;
  why << choice.why << "; cut ";
  if (fineness_given(choice.method, solver))
    why << "as the scene says";
  else if (solver.accuracy)
    why << "for " << *solver.accuracy << " m";
  else
    why << "as usual";
  const bool wound =
      choice.method == Method::kStrain ? turn_of(plan) > kTurnPerElement : turn_of(plan) > 1;
  if (wound && !fineness_given(choice.method, solver)) why << ", more for its rest shape";
  choice.why = why.str();
  return choice;
}

}  // namespace cprsim
