// SPDX-License-Identifier: BSD-3-Clause
// Settings of the solver that one word names, for --set and sweeps: scheme, step, points, ...
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/loader/document.h"

namespace cprsim {

const std::vector<std::string>& solver_settings();

bool is_solver_setting(std::string_view name);

/// Puts the setting where it belongs in the tree of the world, and takes out what excludes it: a
/// step a tolerance and the other way round, a scheme the parameters of another one, a method those
/// of single rods, an accuracy every resolution. A step is that of bodies without rods, too.
/// @param name one of solver_settings()
void set_solver_setting(Node& world, std::string_view name, const std::string& value);

/// The <physics> that counts.
Node& physics_of(Node& world);

}  // namespace cprsim
