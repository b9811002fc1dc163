// SPDX-License-Identifier: BSD-3-Clause
// cprsim sweep: a scene with many settings, and what accuracy costs.
#include <fmt/core.h>

#include <csignal>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/output_folder.h"
#include "tools/cprsim/progress.h"
#include "tools/cprsim/stopwatch.h"
#include "tools/cprsim/study_command.h"
#include "tools/cprsim/sweep_result.h"
#include "tools/series/pairing.h"
#include "tools/series/read_series.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kReport = "sweep.json";
constexpr const char* kSchema = "cprsim-sweep/";

bool interrupted() {
  return stop_signal() != 0;
}

/// What decides the result; that of a sweep that is gone on with must be the same.
std::string signature_of(const SweepPlan& plan, const SweepOptions& options) {
  std::string text = plan.scene_hash;
  for (const auto& [name, value] : options.given())
    text += "|" + name + "=" + value;
  return text;
}

Json journal_entry(std::size_t index, const SweepRun& run) {
  const RunStatistics& s = run.statistics;
  return {{"run", index},
          {"refusal", run.refusal},
          {"failure", run.failure},
          {"errors", run.errors},
          {"last", run.last},
          {"cpu", run.cpu_seconds},
          {"end", run.end_time},
          {"counts",
           {s.steps, s.rejected, s.retried, s.iterations, s.start_iterations, s.section_evaluations,
            s.factorizations}},
          {"residual", s.worst_residual}};
}

SweepRun run_from(const Json& json) {
  SweepRun run;
  run.known = true;
  run.refusal = json.at("refusal");
  run.failure = json.at("failure");
  run.errors = json.at("errors").get<std::vector<double>>();
  run.last = json.at("last").get<std::vector<double>>();
  run.cpu_seconds = json.at("cpu");
  run.end_time = json.at("end");
  RunStatistics& s = run.statistics;
  const auto counts = json.at("counts").get<std::vector<long>>();
  long* const fields[] = {&s.steps,         &s.rejected,         &s.retried,
                          &s.iterations,    &s.start_iterations, &s.section_evaluations,
                          &s.factorizations};
  for (std::size_t i = 0; i < std::size(fields); ++i)
    *fields[i] = counts.at(i);
  s.worst_residual = json.at("residual");
  return run;
}

/// Runs as they are done, one line each: what an interruption leaves behind. Its first line is the
/// signature.
class Journal {
 public:
  Journal(fs::path path, std::string signature)
      : path_(std::move(path)), signature_(std::move(signature)) {}

  /// Takes over what an earlier sweep has done. @throws UsageError if that was another sweep
  void resume(SweepResult& result) const {
    std::ifstream stream(path_);
    std::string line;
    if (!std::getline(stream, line)) return;
    if (line != signature_)
      throw UsageError("--resume: " + path_.parent_path().string() +
                       " holds a sweep of another scene or with other options; choose another "
                       "folder with -o or leave --resume out");
    while (std::getline(stream, line) && !stream.eof()) {
      const Json json = Json::parse(line, nullptr, false);
      if (json.is_discarded()) continue;
      if (json.contains("spread"))
        result.reference_spread = json.at("spread").get<std::vector<double>>();
      else if (json.at("run").get<std::size_t>() < result.runs.size())
        result.runs[json.at("run").get<std::size_t>()] = run_from(json);
    }
  }

  void begin(const SweepResult& result) {
    std::string text = signature_ + "\n";
    if (!result.reference_spread.empty())
      text += Json{{"spread", result.reference_spread}}.dump() + "\n";
    for (std::size_t i = 0; i < result.runs.size(); ++i)
      if (result.runs[i].known) text += journal_entry(i, result.runs[i]).dump() + "\n";
    write_file(path_, text);
    stream_.open(path_, std::ios::app);
  }

  void add(const Json& json) {
    stream_ << json.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
    if (!stream_.flush()) throw OutputError("cannot write " + path_.string());
  }

 private:
  fs::path path_;
  std::string signature_;
  std::ofstream stream_;
};

/// Error of a run against a reference, by the measure's norm.
double error_of(const SweepMeasureName& measure, const Series& run, const Series& reference) {
  const auto named = [&](const Series& series) {
    for (const SeriesQuantity& q : quantities_of(series))
      if (q.name == measure.name || series.columns[q.columns[0]].name == measure.channels[0])
        return q;
    throw std::logic_error("no quantity " + measure.name);
  };
  const QuantityComparison c = compare_quantity(run, named(run), reference, named(reference));
  switch (measure.norm) {
    case Norm::kMax:
      return c.numbers.max;
    case Norm::kRms:
      return c.numbers.rms;
    case Norm::kFinal:
      return c.numbers.last;
  }
  return 0;
}

class Sweep {
 public:
  Sweep(const SweepOptions& options, const SweepPlan& plan, const Console& console,
        SweepResult& result, Journal& journal)
      : options_(options), plan_(plan), console_(console), result_(result), journal_(journal) {}

  /// @return whether it got to the end
  bool run() {
    for (std::size_t i = 0; i < plan_.points.size(); ++i)
      if (!result_.runs[i].known) left_.push_back(i);
    if (left_.empty()) return true;
    solve_references();
    if (interrupted()) return false;
    CountProgress progress(console_.progress(), plan_.label, plan_.points.size() - left_.size(),
                           plan_.points.size());
    std::mutex one_at_a_time;
    std::size_t done = plan_.points.size() - left_.size();
    on_threads(left_.size(), options_.jobs, [&](std::size_t k) {
      if (interrupted()) return;
      const SweepRun run = solve(left_[k]);
      if (interrupted()) return;  // cut short: not a result
      const std::lock_guard lock(one_at_a_time);
      journal_.add(journal_entry(left_[k], run));
      result_.runs[left_[k]] = run;
      progress.update(++done);
    });
    progress.finish();
    return !interrupted();
  }

 private:
  MeasuredRun measure(const Settings& settings, int repetitions) const {
    Looking looking{plan_.channels(), std::nullopt, repetitions};
    if (plan_.reference_kind == ReferenceKind::kFile) looking.instants = references_[0].time;
    return measured_run(options_.path, options_.scene, settings, looking, interrupted);
  }

  void read_reference() {
    Series reference = read_series(plan_.reference_file);
    // the run's names and units, so that both are found alike
    Series run;
    run.path = "the run";
    for (const SweepMeasureName& m : plan_.measures)
      for (const std::string& channel : m.channels)
        run.columns.push_back({channel, m.unit == "rad" ? "1" : m.unit, {}});
    for (const SeriesQuantity& theirs : quantities_of(reference)) {
      const auto ours = quantities_of(run);
      const SeriesQuantity* our = counterpart(ours, theirs);
      if (our == nullptr) continue;
      convert_units(reference, {*our, theirs}, run, {});
      for (std::size_t i = 0; i < our->width(); ++i)
        reference.columns[theirs.columns[i]].name = run.columns[our->columns[i]].name;
    }
    for (const SeriesColumn& column : run.columns)
      if (std::none_of(reference.columns.begin(), reference.columns.end(),
                       [&](const SeriesColumn& c) { return c.name == column.name; }))
        throw UsageError(plan_.reference_file + " has no column " + column.name);
    references_.push_back(std::move(reference));
  }

  void solve_references() {
    if (plan_.reference_kind == ReferenceKind::kFile) return read_reference();
    const std::size_t count = plan_.references.size();
    references_.resize(count);
    std::vector<Series> looser(plan_.looser.size());
    CountProgress progress(console_.progress(), plan_.label + " reference", 0,
                           count + looser.size());
    std::mutex one_at_a_time;
    std::size_t done = 0;
    on_threads(count + looser.size(), options_.jobs, [&](std::size_t k) {
      const bool tight = k < count;
      const Settings& settings = tight ? plan_.references[k] : plan_.looser[k - count];
      const MeasuredRun run = measure(settings, 1);
      if (interrupted()) return;
      if (!run.done())
        throw UsageError("the reference (" + settings_text(settings) + ") cannot be computed: " +
                         run.refusal + run.failure + "; name another one with --reference");
      (tight ? references_[k] : looser[k - count]) = run.series;
      const std::lock_guard lock(one_at_a_time);
      progress.update(++done);
    });
    progress.finish();
    if (interrupted() || looser.empty()) return;
    result_.reference_spread.assign(plan_.measures.size(), 0);
    for (std::size_t m = 0; m < plan_.measures.size(); ++m)
      for (std::size_t k = 0; k < looser.size(); ++k)
        result_.reference_spread[m] = std::max(
            result_.reference_spread[m], error_of(plan_.measures[m], looser[k], references_[k]));
    journal_.add({{"spread", result_.reference_spread}});
  }

  SweepRun solve(std::size_t index) const {
    const SweepPoint& point = plan_.points[index];
    const MeasuredRun measured = measure(point.settings, options_.repetitions);
    SweepRun run;
    run.known = true;
    run.refusal = measured.refusal;
    run.failure = measured.failure;
    run.cpu_seconds = measured.cpu_seconds;
    run.end_time = measured.end_time;
    run.statistics = measured.statistics;
    if (!run.done()) return run;
    for (const SeriesColumn& column : measured.series.columns)
      run.last.push_back(column.values.empty() ? 0 : column.values.back());
    if (references_.empty()) return run;
    for (const SweepMeasureName& m : plan_.measures)
      run.errors.push_back(error_of(m, measured.series, references_[point.reference]));
    return run;
  }

  const SweepOptions& options_;
  const SweepPlan& plan_;
  const Console& console_;
  SweepResult& result_;
  Journal& journal_;
  std::vector<std::size_t> left_;
  std::vector<Series> references_;
};

std::string reference_text(const SweepPlan& plan) {
  switch (plan.reference_kind) {
    case ReferenceKind::kTight:
    case ReferenceKind::kSettings:
      return "the run with " + settings_text(plan.references[0]) +
             (plan.references.size() > 1 ? " and so on" : "");
    case ReferenceKind::kFile:
      return plan.reference_file;
    case ReferenceKind::kNone:
      return "";
  }
  return "";
}

int sweep_into(const fs::path& path, const SweepPlan& plan, const SweepOptions& options,
               const Console& console) {
  const Stopwatch watch;
  const OutputFolder folder(path, {kReport, kSchema}, options.resume);
  SweepResult result{plan,
                     std::vector<SweepRun>(plan.points.size()),
                     {},
                     reference_text(plan),
                     0,
                     options.jobs > 0
                         ? options.jobs
                         : std::max(1, static_cast<int>(std::thread::hardware_concurrency())),
                     "running",
                     options.path,
                     options.given()};
  Journal journal(path / "sweep.journal", signature_of(plan, options));
  if (options.resume) journal.resume(result);
  journal.begin(result);
  write_file(path / kReport, to_json(result));  // marks the folder as ours
  const bool whole = Sweep(options, plan, console, result, journal).run();
  result.seconds = watch.seconds();
  result.status = whole ? "done" : "interrupted";
  const bool any = std::any_of(result.runs.begin(), result.runs.end(),
                               [](const SweepRun& run) { return run.done(); });
  analyse(result);
  write_sweep(result, path, console);
  write_file(path / kReport, to_json(result));
  if (console.json()) write_to_stdout(to_json(result));
  console.say(to_summary(result, path.string()));
  if (!whole) {
    console.error("interrupted: go on with --resume");
    return 128 + stop_signal();
  }
  if (any) return kExitDone;
  const SweepRun& first = result.runs.front();
  console.error("no run got to its end; the first: " + first.refusal + first.failure);
  return kExitSimulationFailed;
}

}  // namespace

int sweep_command(const Words& words) {
  const auto parsed = parse_sweep_options(words);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const SweepOptions& options = std::get<SweepOptions>(parsed);
  const Console console(options.console);
  return answer(options.path, options.scene, console, [&](const Scene& scene) {
    if (options.path == "-")
      throw UsageError("a sweep reads its scene again and again: name a file");
    const SweepPlan plan = make_plan(scene, options);
    try {
      return sweep_into(choose_output_folder(options.output, plan.label + "_sweep"), plan, options,
                        console);
    } catch (const TableError& error) {
      throw UsageError(error.what());
    } catch (const PairingError& error) {
      throw UsageError(error.what());
    }
  });
}

}  // namespace cprsim
