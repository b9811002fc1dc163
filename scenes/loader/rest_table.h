// SPDX-License-Identifier: BSD-3-Clause
// The rest curvature of a rod as a table in a file beside the scene.
#pragma once

#include <vector>

#include "scenes/loader/reading.h"

namespace cprsim {

/// Lines "s,kx,ky,kz": a fraction of the length, ascending from 0 to 1, and the curvature about x
/// and y and the twist there, 1/m, section axes. A first line of names, empty lines and lines that
/// start with # are passed over. Empty after an error.
std::vector<RestSample> read_rest_table(Reading& reading, const Node& file);

}  // namespace cprsim
