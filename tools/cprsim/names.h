// SPDX-License-Identifier: BSD-3-Clause
// The words of the scene language for the engine's enumerations.
#pragma once

#include <string>

#include "engine/model/scene.h"
#include "engine/run/simulation.h"

namespace cprsim {

const char* mode_name(Mode mode);

/// "shooting, 6 points of gauss6"
std::string pieces_text(const RodFacts& rod);

/// Methods and pieces of all rods, each kind once.
std::string pieces_text(const ProblemFacts& facts);

/// "scene.xml:24", or empty if the place is unknown.
std::string place_name(const Scene& scene, const Place& place);

}  // namespace cprsim
