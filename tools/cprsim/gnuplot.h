// SPDX-License-Identifier: BSD-3-Clause
// Pictures by gnuplot, a program at the end of a pipe; its script stays beside the picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/cprsim/console.h"

namespace cprsim {

/// A text as gnuplot takes it literally.
std::string gnuplot_quoted(const std::string& text);

/// How a script begins: it draws NAME.svg into the folder that its variable `folder` names, another
/// format if `kind` is png or pdf; a light grid, axes left and below.
/// @param width, height in pixels
std::string gnuplot_head(const std::string& name, int width, int height);

/// Writes NAME.gp into the folder and has it drawn: the script writes NAME.svg into `folder`, a
/// variable of its own, and NAME.png or NAME.pdf if its variable `kind` says so. Where that fails,
/// a warning says how to draw it later.
/// @return whether all were drawn
bool draw_with_gnuplot(const std::filesystem::path& folder, const std::string& name,
                       const std::string& script, const Console& console,
                       const std::vector<std::string>& kinds = {"svg"});

}  // namespace cprsim
