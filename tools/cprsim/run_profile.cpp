// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/run_profile.h"

#include <fmt/core.h>

namespace cprsim {

namespace {

// What viewers open in a few seconds; some 100 bytes each.
constexpr long kMostEvents = 1'000'000;

}  // namespace

RunProfile::RunProfile(const std::filesystem::path& trace)
    : trace_(trace.empty() ? nullptr : std::make_unique<OutputFile>(trace)),
      clock_(trace.empty() ? PhaseClock::Listener()
                           : PhaseClock::Listener([this](Phase phase, double begin, double end) {
                               write(to_string(phase), begin, end, "");
                             })) {
  if (trace_)
    trace_->write(
        "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n"
        "{\"name\":\"process_name\",\"ph\":\"M\",\"pid\":1,\"args\":{\"name\":\"cprsim\"}}");
}

// Complete events ("X"), times in microseconds.
void RunProfile::write(const char* name, double begin, double end, const std::string& arguments) {
  if (written_ >= kMostEvents) {
    ++left_out_;
    return;
  }
  ++written_;
  trace_->write(fmt::format(
      ",\n{{\"name\":\"{}\",\"ph\":\"X\",\"pid\":1,\"tid\":1,\"ts\":{:.3f},\"dur\":{:.3f}{}}}",
      name, 1e6 * begin, 1e6 * (end - begin), arguments));
}

void RunProfile::end_step(const Simulation& simulation) {
  if (!trace_) return;
  const SolveReport& solve = simulation.last_report();
  write("step", step_began_, clock_.now(),
        fmt::format(",\"args\":{{\"t\":{},\"iterations\":{},\"residual\":{}}}", simulation.time(),
                    solve.iterations, solve.residual));
}

void RunProfile::finish() {
  if (!trace_) return;
  trace_->write("\n]}\n");
  trace_->commit();
}

}  // namespace cprsim
