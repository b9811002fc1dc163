// SPDX-License-Identifier: BSD-3-Clause
// What rods are cut into, and how to cut them finer or coarser than the formulas of
// engine/rod/fineness.h say: runs that are to tell each other's error must not be cut alike.
#pragma once

#include <vector>

#include "engine/model/scene.h"

namespace cprsim {

struct Resolution {
  Method method = Method::kShooting;
  int elements = 0, order = 0;

  bool operator==(const Resolution&) const = default;
};

/// Of all rods, as the scene would be simulated.
std::vector<Resolution> resolution_of(const Scene& scene);

/// The scene with every rod cut finer, by one piece at least, for errors `times` smaller than with
/// `rods`; coarser if times < 1, though no rod is left without a piece. A resolution also says
/// which method it is for: each rod keeps its own.
Scene cut(Scene scene, const std::vector<Resolution>& rods, double times);

/// By how many times the errors of a finer cut are smaller, of the rod of which that is least; 1 if
/// no rod is cut otherwise.
double times_smaller(const std::vector<Resolution>& coarse, const std::vector<Resolution>& fine);

}  // namespace cprsim
