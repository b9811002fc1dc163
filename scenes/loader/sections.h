// SPDX-License-Identifier: BSD-3-Clause
// The shapes of a rod's cross-sections.
#pragma once

#include <vector>

#include "scenes/loader/reading.h"

namespace cprsim {

/// One or, by ascending s, several <cross_section> along a rod; those that can be read.
std::vector<SectionSpec> read_sections(Reading& reading, const std::vector<const Node*>& nodes);

}  // namespace cprsim
