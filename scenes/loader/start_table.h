// SPDX-License-Identifier: BSD-3-Clause
// The shapes that rods start in, as a table in a file beside the scene.
#pragma once

#include "scenes/loader/reading.h"

namespace cprsim {

/// Columns "s" (a fraction of the length, ascending from 0 to 1) and, for each rod that is not to
/// start unloaded, "<rod>.x", "<rod>.y", "<rod>.z" (points of its centreline, m, world axes).
/// @pre the scene's rods are read
void read_start_table(Reading& reading, const Node& initial);

}  // namespace cprsim
