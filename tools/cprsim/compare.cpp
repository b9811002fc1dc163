// SPDX-License-Identifier: BSD-3-Clause
// cprsim compare: a run, or any trajectory, against a reference.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "tools/cprsim/commands.h"
#include "tools/cprsim/compare_options.h"
#include "tools/cprsim/compare_report.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/output_folder.h"
#include "tools/cprsim/study_command.h"
#include "tools/series/pairing.h"
#include "tools/series/read_series.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

namespace fs = std::filesystem;

/// All recordings of a run as one series; they must have been made at the same instants.
Series merged(const RecordedRun& run) {
  Series all = run.recordings.front();
  all.path = run.folder;
  for (std::size_t i = 1; i < run.recordings.size(); ++i) {
    const Series& other = run.recordings[i];
    if (other.time != all.time) {
      throw UsageError(
          fmt::format("{} holds recordings at different instants; name one of them: {}", run.folder,
                      run.recordings[i].path));
    }
    for (const SeriesColumn& column : other.columns)
      if (std::none_of(all.columns.begin(), all.columns.end(),
                       [&](const SeriesColumn& c) { return c.name == column.name; }))
        all.columns.push_back(column);
  }
  return all;
}

/// --map: columns of the reference by the run's names.
void rename(Series& reference, const CompareOptions& options) {
  for (const auto& [name, called] : options.map) {
    bool found = false;
    for (SeriesColumn& column : reference.columns) {
      const bool fits =
          called.empty() || column.name == called || column.name.starts_with(called + ".");
      if (!fits) continue;
      found = true;
      column.name =
          called.empty() ? name + "." + column.name : name + column.name.substr(called.size());
    }
    if (!found)
      throw UsageError("--map: no column of " + reference.path + " is called '" + called + "'");
  }
}

std::vector<QuantityPair> pair_up(const Series& run, Series& reference,
                                  const CompareOptions& options, CompareReport& report) {
  const std::vector<SeriesQuantity> ours = quantities_of(run);
  std::vector<QuantityPair> pairs;
  for (const SeriesQuantity& theirs : quantities_of(reference)) {
    const SeriesQuantity* our = counterpart(ours, theirs);
    if (our == nullptr) {
      report.ignored.push_back(theirs.name);
      continue;
    }
    const bool asked = options.of.empty() || std::find(options.of.begin(), options.of.end(),
                                                       our->name) != options.of.end();
    if (!asked) continue;
    pairs.push_back({*our, theirs});
    convert_units(reference, pairs.back(), run, options.reference_units);
  }
  if (!pairs.empty()) return pairs;
  std::vector<std::string> names, their_names;
  for (const SeriesQuantity& q : ours)
    names.push_back(q.name);
  for (const SeriesQuantity& q : quantities_of(reference))
    their_names.push_back(q.name);
  throw UsageError(fmt::format("nothing to compare: the run has {}; the reference has {} (--map)",
                               fmt::join(names, ", "), fmt::join(their_names, ", ")));
}

/// Moves the reference to where its positions fit best.
Pose align(Alignment alignment, const Series& run, Series& reference,
           const std::vector<QuantityPair>& pairs, double lag) {
  std::vector<Vec3> x, r;
  for (const QuantityPair& pair : pairs) {
    if (pair.quantity.kind != QuantityKind::kVector || !pair.quantity.name.ends_with("position"))
      continue;
    const QuantityComparison c =
        compare_quantity(run, pair.quantity, reference, pair.reference, lag);
    for (std::size_t k = 0; k < c.time.size(); ++k) {
      x.emplace_back(c.value[k].head<3>());
      r.emplace_back(c.expected[k].head<3>());
    }
  }
  if (x.size() < 3) throw UsageError("--align needs positions at three instants or more");
  MatX X(3, x.size()), R(3, x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    X.col(static_cast<Eigen::Index>(k)) = x[k];
    R.col(static_cast<Eigen::Index>(k)) = r[k];
  }
  const Pose fitted = fit_frame(alignment, X, R);
  change_frame(reference, fitted);
  return fitted;
}

/// Whose lag is sought: what moves through space; anything if nothing does.
std::vector<QuantityPair> motions(const std::vector<QuantityPair>& pairs) {
  std::vector<QuantityPair> found;
  for (const QuantityPair& pair : pairs)
    if (pair.quantity.name.ends_with("position") || pair.quantity.kind == QuantityKind::kAttitude)
      found.push_back(pair);
  return found.empty() ? pairs : found;
}

void check_limits(const CompareOptions& options, CompareReport& report) {
  for (const auto& [kind, list] :
       {std::pair("rms", &options.rms), std::pair("max", &options.max)}) {
    for (const ErrorLimit& limit : *list) {
      const std::size_t before = report.limits.size();
      std::string unit;
      for (const QuantityComparison& c : report.quantities) {
        if (!limit.quantity.empty() && c.quantity.name != limit.quantity) continue;
        if (!unit.empty() && unit != shown_unit(c)) {
          throw UsageError(
              fmt::format("--{} {}: quantities in {} and {} are compared; write "
                          "--{} QUANTITY={} for each",
                          kind, limit.value, unit, shown_unit(c), kind, limit.value));
        }
        unit = shown_unit(c);
        const double value = kind == std::string("rms") ? c.numbers.rms : c.numbers.max;
        report.limits.push_back(
            {c.quantity.name, kind, limit.value, shown_factor(c) * value, unit});
      }
      if (report.limits.size() == before)
        throw UsageError(fmt::format("--{}: '{}' is not compared", kind, limit.quantity));
    }
  }
}

CompareReport compare(const CompareOptions& options) {
  CompareReport report;
  Series run;
  if (fs::is_directory(options.run)) {
    const RecordedRun recorded = read_run(options.run);
    run = merged(recorded);
    report.label = recorded.label;
    report.length = recorded.longest_rod;
  } else {
    run = read_series(options.run);
    report.label = fs::path(options.run).stem().string();
  }
  if (options.length) report.length = options.length;
  Series reference = read_series(options.reference);
  report.run_path = options.run;
  report.reference_path = options.reference;
  rename(reference, options);
  const std::vector<QuantityPair> pairs = pair_up(run, reference, options, report);
  if (options.tangent_is_x) put_tangent_on_z(reference);
  if (options.reference_frame) change_frame(reference, *options.reference_frame);

  report.lag = estimate_lag(run, reference, motions(pairs));
  if (options.apply_lag && !report.lag)
    throw UsageError(
        "--apply-lag: no lag can be found, the reference has too few instants or does "
        "not move");
  report.lag_applied = options.apply_lag;
  const double lag = options.apply_lag ? report.lag->seconds : 0;
  if (options.alignment != Alignment::kNone)
    report.aligned = align(options.alignment, run, reference, pairs, lag);
  report.instants = reference.size();
  bool any = false;
  for (const QuantityPair& pair : pairs) {
    report.quantities.push_back(
        compare_quantity(run, pair.quantity, reference, pair.reference, lag));
    const QuantityComparison& c = report.quantities.back();
    if (c.time.empty())
      throw UsageError("'" + pair.quantity.name + "': run and reference have no instant in common");
    if (auto vibration = compare_vibration(c)) report.vibrations.push_back(std::move(*vibration));
    report.from = any ? std::min(report.from, c.time.front()) : c.time.front();
    report.to = any ? std::max(report.to, c.time.back()) : c.time.back();
    any = true;
  }
  check_limits(options, report);
  return report;
}

}  // namespace

int compare_command(const Words& words) {
  const auto parsed = parse_compare_options(words);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const CompareOptions& options = std::get<CompareOptions>(parsed);
  const Console console(options.console);
  return complain_of(console, [&] {
    const CompareReport report = compare(options);
    const OutputFolder folder(choose_output_folder(options.output, report.label + "_compare"),
                              {"compare.json", "cprsim-compare/"});
    write_file(folder.path() / "compare.json", to_json(report));
    write_comparison(report, folder.path(), console);
    if (console.json()) write_to_stdout(to_json(report));
    console.say(to_summary(report, folder.path().string()));
    if (report.kept()) return kExitDone;
    console.error("the run is farther from the reference than allowed");
    return kExitExpectationFailed;
  });
}

}  // namespace cprsim
