// SPDX-License-Identifier: BSD-3-Clause
// Colours for numbers, and the numbers written beside them.
#pragma once

#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/view_spec.h"

namespace cprsim {

using Color = Eigen::Vector3f;  ///< display RGB in [0,1]

/// The colour of x in [0,1] in the map "viridis" (S. van der Walt, N. Smith, 2015): perceptually
/// uniform and readable with any colour vision. Values outside are clamped.
Color viridis(double x);

/// Blue, pale grey, orange: for quantities with a sign; 0.5 is the middle.
Color diverging(double x);

/// Well distinguishable colours (M. Okabe, K. Ito, 2008) for traces; i is taken modulo their
/// number.
Color accent(std::size_t i);

/// Has the quantity a sign, so that its colours run from -range to range?
bool is_signed(ColorBy by);

/// Colour of a value in a range {low, high}.
Color color_of(ColorBy by, double value, const Vec2& range);

/// "bending moment", and the unit it is shown in.
std::string quantity_name(ColorBy by);
std::string quantity_unit(ColorBy by);

/// The next number of the series 1, 2, 5, 10 … that is not below x > 0.
double nice_ceiling(double x);

/// Round values inside the range, four to six of them, ascending.
std::vector<double> ticks(const Vec2& range);

/// As short as the spacing of the ticks allows: 0, 0.5, 1e-05.
std::string tick_text(double value, double spacing);

}  // namespace cprsim
