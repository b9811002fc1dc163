// SPDX-License-Identifier: BSD-3-Clause
// A run without files, as `cprsim run` makes it: where an accuracy is asked for, until it is
// reached.
#pragma once

#include <functional>

#include "tools/cprsim/accuracy_control.h"
#include "tools/cprsim/quiet_run.h"

namespace cprsim {

struct AskedRun {
  QuietRun last;
  Scene scene;  ///< as it was run then
  AccuracyReport accuracy;
  long section_evaluations = 0;  ///< of all runs
  double cpu_seconds = 0;        ///< likewise
};

/// @param looking makes one who looks, anew for every run but the pilots
/// @param stop asked before every step
/// @throws std::invalid_argument if the scene asks for what cannot be simulated
AskedRun run_as_asked(const Scene& scene, const std::function<Onlooker()>& looking,
                      const std::function<bool()>& stop);

}  // namespace cprsim
