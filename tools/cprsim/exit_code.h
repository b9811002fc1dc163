// SPDX-License-Identifier: BSD-3-Clause
// What the shell gets back. Scripts and CI rely on these numbers.
#pragma once

namespace cprsim {

enum ExitCode {
  kExitDone = 0,
  kExitExpectationFailed = 1,
  kExitUsage = 2,
  kExitSceneInvalid = 3,
  kExitSimulationFailed = 4,
  kExitEnvironment = 5,
  kExitInternalError = 70,
  kExitInterrupted = 130,  ///< SIGINT
  kExitTerminated = 143    ///< SIGTERM
};

}  // namespace cprsim
