// SPDX-License-Identifier: BSD-3-Clause
// Paths to values of a scene, and changes made through them before anything is checked:
//   physics[default]/max_step_size     element names, a name in brackets where several stand beside
//   each other robot::leg_1/length                entity names robot/leg_1/base/@joint an attribute
//   robot::base/pose#3                one number of several, counted from 1
//   scheme                            a setting of the solver, see solver_setting.h
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/loader/document.h"
#include "scenes/loader/load.h"

namespace cprsim {

class Reporter;

/// Carries out --set, --duration, --step, --accuracy and --method on the tree of the world.
void apply_overrides(Node& world, const LoadOptions& options, Reporter& report);

/// The texts at LoadOptions::get, in their order; a path that leads nowhere is reported.
std::vector<std::string> values_at(Node& world, const std::vector<std::string>& paths,
                                   Reporter& report);

/// Reports if the path of a sweep does not lead to exactly one value.
void check_path(const Node& world, const Attribute& path, const Node& where, Reporter& report);

}  // namespace cprsim
