// SPDX-License-Identifier: BSD-3-Clause
// A rod of any valid size and stiffness, clamped, loaded and let go: its equilibrium and a few
// steps either converge to finite numbers or say why not.
#include <cmath>
#include <cstring>
#include <numbers>

#include "tests/fuzz/target.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

/// Draws numbers from the fuzzer's bytes; zeros when they are used up.
class Dice {
 public:
  Dice(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  unsigned below(unsigned count) { return next() % count; }

  /// Evenly distributed in the logarithm.
  double between(double least, double most) {
    return least * std::pow(most / least, next() / 65535.0);
  }

  double within(double most) { return most * (next() / 32767.5 - 1); }

 private:
  unsigned next() {
    std::uint16_t word = 0;
    if (at_ + 2 <= size_) std::memcpy(&word, data_ + at_, 2);
    at_ += 2;
    return word;
  }

  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

Scene random_rod(Dice& dice) {
  Scene scene;
  const double radius = dice.between(1e-4, 2e-2), length = radius * dice.between(10, 1e5);
  RodSpec rod = steel_rod(length, radius);
  rod.material->youngs_modulus = dice.between(1e3, 4e11);
  rod.material->shear_modulus = rod.material->youngs_modulus / dice.between(2, 3);
  rod.material->density = dice.between(100, 2e4);
  if (dice.below(4) == 0)
    rod.rest_curvature = Vec3(0, dice.within(6 / length), dice.within(6 / length));
  if (dice.below(2) == 0) {
    damp(rod, dice.between(1e-6, 1e-1));
    switch_on(scene, {Effect::kDamping});
  }
  for (const Effect effect :
       {Effect::kGravity, Effect::kShear, Effect::kExtension, Effect::kRotaryInertia})
    if (dice.below(2) == 0) switch_on(scene, {effect});
  scene.rods.push_back(rod);
  const double unit = bending_stiffness(rod) / (length * length);
  add_load(scene, 1, Vec3(dice.within(10), dice.within(10), dice.within(10)) * unit,
           Vec3(dice.within(6), dice.within(6), dice.within(6)) * unit * length,
           dice.below(2) == 0);
  constexpr Method kMethods[] = {Method::kAuto, Method::kShooting, Method::kStrain,
                                 Method::kCollocation};
  scene.solver.method = kMethods[dice.below(4)];
  const double step = dice.between(1e-5, 5e-2);
  scene.solver.step = step;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = dice.below(2) == 0;
  scene.simulation.duration = 4 * step;
  return scene;
}

}  // namespace
}  // namespace cprsim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cprsim;
  Dice dice(data, size);
  const Scene scene = random_rod(dice);
  Simulation simulation(scene);
  simulation.start();
  for (int k = 0; k < 100 && simulation.status() == RunStatus::kRunning; ++k)
    simulation.advance();
  const bool failed = simulation.status() == RunStatus::kFailed;
  require(!failed || !simulation.failure().empty(), "a failure says why");
  if (failed) return 0;
  const Snapshot& end = simulation.now();
  for (const RodPoint& point : end.rods[0].points)
    require(point.position.allFinite(), "a converged rod is somewhere");
  return 0;
}
