// SPDX-License-Identifier: BSD-3-Clause
// Which method a rod gets and how finely it is cut, where the scene leaves that open; and why.
#pragma once

#include <string>

#include "engine/rod/make_rod.h"

namespace cprsim {

/// What is done with a rod, and why.
struct MethodChoice {
  Method method = Method::kShooting;
  std::string why;
};

/// The rod's own method, otherwise the solver's, otherwise the one whose resolution is given,
/// otherwise the fastest; then how finely it is cut.
MethodChoice choose_method(const RodPlan& plan);

int shooting_cells(const RodPlan& plan);
int strain_order(const RodPlan& plan);
int strain_elements(const RodPlan& plan);
int collocation_degree(const RodPlan& plan);
int collocation_elements(const RodPlan& plan);

}  // namespace cprsim
