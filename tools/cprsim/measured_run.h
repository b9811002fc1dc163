// SPDX-License-Identifier: BSD-3-Clause
// One run of a scene with some settings changed: what was seen at chosen instants, what it cost.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/cprsim/quiet_run.h"
#include "tools/cprsim/scene_options.h"
#include "tools/series/series.h"

namespace cprsim {

/// Settings as for --set, in order.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// "scheme=esdirk43, tolerance=1e-06"
std::string settings_text(const Settings& settings);

/// The first error of a scene that is refused.
std::string reason_of(const std::vector<Diagnostic>& diagnostics);

struct MeasuredRun {
  std::string refusal;  ///< why the scene with these settings is invalid; nothing was run
  std::string failure;  ///< why the run did not get to its end
  Series series;        ///< the measured channels at the instants
  double cpu_seconds = 0, end_time = 0;
  RunStatistics statistics;

  bool done() const { return refusal.empty() && failure.empty(); }
};

/// What to look at: channel names as in a scene, and at which instants (nothing: evenly, 0 to the
/// end of the run).
struct Looking {
  std::vector<std::string> channels;
  std::optional<std::vector<double>> instants;
  int repetitions = 1;  ///< at most, of which the fastest counts; long runs are not repeated
};

/// Loads, runs and looks. A setting `accuracy` is kept to, as by `cprsim run`, and all runs that it
/// takes are counted; an accuracy of the scene itself is what it is cut by. @param stop asked
/// before every step; a run that it ends is a failure
MeasuredRun measured_run(const std::string& path, const SceneOptions& options,
                         const Settings& settings, const Looking& looking,
                         const std::function<bool()>& stop);

}  // namespace cprsim
