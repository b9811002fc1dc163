// SPDX-License-Identifier: BSD-3-Clause
// Who makes the rods of a robot: make_rod() (engine/rod/make_rod.h), unless somebody brings
// discretisations of his own.
#pragma once

#include <functional>
#include <memory>

#include "engine/model/solver_spec.h"

namespace cprsim {

class RodModel;
struct RodPlan;

/// As make_rod(), which it may call for the rods that are not its own. Empty: make_rod().
using RodMaker = std::function<std::unique_ptr<RodModel>(Method, const RodPlan&)>;

}  // namespace cprsim
