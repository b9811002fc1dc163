// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/estimates.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "tools/cprsim/build_simulation.h"
#include "tools/cprsim/measured_run.h"
#include "tools/cprsim/sweep_plan.h"

namespace cprsim {

namespace {

constexpr double kPhasePerNumber = 2.3;  ///< of (1)
constexpr double kResidual = 1e-10;      ///< of the equilibrium that is moved

void freeze(Profile& profile, double time) {
  ProfileTerm term;
  term.value = profile.evaluate(time, true).value;
  profile = Profile();
  profile.terms.push_back(term);
}

/// The scene standing still with everything as it is at that time.
Scene at_rest(Scene scene, double time) {
  for (DriveSpec& drive : scene.drives)
    freeze(drive.profile, time);
  for (LoadSpec& load : scene.loads)
    if (load.has_profile) freeze(load.profile, time);
  for (MagneticFieldSpec& field : scene.magnetic_fields)
    if (field.has_profile) freeze(field.profile, time);
  for (RodSpec& rod : scene.rods)
    if (rod.temperature && rod.temperature->has_profile) freeze(rod.temperature->profile, time);
  scene.simulation.mode = Mode::kStatic;
  scene.solver.residual_tolerance = kResidual;
  return scene;
}

/// When to look: where the robot goes, as far as that is known without a run.
std::vector<double> moments_of(const Scene& scene) {
  const bool by_velocity = std::any_of(
      scene.drives.begin(), scene.drives.end(),
      [](const DriveSpec& drive) { return drive.quantity == DriveQuantity::kVelocity; });
  if (scene.simulation.mode != Mode::kQuasistatic || by_velocity) return {0};
  // by the golden ratio, so that they do not fall in with what is periodic
  std::vector<double> instants{0};
  for (const double part : {0.236, 0.472, 0.618, 0.854, 1.0})
    instants.push_back(part * scene.simulation.duration);
  return instants;
}

/// The equilibrium, and how far what is watched moves when the scene is a little another one.
class Rest {
 public:
  Rest(const Scene& scene, double time, std::string watched)
      : watched_(std::move(watched)), time_(time) {
    try {
      const Scene rest = at_rest(scene, time);
      const auto simulation = build_simulation(rest);
      if (!simulation->start().converged()) {
        problem_ = "no equilibrium to begin with: " + simulation->failure();
        return;
      }
      unknowns_ = simulation->unknowns();
      // the same step as that of the others, so that what was left of the residual cancels
      here_ = moved(scene);
    } catch (const std::invalid_argument& error) {
      problem_ = error.what();
    }
  }

  const std::string& problem() const { return problem_; }

  /// m; nothing if there is no equilibrium.
  std::optional<double> change(const Scene& other) const {
    if (!here_) return {};
    const std::optional<Vec3> there = moved(other);
    if (!there || !there->allFinite()) return {};
    return (*there - *here_).norm();
  }

 private:
  std::optional<Vec3> moved(const Scene& scene) const {
    const Scene rest = at_rest(scene, time_);
    const auto simulation = build_simulation(rest);
    // a robot with other unknowns finds its own equilibrium
    if (!simulation->start_beside(*unknowns_) && !simulation->start().converged()) return {};
    const Snapshot& now = simulation->now();
    for (std::size_t b = 0; b < rest.bodies.size(); ++b)
      if (rest.bodies[b].name + ".position" == watched_) return now.bodies[b].X_WB.p;
    if (now.rods.empty()) return {};
    return now.rods.front().points.back().position;
  }

  std::string watched_, problem_;
  double time_ = 0;
  std::shared_ptr<const RobotUnknowns> unknowns_;
  std::optional<Vec3> here_;
};

/// (1), at most 1.
double drift(double number, const RodFacts& rod, const Scene& scene) {
  const double omega = 2 * std::numbers::pi * rod.first_frequency;
  double periods = omega * scene.simulation.duration;
  if (scene.effects.has(Effect::kDamping) && rod.damping_ratio > 0)
    periods = std::min(periods, 1 / rod.damping_ratio);
  return std::min(1.0, kPhasePerNumber * number * periods);
}

/// What the effect does to a swing of 1; 0: nothing is known.
double in_motion(Effect effect, const RodFacts& rod, const Scene& scene) {
  const double omega = 2 * std::numbers::pi * rod.first_frequency;
  switch (effect) {
    case Effect::kShear:
      return drift(rod.shear_number, rod, scene);
    case Effect::kRotaryInertia:
      return drift(rod.rotary_number, rod, scene);
    case Effect::kDamping:
      return std::min(1.0, rod.damping_ratio * omega * scene.simulation.duration);
    case Effect::kDrag:
      return std::min(1.0, rod.drag_number);
    default:
      return 0;
  }
}

double by_number(Effect effect, const RodFacts& rod) {
  if (effect == Effect::kMagnetic) return rod.magnetic_number / 3;
  return effect == Effect::kThermal ? rod.thermal_number / 2 : 0;
}

bool touching(Effect effect) {
  return effect == Effect::kContact || effect == Effect::kSelfContact ||
         effect == Effect::kFriction || effect == Effect::kTendonFriction;
}

bool acts_at_rest(Effect effect) {
  return effect != Effect::kRotaryInertia && effect != Effect::kDamping;
}

class Estimator {
 public:
  Estimator(const std::string& path, const SceneOptions& options, const Scene& scene,
            const ProblemFacts& facts)
      : path_(path), options_(options), scene_(scene), facts_(facts) {
    all_.watched = default_channel(scene);
    for (const RodFacts& rod : facts.rods)
      all_.length = std::max(all_.length, rod.length);
  }

  EffectEstimates run() {
    const bool contact =
        scene_.effects.has(Effect::kContact) || scene_.effects.has(Effect::kSelfContact);
    if (contact) problem_ = "where rods touch is known from a run only";
    if (path_ == "-") problem_ = "the scene is read again for each effect: name a file";
    if (problem_.empty()) {
      for (const double time : moments_of(scene_))
        rests_.emplace_back(scene_, time, all_.watched);
      problem_ = rests_.front().problem();
    }
    if (problem_.empty()) find_swing();
    for (int i = 0; i < kEffectCount; ++i)
      all_.effects.push_back(estimate(static_cast<Effect>(i)));
    return all_;
  }

 private:
  void find_swing() {
    if (scene_.simulation.mode != Mode::kDynamic) return;
    Scene alone = scene_;
    alone.loads.clear();
    swing_ = std::min(1.0, rests_.front().change(alone).value_or(0) / all_.length);
  }

  EffectEstimate estimate(Effect effect) {
    EffectEstimate one{effect, scene_.effects.has(effect), 0, "", problem_};
    if (one.unknown.empty() && touching(effect)) one.unknown = "known from a run only";
    if (!one.unknown.empty()) return one;
    SceneOptions other = options_;
    (one.listed ? other.without : other.with).push_back(effect_name(effect));
    const LoadResult loaded = load_scene(path_, load_options(other));
    if (!loaded.scene) {
      one.unknown = reason_of(loaded.diagnostics);
      return one;
    }
    const auto consider = [&](double change, const char* by) {
      if (change > one.change || *one.by == 0) one.by = by;
      one.change = std::min(1.0, std::max(one.change, change));
    };
    if (acts_at_rest(effect)) {
      for (const Rest& rest : rests_)
        if (const std::optional<double> change = rest.change(*loaded.scene))
          consider(*change / all_.length, "equilibrium");
    }
    for (const RodFacts& rod : facts_.rods) {
      const double part = in_motion(effect, rod, scene_);
      if (scene_.simulation.mode == Mode::kDynamic && part > 0 && swing_ > 0)
        consider(swing_ * part, "motion");
      if (scene_.simulation.mode != Mode::kStatic && by_number(effect, rod) > 0)
        consider(by_number(effect, rod), "number");
    }
    if (*one.by == 0) one.unknown = why_unknown(effect);
    return one;
  }

  std::string why_unknown(Effect effect) const {
    if (acts_at_rest(effect)) return "no equilibrium with it changed";
    if (scene_.simulation.mode != Mode::kDynamic) return "nothing moves fast";
    return "how far it swings is known from a run only";
  }

  const std::string& path_;
  const SceneOptions& options_;
  const Scene& scene_;
  const ProblemFacts& facts_;
  EffectEstimates all_;
  std::vector<Rest> rests_;
  std::string problem_;
  double swing_ = 0;  ///< over the longest rod's length
};

}  // namespace

EffectEstimates estimate_effects(const std::string& path, const SceneOptions& options,
                                 const Scene& scene, const ProblemFacts& facts) {
  if (scene.rods.empty()) return {};
  return Estimator(path, options, scene, facts).run();
}

}  // namespace cprsim
