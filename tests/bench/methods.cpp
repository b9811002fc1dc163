// SPDX-License-Identifier: BSD-3-Clause
// What every discretisation of a rod makes of the same scenes: error, unknowns, iterations, time.
// Writes FOLDER/methods.md.
//   cprsim_methods [--quick] FOLDER
#include "tests/support/methods.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "tests/support/elastica.h"
#include "tests/support/released_rod.h"

namespace cprsim {
namespace {

struct Fineness {
  Method method;
  int pieces, order;
};

constexpr Fineness kShown[] = {
    {Method::kShooting, 3, 6},     {Method::kShooting, 6, 6},     {Method::kShooting, 12, 6},
    {Method::kShooting, 24, 6},    {Method::kStrain, 1, 3},       {Method::kStrain, 1, 4},
    {Method::kStrain, 1, 5},       {Method::kStrain, 1, 6},       {Method::kStrain, 1, 8},
    {Method::kStrain, 2, 8},       {Method::kStrain, 6, 6},       {Method::kCollocation, 4, 5},
    {Method::kCollocation, 4, 7},  {Method::kCollocation, 8, 7},  {Method::kCollocation, 32, 3},
    {Method::kCollocation, 16, 7}, {Method::kCollocation, 48, 7},
};

Scene cut(Scene scene, const Fineness& f) {
  SolverSpec& solver = scene.solver;
  solver.method = f.method;
  solver.points = f.pieces;
  solver.elements = f.pieces;
  solver.order = f.order;
  solver.degree = f.order;
  return scene;
}

struct Outcome {
  Vec3 point = Vec3::Zero();
  int iterations = 0, unknowns = 0;
  bool converged = false;
};

struct Case {
  const char* title;
  const char* about;
  Scene scene;
  std::function<Outcome(const Scene&)> solve;
  Vec3 exact;
  double length;
};

Outcome tip_at_rest(const Scene& scene) {
  const Equilibrium found(scene, 1e-11);
  return {found.rod().points.back().position, found.report.iterations,
          found.robot.rods[0].model->unknown_count(), found.report.converged()};
}

Outcome body_at_rest(const Scene& scene) {
  const Equilibrium found(scene, 1e-11);
  return {found.robot.bodies.back().p, found.report.iterations,
          found.robot.rods[0].model->unknown_count(), found.report.converged()};
}

Outcome tip_in_motion(const Scene& scene) {
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  return {end.rods[0].points.back().position, static_cast<int>(simulation.statistics().iterations),
          simulation.facts().rods[0].unknowns, simulation.status() == RunStatus::kDone};
}

/// As found by shooting with 60 cells, unless `exact` is known.
void add(std::vector<Case>& cases, const Case& one, bool known = false) {
  cases.push_back(one);
  if (!known) cases.back().exact = one.solve(cut(one.scene, {Method::kShooting, 60, 6})).point;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  Scene elastica;
  elastica.rods.push_back(steel_rod(0.4, 1e-3));
  add_load(elastica, 1, {5 * bending_stiffness(elastica.rods[0]) / 0.16, 0, 0});
  const Elastica exact = solve_elastica(5);
  add(cases,
      {"A cantilever under a tip force, P L²/EI = 5", "Exact: elliptic integrals.", elastica,
       tip_at_rest, 0.4 * Vec3(exact.x, 0, exact.z), 0.4},
      true);
  Scene inside = elastica;
  inside.loads[0].rod_s = 0.37;
  add(cases, {"The same force at s = 0.37 L", "Elements end at the load.", inside, tip_at_rest,
              Vec3::Zero(), 0.4});
  add(cases, {"The published Stewart-Gough robot",
              "Six rods with extension and shear, from straight legs; error of the plate.",
              stewart_gough({0.3973263874, 0.3973263874, 0.3997201023, 0.4216240113, 0.4216240113,
                             0.3997201023},
                            false),
              body_at_rest, Vec3::Zero(), 0.4});
  Scene helix;
  helix.rods.push_back(steel_rod(0.8, 1e-3));
  helix.rods[0].rest_curvature = {0, 24, 18};
  switch_on(helix, {Effect::kGravity});
  helix.gravity = {-9.81, 3, 0};
  add(cases, {"A helix of four turns under its weight", "24 rad of rest curvature and twist.",
              helix, tip_at_rest, Vec3::Zero(), 0.8});
  Scene released = released_rod_scene();
  released.solver.scheme = SchemeKind::kEsdirk32;
  released.solver.step = 2e-3;
  released.simulation.duration = 0.1;
  add(cases, {"The released rod, 0.1 s in 50 steps of esdirk32",
              "Every effect; error in arc length alone, the steps are the same.", released,
              tip_in_motion, Vec3::Zero(), 0.4});
  return cases;
}

std::string row(const Case& one, const Fineness& f, int repetitions) {
  const Scene scene = cut(one.scene, f);
  Outcome found;
  double least = 1e9;
  for (int i = 0; i < repetitions; ++i) {
    const auto start = std::chrono::steady_clock::now();
    found = one.solve(scene);
    least = std::min(
        least, std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
                   .count());
  }
  char text[200];
  if (found.converged)
    std::snprintf(text, sizeof text, "| %s | %d | %d | %d | %.1e | %d | %.0f |\n",
                  method_name(f.method), f.pieces, f.order, found.unknowns,
                  (found.point - one.exact).norm() / one.length, found.iterations, least);
  else
    std::snprintf(text, sizeof text, "| %s | %d | %d | %d | not found | | |\n",
                  method_name(f.method), f.pieces, f.order, found.unknowns);
  return text;
}

double tip_error(const Scene& scene, const Vec3& exact) {
  return (tip_at_rest(scene).point - exact).norm() / 0.4;
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", x);
  return text;
}

/// log2 of what twice as many pieces gain; nothing where round-off is all that is left.
std::string order_of(double coarse, double fine) {
  if (fine < 1e-11) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", std::log2(coarse / fine));
  return text;
}

/// Errors of the cantilever for three numbers of pieces, and the orders they show.
void add_orders(std::ostream& page, const std::string& name, const Scene& scene, const Vec3& exact,
                std::initializer_list<int> pieces) {
  page << "| " << name << " |";
  double before = 0;
  for (const int n : pieces) {
    Scene one = scene;
    one.solver.points = n;
    one.solver.elements = n;
    const double error = tip_error(one, exact);
    page << ' ' << n << ": " << number(error);
    if (before > 0) page << " | " << order_of(before, error);
    page << " |";
    before = error;
  }
  page << "\n";
}

void write_orders(std::ostream& page, const Case& elastica) {
  page << "\n## Orders\n\nThe first of these cantilevers. Each doubling of the pieces, and the "
          "order that the error shows in it; the strain basis has one element, of which the order "
          "grows instead.\n\n| shooting | cells: error | | order | | order |\n"
          "|---|---|---|---|---|---|\n";
  const std::pair<const char*, ArcIntegrator> rules[] = {{"euler", ArcIntegrator::kEuler},
                                                         {"gauss2", ArcIntegrator::kGauss2},
                                                         {"rk4", ArcIntegrator::kRk4},
                                                         {"gauss4", ArcIntegrator::kGauss4},
                                                         {"gauss6", ArcIntegrator::kGauss6}};
  for (const auto& [name, rule] : rules) {
    Scene scene = elastica.scene;
    scene.solver.method = Method::kShooting;
    scene.solver.integrator = rule;
    add_orders(page, name, scene, elastica.exact, {6, 12, 24});
  }
  page << "\n| collocation, degree | elements: error | | order | | order |\n"
          "|---|---|---|---|---|---|\n";
  for (int degree = 2; degree <= 8; ++degree) {
    Scene scene = elastica.scene;
    scene.solver.method = Method::kCollocation;
    scene.solver.degree = degree;
    add_orders(page, std::to_string(degree), scene, elastica.exact, {8, 16, 32});
  }
  page << "\n| strain, order |";
  for (int order = 1; order <= 10; ++order)
    page << ' ' << order << " |";
  page << "\n|---|";
  for (int order = 1; order <= 10; ++order)
    page << "---|";
  page << "\n| error |";
  for (int order = 1; order <= 10; ++order)
    page << ' '
         << number(tip_error(cut(elastica.scene, {Method::kStrain, 1, order}), elastica.exact))
         << " |";
  page << "\n";
}

void write_slenderness(std::ostream& page) {
  constexpr Fineness kSame[] = {
      {Method::kShooting, 6, 6}, {Method::kStrain, 1, 8}, {Method::kCollocation, 8, 7}};
  page << "\n## Thick to hair-thin: nothing locks\n\nThe same cantilever with shear and extension, "
          "by the same unknowns whatever its radius; the error of a method that locked would grow "
          "with L / r.\n\n| L / r | EI / GA L² | shooting, 6 cells | strain, order 8 | "
          "collocation, 8 "
          "of degree 7 |\n|---|---|---|---|---|\n";
  for (const double slenderness : {20., 200., 2000., 20000.}) {
    Scene scene;
    scene.rods.push_back(steel_rod(0.4, 0.4 / slenderness));
    switch_on(scene, {Effect::kExtension, Effect::kShear});
    const double EI = bending_stiffness(scene.rods[0]);
    add_load(scene, 1, {5 * EI / 0.16, 0, 0});
    const Vec3 exact = tip_at_rest(cut(scene, {Method::kShooting, 60, 6})).point;
    const double GA = 80e9 * std::numbers::pi * std::pow(0.4 / slenderness, 2);
    page << "| " << slenderness << " | " << number(EI / (GA * 0.16)) << " |";
    for (const Fineness& f : kSame)
      page << ' ' << number(tip_error(cut(scene, f), exact)) << " |";
    page << "\n";
  }
}

void write_page(const std::string& folder, bool quick) {
  std::ofstream page(folder + "/methods.md");
  if (!page) throw std::runtime_error("cannot write to " + folder);
  page
      << "# Methods compared\n\nMade by `build/bin/cprsim_methods docs`. Error: of the point told, "
         "over the rod's length, against shooting with 60 cells of gauss6 where no closed form is "
         "named. Order: of the table, or degree of the polynomials. Unknowns: of one rod. Time: "
         "from the scene in memory to the answer, the smallest of 9 runs on one core of a machine "
         "shared with others.\n";
  const std::vector<Case> cases = all_cases();
  for (const Case& one : cases) {
    page << "\n## " << one.title << "\n\n"
         << one.about
         << "\n\n| method | pieces | order | unknowns | error | iterations | µs |\n"
            "|---|---|---|---|---|---|---|\n";
    for (const Fineness& f : kShown)
      page << row(one, f, quick ? 1 : 9);
  }
  write_orders(page, cases.front());
  write_slenderness(page);
}

}  // namespace
}  // namespace cprsim

int main(int argc, char** argv) {
  const bool quick = argc > 2 && std::string(argv[1]) == "--quick";
  if (argc < 2) {
    std::fputs("cprsim_methods [--quick] FOLDER\n", stderr);
    return 2;
  }
  try {
    cprsim::write_page(argv[argc - 1], quick);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cprsim_methods: %s\n", error.what());
    return 1;
  }
  return 0;
}
