// SPDX-License-Identifier: BSD-3-Clause
// Pictures by gnuplot, a program at the end of a pipe; its script stays beside the picture.
#pragma once

#include <filesystem>
#include <string>

#include "tools/cprsim/console.h"

namespace cprsim {

/// A text as gnuplot takes it literally.
std::string gnuplot_quoted(const std::string& text);

/// Writes NAME.gp into the folder and has it drawn: the script writes NAME.svg into `folder`, a
/// variable of its own. Where that fails, a warning says how to draw it later.
/// @return whether it was drawn
bool draw_with_gnuplot(const std::filesystem::path& folder, const std::string& name,
                       const std::string& script, const Console& console);

}  // namespace cprsim
