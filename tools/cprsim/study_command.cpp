// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/study_command.h"

#include <fmt/core.h>

#include "tools/cprsim/exit_code.h"
#include "tools/series/measured_table.h"
#include "tools/series/pairing.h"

namespace cprsim {

void require_equilibrium(const SolveReport& report) {
  if (report.converged()) return;
  throw NoEquilibrium(
      fmt::format("no equilibrium found: {} after {} iterations, residual {:.1e} in {}",
                  to_string(report.status), report.iterations, report.residual, report.worst_row));
}

int complain_of(const Console& console, const std::function<int()>& act) {
  const auto complain = [&](const std::exception& error, int code) {
    console.error(error.what());
    return code;
  };
  try {
    return act();
  } catch (const UsageError& error) {
    return complain(error, kExitUsage);
  } catch (const TableError& error) {
    return complain(error, kExitUsage);
  } catch (const PairingError& error) {
    return complain(error, kExitUsage);
  } catch (const NoEquilibrium& error) {
    return complain(error, kExitSimulationFailed);
  }
}

int answer(const std::string& path, const SceneOptions& options, const Console& console,
           const std::function<int(const Scene&)>& ask) {
  const LoadedScene loaded = load_and_show(path, options, console);
  if (loaded.scene == nullptr) return kExitSceneInvalid;
  try {
    return complain_of(console, [&] { return ask(*loaded.scene); });
  } catch (const std::invalid_argument& error) {
    console.error(path + ": " + error.what());
    return kExitSceneInvalid;
  }
}

}  // namespace cprsim
