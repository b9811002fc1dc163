// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/study_command.h"

#include <fmt/core.h>

#include "tools/cprsim/exit_code.h"

namespace cprsim {

void require_equilibrium(const SolveReport& report) {
  if (report.converged()) return;
  throw NoEquilibrium(
      fmt::format("no equilibrium found: {} after {} iterations, residual {:.1e} in {}",
                  to_string(report.status), report.iterations, report.residual, report.worst_row));
}

int answer(const std::string& path, const SceneOptions& options, const Console& console,
           const std::function<int(const Scene&)>& ask) {
  const LoadedScene loaded = load_and_show(path, options, console);
  if (loaded.scene == nullptr) return kExitSceneInvalid;
  try {
    return ask(*loaded.scene);
  } catch (const UsageError& error) {
    console.error(error.what());
    return kExitUsage;
  } catch (const NoEquilibrium& error) {
    console.error(error.what());
    return kExitSimulationFailed;
  } catch (const std::invalid_argument& error) {
    console.error(path + ": " + error.what());
    return kExitSceneInvalid;
  }
}

}  // namespace cprsim
