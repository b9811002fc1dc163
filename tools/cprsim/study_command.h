// SPDX-License-Identifier: BSD-3-Clause
// What commands that study a scene share: loading it, and turning what goes wrong into exit codes.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include "engine/solve/report.h"
#include "tools/cprsim/scene_options.h"

namespace cprsim {

/// There is no equilibrium to speak of: exit code 4.
class NoEquilibrium : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @throws NoEquilibrium that says how far the solve got, unless it converged
void require_equilibrium(const SolveReport& report);

/// @return what `act` returns, or the exit code of what it throws, with a message: UsageError and
/// what is wrong with tables (TableError, PairingError), NoEquilibrium
int complain_of(const Console& console, const std::function<int()>& act);

/// Loads the scene, shows what there is to say about it, and asks. @return what `ask` returns, or
/// the exit code of what it throws: as complain_of(), and std::invalid_argument for a scene that
/// cannot be simulated
int answer(const std::string& path, const SceneOptions& options, const Console& console,
           const std::function<int(const Scene&)>& ask);

}  // namespace cprsim
