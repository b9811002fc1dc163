// SPDX-License-Identifier: BSD-3-Clause
// cprsim sweep: a scene with many settings, and what accuracy costs.
#include <fmt/core.h>

#include <csignal>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/output_folder.h"
#include "tools/cprsim/progress.h"
#include "tools/cprsim/ranks.h"
#include "tools/cprsim/stopwatch.h"
#include "tools/cprsim/study_command.h"
#include "tools/cprsim/sweep_journal.h"
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
constexpr const char* kJournal = "sweep.journal";  // other processes' have a number behind it

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
        SweepResult& result, SweepJournal& journal)
      : options_(options), plan_(plan), console_(console), result_(result), journal_(journal) {}

  /// @param left indices of the points to be run
  /// @return whether it got to the end
  bool run(const std::vector<std::size_t>& left) {
    left_ = left;
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
      journal_.add(left_[k], run);
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
    journal_.add_spread(result_.reference_spread);
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
  SweepJournal& journal_;
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

/// Journals of processes other than the first.
std::vector<fs::path> other_journals(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().starts_with(std::string(kJournal) + "."))
      found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

/// What they hold becomes the first one's.
void take_over(const std::vector<fs::path>& journals, const std::string& signature,
               SweepResult& result) {
  for (const fs::path& path : journals)
    SweepJournal(path, signature).resume(result);
}

SweepResult nothing_done(const SweepPlan& plan, const SweepOptions& options, const Ranks& ranks) {
  return {plan,
          std::vector<SweepRun>(plan.points.size()),
          {},
          reference_text(plan),
          0,
          ranks.size() * (options.jobs > 0
                              ? options.jobs
                              : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))),
          "running",
          options.path,
          options.given()};
}

/// Every so many of the points that are left, told by the first process.
std::vector<std::size_t> share_of(const std::string& left, const Ranks& ranks) {
  const auto all = Json::parse(left).get<std::vector<std::size_t>>();
  std::vector<std::size_t> share;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (static_cast<int>(i % static_cast<std::size_t>(ranks.size())) == ranks.rank())
      share.push_back(all[i]);
  return share;
}

/// The part of a process that is not the first: into a journal of its own.
int help_along(const fs::path& path, const SweepPlan& plan, const SweepOptions& options,
               const Console& console, const Ranks& ranks) {
  SweepResult result = nothing_done(plan, options, ranks);
  const std::vector<std::size_t> share = share_of(ranks.tell(""), ranks);
  SweepJournal journal(path / fmt::format("{}.{}", kJournal, ranks.rank()),
                       signature_of(plan, options));
  journal.begin(result);
  const bool whole = Sweep(options, plan, console, result, journal).run(share);
  ranks.meet();
  return whole ? kExitDone : 128 + stop_signal();
}

int sweep_into(const fs::path& path, const SweepPlan& plan, const SweepOptions& options,
               const Console& console, const Ranks& ranks) {
  const Stopwatch watch;
  const OutputFolder folder(path, {kReport, kSchema}, options.resume);
  SweepResult result = nothing_done(plan, options, ranks);
  const std::string signature = signature_of(plan, options);
  SweepJournal journal(path / kJournal, signature);
  const auto earlier = other_journals(path);
  if (options.resume) journal.resume(result);
  if (options.resume) take_over(earlier, signature, result);
  journal.begin(result);
  for (const fs::path& other : earlier)
    fs::remove(other);
  write_file(path / kReport, to_json(result));  // marks the folder as ours
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < plan.points.size(); ++i)
    if (!result.runs[i].known) left.push_back(i);
  const std::vector<std::size_t> share = share_of(ranks.tell(Json(left).dump()), ranks);
  Sweep(options, plan, console, result, journal).run(share);
  ranks.meet();
  const auto others = other_journals(path);
  take_over(others, signature, result);
  if (!others.empty()) journal.begin(result);
  for (const fs::path& other : others)
    fs::remove(other);
  const bool whole = std::all_of(result.runs.begin(), result.runs.end(),
                                 [](const SweepRun& run) { return run.known; });
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
    return 128 + (interrupted() ? stop_signal() : SIGTERM);
  }
  if (any) return kExitDone;
  const SweepRun& first = result.runs.front();
  console.error("no run got to its end; the first: " + first.refusal + first.failure);
  return kExitSimulationFailed;
}

}  // namespace

int sweep_command(const Words& words) {
  auto parsed = parse_sweep_options(words);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  SweepOptions& options = std::get<SweepOptions>(parsed);
  const Ranks ranks;
  // a process is what a launcher counts in
  if (ranks.size() > 1 && options.jobs == 0) options.jobs = 1;
  if (!ranks.first()) {
    options.console.quiet = 2;
    options.console.json = false;
  }
  const Console console(options.console);
  return answer(options.path, options.scene, console, [&](const Scene& scene) {
    try {
      if (options.path == "-")
        throw UsageError("a sweep reads its scene again and again: name a file");
      const SweepPlan plan = make_plan(scene, options);
      const fs::path folder = choose_output_folder(options.output, plan.label + "_sweep");
      return ranks.first() ? sweep_into(folder, plan, options, console, ranks)
                           : help_along(folder, plan, options, console, ranks);
    } catch (const std::exception& error) {
      // others may be waiting for this one
      if (ranks.size() > 1) console.error(error.what());
      ranks.give_up(kExitUsage);
      throw;
    }
  });
}

}  // namespace cprsim
