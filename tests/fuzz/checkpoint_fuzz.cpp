// SPDX-License-Identifier: BSD-3-Clause
// A checkpoint is read back or refused; a state that was tampered with behind a right checksum goes
// into the robot's numbers or is refused.
#include <string>

#include "engine/math/state_text.h"
#include "tests/fuzz/target.h"
#include "tests/support/robots.h"
#include "tools/cprsim/checkpoint.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cprsim;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const Checkpoint checkpoint = parse_checkpoint(text);
    require(to_text(checkpoint) == text, "a checkpoint is written as it was read");
  } catch (const StateError& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
  Scene scene;
  scene.rods.push_back(steel_rod(0.4, 1e-3));
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.duration = 0.1;
  scene.solver.step = 0.01;
  Simulation simulation(scene);
  simulation.start();
  try {
    StateReader state(text);
    simulation.visit(state);
    state.finish();
  } catch (const StateError& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
  return 0;
}
