// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>

#include "tools/cprsim/names.h"
#include "tools/cprsim/run_report.h"

namespace cprsim {

namespace {

/// "2.6x real time"
std::string speed_of(double factor) {
  return fmt::format("{:.{}f}x real time", factor, factor < 10 ? 1 : 0);
}

std::string first_line(const RunReport& report) {
  const RunStatistics& statistics = report.statistics;
  if (report.end_time <= 0) {
    const std::string kind = report.stability.empty() ? "" : report.stability + " ";
    return fmt::format("{}: {}static equilibrium found in {:.3g} s, {} iterations\n", report.label,
                       kind, statistics.start_seconds, report.last_solve.iterations);
  }
  return fmt::format("{}: {:.3f} s simulated in {:.3g} s ({}), {} steps, {} rejected\n",
                     report.label, report.time, statistics.start_seconds + statistics.step_seconds,
                     speed_of(report.real_time_factor()), statistics.steps, statistics.rejected);
}

std::string effects_line(const Scene& scene) {
  std::string line = "  effects    bending torsion";
  for (int i = 0; i < kEffectCount; ++i) {
    const auto effect = static_cast<Effect>(i);
    if (scene.effects.has(effect)) line += std::string(" ") + effect_name(effect);
  }
  return line + "\n";
}

std::string solver_line(const Scene& scene, const RunReport& report) {
  const RunStatistics& statistics = report.statistics;
  std::string line = "  solver     " + pieces_text(report.facts);
  if (scene.simulation.mode != Mode::kStatic && statistics.steps > 0) {
    const double mean =
        static_cast<double>(statistics.iterations) / static_cast<double>(statistics.steps);
    line += fmt::format(", {}, {:.1f} iterations/step (max {})", report.facts.scheme, mean,
                        statistics.max_iterations);
  }
  return line + fmt::format(", residual <= {:.0e}\n", statistics.worst_residual);
}

std::string energy_line(const Scene& scene, const RunReport& report) {
  const Extremes& extremes = report.extremes;
  if (scene.simulation.mode == Mode::kStatic) {
    const std::string magnetic =
        scene.effects.has(Effect::kMagnetic)
            ? fmt::format(", {:.4g} J magnetic", extremes.energy().magnetic)
            : "";
    return fmt::format("  energy     {:.4g} J elastic, {:.4g} J gravity{}\n",
                       extremes.energy().elastic, extremes.energy().gravity, magnetic);
  }
  if (!extremes.relative_balance()) return "  energy     nothing moved\n";
  const char* of = extremes.exchanged() == extremes.largest_work()      ? "work done"
                   : extremes.exchanged() == extremes.largest_kinetic() ? "largest kinetic energy"
                                                                        : "energy dissipated";
  return fmt::format("  energy     balance closes to {:.1e} of the {}\n",
                     *extremes.relative_balance(), of);
}

std::string accuracy_line(const RunReport& report) {
  if (report.real_time) return "  real time  " + describe(*report.real_time) + "\n";
  return report.accuracy ? "  accuracy   " + describe(*report.accuracy) + "\n" : "";
}

std::string expect_lines(const RunReport& report) {
  const auto count = [&](Verdict verdict) {
    return std::count_if(report.expectations.begin(), report.expectations.end(),
                         [&](const ExpectResult& result) { return result.verdict == verdict; });
  };
  if (report.expectations.empty()) return {};
  std::string lines =
      fmt::format("  expect     {} of {} met", count(Verdict::kMet), report.expectations.size());
  if (const auto missing = count(Verdict::kNotReached); missing > 0) {
    lines += fmt::format(", {} not reached", missing);
  }
  lines += '\n';
  for (const ExpectResult& result : report.expectations) {
    if (result.verdict == Verdict::kMet) continue;
    lines += fmt::format("    {}: '{}'\n", to_string(result.verdict), result.name);
    for (const CheckResult& check : result.checks) {
      if (check.verdict == Verdict::kNotMet) lines += "      " + describe(check) + "\n";
    }
  }
  return lines;
}

std::string wrote_line(const RunReport& report, const std::string& folder) {
  std::vector<std::string> inside{"run.json"}, elsewhere;
  for (const WrittenFile& file : report.files) {
    const bool absolute = file.name.front() == '/';
    // the .pvd stands for the folder of its frames
    if (file.kind == "vtk" && file.name.back() == '/') continue;
    (absolute ? elsewhere : inside).push_back(file.name);
  }
  std::string line = "  wrote      " + folder + "/";
  line += inside.size() == 1 ? inside.front() : fmt::format("{{{}}}", fmt::join(inside, ","));
  for (const std::string& name : elsewhere)
    line += " " + name;
  return line + "\n";
}

}  // namespace

double RunReport::real_time_factor() const {
  const double wall = statistics.start_seconds + statistics.step_seconds;
  return wall > 0 ? time / wall : 0;
}

const char* to_string(RunEnd end) {
  switch (end) {
    case RunEnd::kRunning:
      return "running";
    case RunEnd::kDone:
      return "done";
    case RunEnd::kFailed:
      return "failed";
    case RunEnd::kWallTime:
      return "wall time exceeded";
    case RunEnd::kInterrupted:
      return "interrupted";
    case RunEnd::kOutput:
      return "output failed";
  }
  return "";
}

std::string describe(const CheckResult& check) {
  if (check.channel.empty())
    return check.kind == "event" ? fmt::format("expected {}, which did not come about", check.limit)
                                 : fmt::format("{}: the run did not converge", check.kind);
  if (check.kind == "match")
    return fmt::format("{} is off by {:.6g}, largest at t = {:.6g} s, expected {}", check.channel,
                       check.value, check.time, check.limit);
  return fmt::format("{} = {:.6g} at t = {:.6g} s, expected {}", check.channel, check.value,
                     check.time, check.limit);
}

std::string describe(const AccuracyReport& accuracy) {
  std::string text = fmt::format(
      "{:.3g} {} asked for, error about {:.1g} (from the distance between runs, {} in all)",
      accuracy.asked, accuracy.unit, accuracy.estimate, accuracy.runs);
  if (accuracy.reached()) return text;
  return text + (accuracy.held_back.empty()
                     ? "; not reached"
                     : "; not reached: the scene fixes " + accuracy.held_back);
}

std::string describe(const RealTimeReport& real_time) {
  if (!real_time.kept_up())
    return fmt::format("{:.3g}x asked for; the coarsest settings reach {:.3g}x", real_time.asked,
                       real_time.factor);
  const std::string error = real_time.estimate
                                ? fmt::format("error about {:.1g} m", *real_time.estimate)
                                : std::string("error unknown");
  return fmt::format(
      "{:.3g}x asked for, which buys --accuracy {:.2g}: {}, {:.3g}x in its trial "
      "({} trials)",
      real_time.asked, real_time.accuracy, error, real_time.factor, real_time.runs);
}

std::string to_summary(const Scene& scene, const RunReport& report, const std::string& folder) {
  return first_line(report) + effects_line(scene) + solver_line(scene, report) +
         accuracy_line(report) + energy_line(scene, report) + expect_lines(report) +
         wrote_line(report, folder);
}

std::string profile_table(const RunReport& report) {
  if (!report.phases) return {};
  static constexpr const char* kWhat[kPhaseCount] = {"rods: equations along their length",
                                                     "rods: condensed to their ends",
                                                     "robot: bodies, joints, linear system",
                                                     "contact of rods",
                                                     "free bodies (Bullet)",
                                                     "shapes and energies of each step",
                                                     "recordings, expectations",
                                                     "pictures"};
  const Timings& timings = report.timings;
  const double all = timings.total;
  std::string text = fmt::format("\n{:<38}{:>12}{:>8}{:>12}{:>12}\n", "where the time went",
                                 "seconds", "%", "times", "each, us");
  const auto line = [&](const char* what, double seconds, long count) {
    text += fmt::format("  {:<36}{:>12.4f}{:>8.1f}", what, seconds, 100 * seconds / all);
    if (count > 0)
      text += fmt::format("{:>12}{:>12.2f}", count, 1e6 * seconds / static_cast<double>(count));
    text += '\n';
  };
  line("scene file", timings.load, 0);
  double known = timings.load;
  for (int i = 0; i < kPhaseCount; ++i) {
    const PhaseClock::Sum& sum = (*report.phases)[static_cast<std::size_t>(i)];
    if (sum.count > 0) line(kWhat[i], sum.seconds, sum.count);
    known += sum.seconds;
  }
  line("the rest", all - known, 0);
  line("all", all, 0);
  const long sections = report.statistics.section_evaluations;
  const double integrating = report.phases->front().seconds;
  if (sections > 0)
    text += fmt::format("  {} section evaluations, {:.0f} ns each\n", sections,
                        1e9 * integrating / static_cast<double>(sections));
  return text;
}

std::string explain_failure(const RunReport& report, const std::string& folder) {
  std::string text = report.failure;
  text += fmt::format("\n  at         t = {:.6g} s of {:.6g} s, after {} steps", report.time,
                      report.end_time, report.statistics.steps);
  if (report.end == RunEnd::kFailed) {
    const SolveReport& solve = report.last_solve;
    text += fmt::format("\n  solver     last tried {}, residual from {:.1e} to {:.1e}",
                        to_string(solve.stage), solve.initial_residual, solve.residual);
    for (std::size_t i = 0; i < report.likely_causes.size(); ++i) {
      text += (i == 0 ? "\n  perhaps    " : "\n             ") + report.likely_causes[i];
    }
  }
  text += "\n" + wrote_line(report, folder);
  text.pop_back();
  return text;
}

}  // namespace cprsim
