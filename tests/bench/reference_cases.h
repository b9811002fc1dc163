// SPDX-License-Identifier: BSD-3-Clause
// The reference cases of statics, stability, dynamics, contact and parallel robots that are known
// from closed forms or from solutions that share no code with this program, each as a question that
// every discretisation of a rod answers.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "engine/run/simulation.h"
#include "engine/study/static_study.h"

namespace cprsim {

/// What one method made of a case.
struct CaseAnswer {
  double error = 0;  ///< as the case says
  int unknowns = 0;  ///< of the whole robot
  bool found = false;
};

/// Of a case that not every method finds.
inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct ReferenceCase {
  const char* id;        ///< of the list of benchmarks
  const char* what;      ///< what stands or moves
  const char* error_of;  ///< what the error is of, and over what
  const char* source;    ///< of the reference
  std::function<CaseAnswer(Method)> solve;
  double limit = 1e-6;  ///< largest error that is accepted
  bool slow = false;    ///< left out of quick runs
};

std::vector<ReferenceCase> static_cases();
std::vector<ReferenceCase> stability_cases();
std::vector<ReferenceCase> dynamic_cases();
std::vector<ReferenceCase> robot_cases();
std::vector<ReferenceCase> contact_cases();

/// Rods by this method, each cut by the program itself for 1e-8 of `length`, unless the scene has
/// an accuracy already.
void cut(Scene& scene, Method method, double length);

/// Bodies, joints and rods.
int unknowns_of(const Robot& robot);

/// Independent references of which digits are given.
inline constexpr const char* kClosedForm = "closed form";
inline constexpr const char* kShootingRk8 = "independent shooting, Runge-Kutta of order 8";
inline constexpr const char* kSpectral = "independent spectral elements, explicit Runge-Kutta";

/// The equilibrium from the scene alone; found.error = measure(snapshot).
CaseAnswer at_rest(Scene scene, Method method, double length,
                   const std::function<double(const Snapshot&)>& measure);

/// The same with loads that grow in so many steps.
CaseAnswer loaded_in_steps(Scene scene, Method method, double length, int steps,
                           const std::function<double(const Snapshot&)>& measure);

/// The end of a motion, by esdirk43 to this local error.
CaseAnswer in_motion(Scene scene, Method method, double length, double tolerance,
                     const std::function<double(const Snapshot&)>& measure);

/// A scene of the gallery: shooting as it says, the others in so many elements, of order 3 (strain
/// basis) and degree 4. @throws std::runtime_error if it cannot be read
Scene gallery_scene(const std::string& name, Method method, int elements);

/// What is measured when the scene's time is over.
CaseAnswer run_scene(const Scene& scene, const std::function<double(const Snapshot&)>& measure);

/// A straight rod of given stiffnesses, clamped in the world; its section is of no matter.
RodSpec rod_of(double length, double bending_x, double bending_y, double torsion, double axial = 0,
               double shear = 0);

/// Material and circle with this mass per length and this rotary inertia rho I.
void give_mass(RodSpec& rod, double rhoA, double rhoI);

/// A frame with z, a rod's tangent, and x given, world axes.
Pose frame(const Vec3& p, const Vec3& tangent, const Vec3& x);

inline Vec3 tip_of(const Snapshot& snapshot, std::size_t rod = 0) {
  return snapshot.rods[rod].points.back().position;
}

}  // namespace cprsim
