// SPDX-License-Identifier: BSD-3-Clause
// --profile and --trace: where the wall time of a run went, as sums and as a file of the Trace
// Event Format (JSON) that chrome://tracing and ui.perfetto.dev open.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "engine/run/simulation.h"
#include "engine/solve/phase_clock.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

class RunProfile {
 public:
  /// @param trace empty: no file. @throws OutputError
  explicit RunProfile(const std::filesystem::path& trace);

  PhaseClock& clock() { return clock_; }

  /// Around one step, for the trace.
  void begin_step() { step_began_ = clock_.now(); }

  void end_step(const Simulation& simulation);

  /// Completes the trace. @throws OutputError
  void finish();

  /// Stretches that the trace has no room for.
  long left_out() const { return left_out_; }

 private:
  void write(const char* name, double begin, double end, const std::string& arguments);

  std::unique_ptr<OutputFile> trace_;
  PhaseClock clock_;
  double step_began_ = 0;
  long written_ = 0, left_out_ = 0;
};

}  // namespace cprsim
