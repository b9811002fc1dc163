// SPDX-License-Identifier: BSD-3-Clause
// Engine and collision world put together.
#pragma once

#include <memory>

#include "engine/run/simulation.h"

namespace cprsim {

/// The scene must outlive the simulation. A collision world is made only if some body is held by
/// nothing.
/// @throws std::invalid_argument if the scene asks for what cannot be simulated
std::unique_ptr<Simulation> build_simulation(const Scene& scene);

}  // namespace cprsim
