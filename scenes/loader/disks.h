// SPDX-License-Identifier: BSD-3-Clause
// Disks along a rod.
#pragma once

#include "scenes/loader/reading.h"

namespace cprsim {

/// All <disks> of a rod or of the class that gives them to it.
void read_disks(Reading& reading, const Node& owner, RodSpec& rod);

}  // namespace cprsim
