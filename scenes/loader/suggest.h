// SPDX-License-Identifier: BSD-3-Clause
// "did you mean": the names legal at a place that are nearest to what was typed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cprsim {

/// Damerau-Levenshtein distance (insert, delete, replace, swap neighbours), in bytes.
int edit_distance(std::string_view a, std::string_view b);

/// What other tools call something that here is named otherwise ("timestep" -> "max_step_size"), or
/// empty.
std::string_view synonym(std::string_view word);

/// The best of `names`: within distance 2 (1 for short words), or through a synonym; or empty.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

}  // namespace cprsim
