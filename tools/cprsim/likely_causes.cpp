// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/likely_causes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/model/start_pose.h"
#include "engine/solve/newton.h"
#include "tools/cprsim/names.h"

namespace cprsim {

namespace {

constexpr std::size_t kMostCauses = 5;
constexpr double kCellsPerGrowth = 6;  ///< cells a rod needs per unit of its growth exponent
constexpr double kStepsPerPeriod = 10;

using Causes = std::vector<std::string>;

/// A drive or load that jumps within the step that failed.
void blame_jumps(const Scene& scene, double time, double step, Causes& causes) {
  const auto blame = [&](const Profile& profile, const Place& place, const char* what) {
    for (const double t : profile.breakpoints(time + 2 * step)) {
      if (t < time - 1e-9 || t > time + step) continue;
      const double jump = std::abs(profile.evaluate(t).value - profile.evaluate(t, true).value);
      if (jump <= 0) continue;
      causes.push_back(fmt::format("the {} at {} jumps by {:.3g} at t = {:.6g} s: use a smoothstep",
                                   what, place_name(scene, place), jump, t));
    }
  };
  for (const DriveSpec& drive : scene.drives)
    blame(drive.profile, drive.place, "drive");
  for (const LoadSpec& load : scene.loads) {
    if (load.has_profile) blame(load.profile, load.place, "load");
  }
  for (const MagneticFieldSpec& field : scene.magnetic_fields)
    if (field.has_profile) blame(field.profile, field.place, "magnetic field");
  for (const RodSpec& rod : scene.rods)
    if (rod.temperature && rod.temperature->has_profile)
      blame(rod.temperature->profile, rod.temperature->place, "temperature");
}

void blame_resolution(const Scene& scene, const ProblemFacts& facts, Causes& causes) {
  // Gauss collocation keeps growing and decaying solutions apart on any grid; explicit tables do
  // not
  if (!scene.solver.points) return;
  for (const RodFacts& rod : facts.rods) {
    if (rod.rule != "rk4" && rod.rule != "euler") continue;
    const double needed = std::ceil(kCellsPerGrowth * rod.growth_exponent);
    if (rod.elements >= needed) continue;
    causes.push_back(fmt::format(
        "rod '{}' has {} points and a growth exponent of {:.3g}: give it at least {:.0f}, or "
        "take gauss6 instead of {}",
        rod.name, rod.elements, rod.growth_exponent, needed, rod.rule));
    return;
  }
}

void blame_step(const ProblemFacts& facts, Causes& causes) {
  const auto fastest = std::max_element(
      facts.rods.begin(), facts.rods.end(),
      [](const RodFacts& a, const RodFacts& b) { return a.first_frequency < b.first_frequency; });
  if (fastest == facts.rods.end() || facts.step <= 0 || fastest->first_frequency <= 0) return;
  const double steps = 1 / (facts.step * fastest->first_frequency);
  if (steps >= kStepsPerPeriod) return;
  causes.push_back(fmt::format(
      "a step of {:.3g} s gives rod '{}' {:.2g} steps per period of its first mode: try --step "
      "{:.2g}",
      facts.step, fastest->name, steps, 1 / (kStepsPerPeriod * 2 * fastest->first_frequency)));
}

/// Held by the world, so that no rod carries it.
bool is_held(const Scene& scene, int body) {
  return scene.bodies[static_cast<std::size_t>(body)].is_static ||
         std::any_of(scene.joints.begin(), scene.joints.end(), [&](const JointSpec& joint) {
           return joint.kind == JointKind::kFixed && joint.child == body && joint.parent == kWorld;
         });
}

void blame_buckling(const Scene& scene, const ProblemFacts& facts, Causes& causes) {
  double weight = 0;
  for (std::size_t i = 0; i < scene.bodies.size() && scene.effects.has(Effect::kGravity); ++i) {
    if (!is_held(scene, static_cast<int>(i))) weight += scene.bodies[i].mass * scene.gravity.norm();
  }
  double carried = 0;
  for (const RodFacts& rod : facts.rods)
    carried += rod.buckling_load;
  if (facts.rods.empty() || weight <= carried) return;
  causes.push_back(
      fmt::format("the bodies weigh {:.3g} N, the rods buckle (clamped-free) at {:.3g} N together",
                  weight, carried));
}

/// Rods that bend under their own weight far beyond what a standing one carries (Greenhill 1881).
void blame_weight(const Scene& scene, const ProblemFacts& facts, Causes& causes) {
  constexpr double kGreenhill = 7.837, kFar = 100;
  const auto heaviest = std::max_element(
      facts.rods.begin(), facts.rods.end(),
      [](const RodFacts& a, const RodFacts& b) { return a.gravity_number < b.gravity_number; });
  if (heaviest == facts.rods.end() || !scene.effects.has(Effect::kGravity)) return;
  constexpr double kEarth = 9.81;  // m/s2, of the number
  const double times = heaviest->gravity_number * scene.gravity.norm() / kEarth / kGreenhill;
  if (times < kFar) return;
  causes.push_back(fmt::format(
      "rod '{}' weighs {:.3g} times what it could carry standing: it is a cable, and has many "
      "equilibria",
      heaviest->name, times));
}

/// Ends that cannot move are refused by the loader (E510); other bodies would have to come nearer.
void blame_length(const Scene& scene, Causes& causes) {
  if (scene.effects.has(Effect::kExtension)) return;
  for (std::size_t k = 0; k < scene.rods.size(); ++k) {
    const RodSpec& rod = scene.rods[k];
    const bool driven =
        std::any_of(scene.drives.begin(), scene.drives.end(),
                    [k](const DriveSpec& drive) { return drive.rod == static_cast<int>(k); });
    const bool held = rod.base.joint != EndJoint::kFree && rod.tip.joint != EndJoint::kFree;
    if (!held || driven) continue;
    const double gap = (start_pose(scene, rod.tip.at).p - start_pose(scene, rod.base.at).p).norm();
    if (gap <= rod.length * (1 + 1e-9)) continue;
    causes.push_back(fmt::format(
        "rod '{}' is {:.6g} m long, the gap between its ends {:.6g} m: make it longer, or "
        "list <extension/>",
        rod.name, rod.length, gap));
    return;
  }
}

void blame_work(const SolveReport& solve, Causes& causes) {
  if (solve.status != SolveStatus::kWorkLimit) return;
  const std::string reached =
      solve.loaded < 1 ? fmt::format(", with {:.3g} % of the loads carried", 100 * solve.loaded)
                       : std::string();
  causes.push_back(fmt::format(
      "an equilibrium may take {} million section evaluations, which are used up{}: begin from a "
      "dynamic run with damping, or with fewer elements",
      kMostStaticWork / 1000000, reached));
}

void blame_tolerance(const Scene& scene, const SolveReport& solve, Causes& causes) {
  const double tolerance = scene.solver.residual_tolerance.value_or(0);
  if (solve.status != SolveStatus::kStalled || tolerance <= 0) return;
  if (solve.residual > 1e3 * tolerance) return;
  causes.push_back(fmt::format(
      "the residual stalled at {:.1e}, close to the tolerance {:.1e}: rounding may allow no less",
      solve.residual, tolerance));
}

void blame_iterations(const Scene& scene, const SolveReport& solve, Causes& causes) {
  if (solve.status != SolveStatus::kIterationLimit || !scene.solver.max_iterations) return;
  causes.push_back(
      fmt::format("max_iterations = {} is little; the residual had come from {:.1e} to {:.1e}",
                  *scene.solver.max_iterations, solve.initial_residual, solve.residual));
}

/// What rubs on a loose rod turns it about its axis.
void blame_spin(const Scene& scene, const ProblemFacts& facts, Causes& causes) {
  if (scene.effects.has(Effect::kRotaryInertia)) return;
  for (const RodFacts& rod : facts.rods) {
    if (rod.rolling_number == 0) continue;
    causes.push_back(fmt::format(
        "rod '{}' is loose, and nothing resists what friction turns about its axis: list "
        "<rotary_inertia/>",
        rod.name));
    return;
  }
}

}  // namespace

Causes likely_causes(const Scene& scene, const ProblemFacts& facts, const SolveReport& solve,
                     double time, bool started) {
  Causes causes;
  const double step = facts.step > 0 ? facts.step : scene.max_step_size;
  if (!started) blame_length(scene, causes);
  if (started) blame_jumps(scene, time, step, causes);
  if (started) blame_spin(scene, facts, causes);
  blame_resolution(scene, facts, causes);
  blame_tolerance(scene, solve, causes);
  blame_iterations(scene, solve, causes);
  blame_work(solve, causes);
  blame_buckling(scene, facts, causes);
  blame_weight(scene, facts, causes);
  if (started) blame_step(facts, causes);
  if (solve.status == SolveStatus::kSingular) {
    causes.push_back(
        "something can move without resistance: an end that nothing holds, a missing joint");
  }
  if (started && scene.simulation.mode == Mode::kDynamic && !scene.effects.has(Effect::kDamping)) {
    causes.push_back("nothing takes energy out: <damping/> is not among the effects");
  }
  if (causes.size() > kMostCauses) causes.resize(kMostCauses);
  return causes;
}

}  // namespace cprsim
