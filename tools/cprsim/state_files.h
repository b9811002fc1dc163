// SPDX-License-Identifier: BSD-3-Clause
// A run's states on disk: where it comes from (--from), what it leaves to go on from
// (--checkpoint-every, a signal) and what reproduces its failure.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/run/simulation.h"
#include "tools/cprsim/checkpoint.h"
#include "tools/cprsim/outputs.h"
#include "tools/cprsim/run_options.h"

namespace cprsim {

class StateFiles {
 public:
  /// Puts the simulation where --from says. @throws StateError if that is no state of this scene
  StateFiles(const Scene& scene, const RunOptions& options, const std::filesystem::path& folder,
             Simulation& simulation);

  /// Starts the simulation, unless it is under way already.
  void start(Simulation& simulation);

  /// Starts what looks on, or lets it go on. @return a warning if recordings and expectations are
  /// not those of the state, and begin here; or nothing
  std::string start(Outputs& outputs, const Simulation& simulation) const;

  /// Why no checkpoint can be written though some are asked for; or nothing.
  std::string unavailable(const Simulation& simulation) const;

  /// After each step: prints its hash, if asked for.
  void step(Simulation& simulation) const;

  /// Writes a checkpoint if one is due.
  void write_if_due(Simulation& simulation, Outputs& outputs);

  /// checkpoint.state, failure.state. Scenes whose state cannot be visited have none.
  void write(const std::string& name, Simulation& simulation, Outputs& outputs);

  std::vector<WrittenFile> files() const;

 private:
  const Scene& scene_;
  const RunOptions& options_;
  std::filesystem::path folder_;
  std::optional<Checkpoint> from_;
  std::vector<std::string> written_;
  double next_ = 0;  ///< s
};

/// The state as 16 hexadecimal digits.
std::string state_hash(Simulation& simulation);

}  // namespace cprsim
