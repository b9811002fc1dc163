// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/reference_cases.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "scenes/loader/load.h"
#include "tests/support/robots.h"

namespace cprsim {

void cut(Scene& scene, Method method, double length) {
  scene.solver.method = method;
  if (!scene.solver.accuracy) scene.solver.accuracy = 1e-8 * length;
}

int unknowns_of(const Robot& robot) {
  int n = (robot.plane ? 3 : 6) * static_cast<int>(robot.bodies.size());
  for (const Joint& joint : robot.joints)
    n += (robot.plane ? 3 : 6) + joint.unknown_coordinates();
  for (const RobotRod& rod : robot.rods)
    n += rod.model->unknown_count();
  return n;
}

Scene gallery_scene(const std::string& name, Method method, int elements) {
  LoadResult loaded = load_scene(CPRSIM_SOURCE_DIR "/scenes/" + name + ".xml");
  if (!loaded.scene) throw std::runtime_error("cannot read " + name);
  SolverSpec& solver = loaded.scene->solver;
  solver.method = method;
  if (method != Method::kShooting) {
    solver.points.reset();
    solver.integrator.reset();
    solver.elements = elements;
    solver.order = 3;
    solver.degree = 4;
  }
  return std::move(*loaded.scene);
}

CaseAnswer run_scene(const Scene& scene, const std::function<double(const Snapshot&)>& measure) {
  Simulation simulation(scene);
  CaseAnswer answer;
  answer.unknowns = unknowns_of(simulation.robot());
  const Snapshot end = run_to_end(simulation);
  answer.found = simulation.status() == RunStatus::kDone;
  if (answer.found)
    answer.error = measure(end);
  else
    std::fprintf(stderr, "%s: t = %g: %s\n", method_name(scene.solver.method), simulation.time(),
                 simulation.failure().c_str());
  return answer;
}

CaseAnswer at_rest(Scene scene, Method method, double length,
                   const std::function<double(const Snapshot&)>& measure) {
  return loaded_in_steps(std::move(scene), method, length, 1, measure);
}

CaseAnswer loaded_in_steps(Scene scene, Method method, double length, int steps,
                           const std::function<double(const Snapshot&)>& measure) {
  cut(scene, method, length);
  scene.solver.residual_tolerance = 1e-11;
  const std::vector<LoadSpec> loads = scene.loads;
  StaticStudy study(scene);
  CaseAnswer answer;
  answer.unknowns = unknowns_of(study.robot());
  for (int k = 1; k <= steps; ++k) {
    for (std::size_t i = 0; steps > 1 && i < loads.size(); ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const int load = static_cast<int>(i);
        const double part = static_cast<double>(k) / steps;
        study.set({Parameter::Kind::kForce, load, axis, "", "N"}, part * loads[i].force[axis]);
        study.set({Parameter::Kind::kTorque, load, axis, "", "N m"}, part * loads[i].torque[axis]);
      }
    const SolveReport report = k == 1 ? study.solve() : study.follow();
    if (!report.converged()) return answer;
  }
  answer.found = true;
  answer.error = measure(study.snapshot());
  return answer;
}

CaseAnswer in_motion(Scene scene, Method method, double length, double tolerance,
                     const std::function<double(const Snapshot&)>& measure) {
  cut(scene, method, length);
  scene.simulation.mode = Mode::kDynamic;
  if (!scene.solver.residual_tolerance) scene.solver.residual_tolerance = 1e-11;
  scene.solver.scheme = SchemeKind::kEsdirk43;
  if (!scene.solver.step) scene.solver.tolerance = tolerance;
  return run_scene(scene, measure);
}

RodSpec rod_of(double length, double bending_x, double bending_y, double torsion, double axial,
               double shear) {
  RodSpec rod = steel_rod(length, 1e-2 * length);
  rod.stiffness.bending_x = bending_x;
  rod.stiffness.bending_y = bending_y;
  rod.stiffness.torsion = torsion;
  if (axial > 0) rod.stiffness.axial = axial;
  if (shear > 0) rod.stiffness.shear_x = rod.stiffness.shear_y = shear;
  return rod;
}

void give_mass(RodSpec& rod, double rhoA, double rhoI) {
  const double radius = 2 * std::sqrt(rhoI / rhoA);
  rod.section.size = {radius, 0};
  rod.material->density = rhoA / (std::numbers::pi * radius * radius);
}

Pose frame(const Vec3& p, const Vec3& tangent, const Vec3& x) {
  Mat3 R;
  R << x, tangent.cross(x), tangent;
  return {R, p};
}

}  // namespace cprsim
