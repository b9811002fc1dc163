// SPDX-License-Identifier: BSD-3-Clause
// cprsim run: scene in, simulation on, results out.
#include <fmt/chrono.h>
#include <fmt/core.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <stdexcept>

#include "engine/math/state_text.h"
#include "engine/study/stability.h"
#include "tools/cprsim/accuracy_control.h"
#include "tools/cprsim/build_simulation.h"
#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/likely_causes.h"
#include "tools/cprsim/output_folder.h"
#include "tools/cprsim/outputs.h"
#include "tools/cprsim/progress.h"
#include "tools/cprsim/run_options.h"
#include "tools/cprsim/run_profile.h"
#include "tools/cprsim/run_report.h"
#include "tools/cprsim/state_files.h"
#include "tools/cprsim/stopwatch.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

struct Run {
  const Scene& scene;
  const RunOptions& options;
  const Console& console;
  std::filesystem::path folder;
  Stopwatch watch;
  RunReport report;
  AnswerTrack* track = nullptr;                   ///< if an accuracy is asked for
  std::unique_ptr<RunProfile> profile = nullptr;  ///< if asked for

  void write_report() const { write_file(folder / "run.json", to_json(scene, report)); }
};

bool must_stop(Run& run) {
  if (stop_signal() != 0) {
    run.report.end = RunEnd::kInterrupted;
    run.report.failure_code = "E606";
    run.report.failure =
        fmt::format("interrupted by {}", stop_signal() == SIGINT ? "SIGINT" : "SIGTERM");
  } else if (run.options.max_wall && run.watch.seconds() > *run.options.max_wall) {
    run.report.end = RunEnd::kWallTime;
    run.report.failure_code = "E605";
    run.report.failure = fmt::format("--max-wall {} is used up", *run.options.max_wall);
  }
  return run.report.end != RunEnd::kRunning;
}

/// Advances to the end, or to what stops it; the loop of the program.
void simulate(Run& run, Simulation& simulation, Outputs& outputs, StateFiles& states) {
  Progress progress(run.console.progress(), run.report.label, simulation.end_time());
  states.start(simulation);
  const std::string none = states.unavailable(simulation);
  if (!none.empty()) run.console.warn(none);
  if (simulation.status() != RunStatus::kFailed) {
    const std::string warning = states.start(outputs, simulation);
    if (!warning.empty()) run.console.warn(warning);
    if (run.track != nullptr) run.track->begin(simulation.now());
  }
  while (simulation.status() == RunStatus::kRunning && !must_stop(run)) {
    if (run.profile) run.profile->begin_step();
    simulation.advance();
    if (run.profile) run.profile->end_step(simulation);
    if (simulation.status() == RunStatus::kFailed) break;
    outputs.step(simulation.before(), simulation.now());
    if (run.track != nullptr) run.track->step(simulation.before(), simulation.now());
    states.step(simulation);
    if (run.track == nullptr) states.write_if_due(simulation, outputs);
    progress.update(simulation.time(), simulation.statistics().steps,
                    simulation.statistics().iterations);
  }
  progress.finish();
  if (simulation.status() == RunStatus::kDone) run.report.end = RunEnd::kDone;
  if (run.track != nullptr) return;  // its error is judged over the whole of a run
  if (run.report.end == RunEnd::kInterrupted || run.report.end == RunEnd::kWallTime)
    states.write("checkpoint.state", simulation, outputs);
  if (simulation.status() == RunStatus::kFailed && simulation.statistics().steps > 0)
    states.write("failure.state", simulation, outputs);
}

/// The same, with whatever disk, pipe or graphics have to complain about.
void simulate_or_complain(Run& run, Simulation& simulation, Outputs& outputs, StateFiles& states) {
  OutputComplaint complaint;
  try {
    simulate(run, simulation, outputs, states);
  } catch (const std::runtime_error& error) {
    complaint = OutputComplaint(error);
  }
  const OutputComplaint later = outputs.finish();
  if (complaint.text.empty()) complaint = later;
  if (complaint.text.empty()) return;
  run.report.end = RunEnd::kOutput;
  run.report.failure = complaint.text;
  run.report.failure_code = complaint.code;
}

const char* code_of(Failure kind) {
  switch (kind) {
    case Failure::kStart:
      return "E601";
    case Failure::kOverlap:
      return "E602";
    case Failure::kContact:
      return "E604";
    case Failure::kNone:
    case Failure::kStep:
      break;
  }
  return "E603";
}

int exit_code_of(const Run& run) {
  switch (run.report.end) {
    case RunEnd::kRunning:
    case RunEnd::kDone:
      break;
    case RunEnd::kFailed:
    case RunEnd::kWallTime:
      return kExitSimulationFailed;
    case RunEnd::kInterrupted:
      return 128 + stop_signal();
    case RunEnd::kOutput:
      return kExitEnvironment;
  }
  // with --duration an expectation about a later time is left open
  const bool shortened = run.options.scene.duration.has_value();
  const auto fails = [&](const ExpectResult& result) {
    return result.verdict == Verdict::kNotMet ||
           (result.verdict == Verdict::kNotReached && !shortened);
  };
  const auto& results = run.report.expectations;
  return std::any_of(results.begin(), results.end(), fails) ? kExitExpectationFailed : kExitDone;
}

/// Newton's method finds unstable equilibria as readily as stable ones: say which it was. What ties
/// and obstacles hold back is not counted, so that nothing is said of tied rods, and of rods that
/// touch something not that they are unstable.
void judge_stability(Run& run, const Simulation& simulation) {
  if (run.scene.simulation.mode != Mode::kStatic || run.report.end != RunEnd::kDone ||
      run.scene.rods.empty() || !run.scene.ties.empty() || !simulation.has_visitable_state())
    return;
  const Stability found = count_unstable(simulation.robot());
  if (found.unstable > 0 && simulation.now().contact.count > 0) return;
  run.report.stability = to_string(found.verdict);
  run.report.unstable_directions = found.unstable;
}

void conclude(Run& run, const Simulation& simulation, const Outputs& outputs,
              const StateFiles& states) {
  RunReport& report = run.report;
  report.time = simulation.time();
  report.statistics = simulation.statistics();
  report.last_solve = simulation.last_report();
  if (simulation.status() == RunStatus::kFailed && report.end == RunEnd::kRunning) {
    report.end = RunEnd::kFailed;
    report.failure = simulation.failure();
    report.failure_code = code_of(simulation.failure_kind());
    const bool started = report.statistics.steps > 0 || report.time > 0;
    report.likely_causes =
        likely_causes(run.scene, report.facts, report.last_solve, report.time, started);
  }
  report.extremes = outputs.extremes();
  report.expectations = outputs.expectations().results(report.end == RunEnd::kDone);
  report.files = outputs.files();
  for (WrittenFile& file : states.files())
    report.files.push_back(std::move(file));
  report.exit_code = exit_code_of(run);
  report.timings.build = report.statistics.build_seconds;
  report.timings.start = report.statistics.start_seconds;
  report.timings.steps = report.statistics.step_seconds;
  report.timings.outputs = outputs.seconds();
  report.timings.total = run.watch.seconds();
}

void show(const Run& run) {
  const RunReport& report = run.report;
  if (run.console.json()) write_to_stdout(to_json(run.scene, report));
  if (report.end == RunEnd::kDone) {
    run.console.say(to_summary(run.scene, report, run.folder.string()));
    run.console.say(profile_table(report));
    if (report.unstable_directions > 0)
      run.console.warn("W603", fmt::format("the equilibrium is unstable in {} direction{}: the "
                                           "robot would not stay there; `cprsim "
                                           "path` and `cprsim solve` tell more",
                                           report.unstable_directions,
                                           report.unstable_directions == 1 ? "" : "s"));
    if (report.exit_code != kExitDone) run.console.error("E607", "not all expectations are met");
    return;
  }
  run.console.error(report.failure_code, explain_failure(report, run.folder.string()));
}

void finish_profile(Run& run, Simulation& simulation) {
  simulation.measure(nullptr);
  run.profile->finish();
  if (run.options.profile) run.report.phases = run.profile->clock().sums();
  if (run.profile->left_out() > 0)
    run.console.warn(
        "W605", fmt::format("{} holds the first million stretches of time; {} more are left out",
                            run.options.trace, run.profile->left_out()));
}

void warn_of_imbalance(const Run& run) {
  constexpr double kOpen = 0.1;  // of the energy that moved
  const double balance = run.report.extremes.relative_balance().value_or(0);
  if (run.scene.simulation.mode == Mode::kDynamic && balance > kOpen)
    run.console.warn(
        "W602",
        fmt::format("{:.0f} % of the energy that moved is not accounted for: steps or rods are too "
                    "coarse for this motion, or the scheme damps it",
                    100 * balance));
}

void run_scene(Run& run, Simulation& simulation) {
  StateFiles states(run.scene, run.options, run.folder, simulation);
  const OutputFolder folder(run.folder);
  run.report.facts = simulation.facts();
  run.report.end_time = simulation.end_time();
  run.write_report();  // says "running", and marks the folder as ours if this process is killed
  try {
    Outputs outputs(run.scene, run.options, run.folder, run.console);
    if (run.options.profile || !run.options.trace.empty()) {
      run.profile = std::make_unique<RunProfile>(run.options.trace);
      simulation.measure(&run.profile->clock());
      outputs.measure(&run.profile->clock());
    }
    run.report.film_device = outputs.drawn_by();
    run.report.files = outputs.files();
    run.write_report();
    simulate_or_complain(run, simulation, outputs, states);
    if (run.profile) finish_profile(run, simulation);
    conclude(run, simulation, outputs, states);
  } catch (const std::runtime_error& error) {
    run.report.end = RunEnd::kOutput;
    run.report.failure = error.what();
    run.report.failure_code = OutputComplaint(error).code;
    run.report.exit_code = kExitEnvironment;
  }
}

/// Runs once with the settings that a time budget buys.
int run_in_real_time(Run& run) {
  if (!run.options.from.empty())
    throw StateError("a run that is held to a --real-time-factor cannot go on from a state");
  if (run.scene.simulation.mode == Mode::kStatic || run.scene.rods.empty())
    throw std::invalid_argument(
        "--real-time-factor is for scenes with rods and a duration: there is nothing to keep up "
        "with here");
  RealTimeSearch search(run.scene, *run.options.real_time_factor);
  search.run([&] { return must_stop(run); });
  run.report.real_time = search.report();
  const auto simulation = build_simulation(search.scene());
  run_scene(run, *simulation);
  run.write_report();
  show(run);
  if (!run.report.real_time->kept_up()) run.console.warn("W604", describe(*run.report.real_time));
  warn_of_imbalance(run);
  return run.report.exit_code;
}

/// Runs once, or, where an accuracy is asked for, until the error found out is small enough.
int run_to_accuracy(Run& run) {
  AccuracyControl control(run.scene);
  if (control.asked() && !run.options.from.empty())
    throw StateError("a run that is held to an <accuracy> cannot go on from a state");
  if (control.asked() && run.options.checkpoint_every)
    run.console.warn(
        "no checkpoints are written of a run that is held to an <accuracy>: its error is found out "
        "at its end, and it may begin anew");
  if (control.asked()) control.fly_pilots([&] { return must_stop(run); });
  for (bool again = true; again;) {
    const auto simulation = build_simulation(control.scene());
    if (control.asked()) run.track = &control.track();
    run_scene(run, *simulation);
    const bool judge = control.asked() && run.report.end == RunEnd::kDone;
    const long work = simulation->statistics().section_evaluations;
    again = judge ? control.refine(work)
                  : control.asked() && run.report.end == RunEnd::kFailed && control.retry(work);
    if (judge) run.report.accuracy = control.report();
    if (again)
      run.report.begin_anew();
    else
      judge_stability(run, *simulation);
  }
  run.write_report();
  show(run);
  if (run.report.accuracy && !run.report.accuracy->reached())
    run.console.warn("W601", describe(*run.report.accuracy));
  warn_of_imbalance(run);
  return run.report.exit_code;
}

/// A scene that is invalid, or says that it ought to be.
int not_to_be_simulated(const LoadedScene& loaded, const RunOptions& options,
                        const Console& console) {
  const int code = loaded.rejected_as_expected() ? kExitDone
                   : loaded.scene != nullptr     ? kExitExpectationFailed
                                                 : kExitSceneInvalid;
  if (console.json()) {
    write_to_stdout(rejection_json(options.path, code, loaded.diagnostics));
  } else if (code == kExitDone) {
    console.say(fmt::format("{}: rejected with {}, as it expects\n", options.path,
                            loaded.expected_failure));
  }
  if (code == kExitExpectationFailed) {
    console.error(fmt::format("{} expects to be rejected with {}, but is valid", options.path,
                              loaded.expected_failure));
  }
  return code;
}

}  // namespace

int run_command(const Words& words) {
  const auto parsed = parse_run_options(words);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const RunOptions& options = std::get<RunOptions>(parsed);
  const Console console(options.console);
  // the software rasteriser reads this when it starts
  if (options.jobs > 0) setenv("LP_NUM_THREADS", std::to_string(options.jobs).c_str(), 1);

  const Stopwatch watch;
  RunReport report;
  report.timings.started = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  const LoadedScene loaded = load_and_show(options.path, options.scene, console);
  if (loaded.scene == nullptr || !loaded.expected_failure.empty()) {
    return not_to_be_simulated(loaded, options, console);
  }
  const Scene& scene = *loaded.scene;
  report.diagnostics = loaded.diagnostics;
  report.timings.load = watch.seconds();
  report.timings.jobs = options.jobs;
  report.label = label_of(options.path, scene);
  report.scene_path = options.path;
  report.options = options.given();

  Run run{scene, options,          console, choose_output_folder(options.output, report.label),
          watch, std::move(report)};
  try {
    return options.real_time_factor ? run_in_real_time(run) : run_to_accuracy(run);
  } catch (const StateError& error) {
    console.error(error.what());
    return kExitSceneInvalid;
  } catch (const std::invalid_argument& error) {
    console.error(options.path + ": " + error.what());
    return kExitSceneInvalid;
  }
}

}  // namespace cprsim
