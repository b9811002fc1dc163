// SPDX-License-Identifier: BSD-3-Clause
// cprsim workspace: many equilibria, and which of them a robot can use.
#include <fmt/core.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/output_folder.h"
#include "tools/cprsim/progress.h"
#include "tools/cprsim/stopwatch.h"
#include "tools/cprsim/study_command.h"
#include "tools/cprsim/workspace_outputs.h"
#include "tools/cprsim/workspace_table.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

namespace fs = std::filesystem;

/// Points as they come, one line each, on disk at once: what an interruption leaves behind.
class Journal {
 public:
  Journal(fs::path path, const WorkspaceTable& table) : path_(std::move(path)), table_(table) {}

  /// The whole lines of an earlier sweep; a line that a kill cut off is left out.
  std::vector<WorkspacePoint> read() const {
    std::vector<WorkspacePoint> points;
    std::ifstream stream(path_, std::ios::binary);
    for (std::string line; std::getline(stream, line) && !stream.eof();)
      if (const auto point = table_.read(line)) points.push_back(*point);
    return points;
  }

  void begin(const std::vector<WorkspacePoint>& points) {
    std::string text;
    for (const WorkspacePoint& point : points)
      text += table_.row(point);
    write_file(path_, text);
    stream_.open(path_, std::ios::binary | std::ios::app);
  }

  void add(const WorkspacePoint& point) {
    stream_ << table_.row(point);
    if (!stream_.flush()) throw OutputError("cannot write " + path_.string());
  }

  void remove() {
    stream_.close();
    std::error_code ignored;
    fs::remove(path_, ignored);
  }

 private:
  fs::path path_;
  const WorkspaceTable& table_;
  std::ofstream stream_;
};

/// Complains if the folder holds a sweep of other points.
void require_same(const fs::path& folder, const std::string& signature) {
  std::ifstream stream(folder / kWorkspaceReport);
  if (!stream) return;
  const nlohmann::json report = nlohmann::json::parse(stream, nullptr, false);
  if (report.is_object() && report.value("schema", "").rfind(kWorkspaceSchema, 0) == 0 &&
      report.value("signature", "") == signature)
    return;
  throw UsageError("--resume: " + folder.string() +
                   " holds a sweep of another scene, with other options or of another cprsim; "
                   "choose another folder with -o or leave --resume out");
}

/// Points solved earlier: in the journal of an interrupted sweep, or in the table of a whole one.
std::vector<WorkspacePoint> earlier_points(const fs::path& folder, const Journal& journal,
                                           const WorkspaceTable& table) {
  if (fs::exists(folder / kWorkspaceJournal)) return journal.read();
  return Journal(folder / "points.csv", table).read();
}

/// Sweeps what is left. @return whether it got to the end
bool sweep(const WorkspaceTask& task, const Console& console, Journal& journal,
           WorkspaceReport& report) {
  std::vector<const WorkspacePoint*> known(task.points.size(), nullptr);
  const std::vector<WorkspacePoint> earlier = std::move(report.points);
  for (const WorkspacePoint& point : earlier)
    known[point.index] = &point;
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (known[i] == nullptr) left.push_back(i);
  report.before = known.size() - left.size();
  CountProgress progress(console.progress(), report.label, report.before, known.size());
  std::vector<WorkspacePoint> found;
  found.reserve(left.size());
  solve_points(
      task.scene, task.question, task.points, left, report.jobs,
      [&](const WorkspacePoint& point) {
        journal.add(point);
        found.push_back(point);
        progress.update(report.before + found.size());
      },
      [] { return stop_signal() != 0; });
  progress.finish();
  for (const WorkspacePoint& point : found)
    known[point.index] = &point;
  report.points.clear();
  for (const WorkspacePoint* point : known)
    if (point != nullptr) report.points.push_back(*point);
  return report.points.size() == task.points.size();
}

int sweep_into(const fs::path& path, const WorkspaceTask& task, const WorkspaceOptions& options,
               const Console& console, WorkspaceReport& report) {
  const Stopwatch watch;
  const OutputFolder folder(path, {kWorkspaceReport, kWorkspaceSchema}, options.resume);
  const WorkspaceTable table(task);
  Journal journal(path / kWorkspaceJournal, table);
  if (options.resume) {
    require_same(path, signature_of(task, report));
    report.points = earlier_points(path, journal, table);
  }
  journal.begin(report.points);
  write_file(path / kWorkspaceReport, to_json(task, report));  // marks the folder as ours
  const bool whole = sweep(task, console, journal, report);
  report.seconds = watch.seconds();
  report.status = whole ? "done" : "interrupted";
  const bool none = count(report.points).reached == 0;
  report.exit_code = !whole ? 128 + stop_signal() : none ? kExitSimulationFailed : kExitDone;
  write_points(task, report, path, options.view);
  write_file(path / kWorkspaceReport, to_json(task, report));
  if (whole) journal.remove();
  if (console.json()) write_to_stdout(to_json(task, report));
  console.say(to_summary(task, report, path.string()));
  if (!whole) {
    console.error(fmt::format("interrupted by {} after {} of {} points: go on with --resume",
                              stop_signal() == SIGINT ? "SIGINT" : "SIGTERM", report.points.size(),
                              task.points.size()));
  } else if (none) {
    console.error("no point is reached");
  }
  return report.exit_code;
}

}  // namespace

int workspace_command(const Words& words) {
  const auto parsed = parse_workspace_options(words);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const WorkspaceOptions& options = std::get<WorkspaceOptions>(parsed);
  const Console console(options.console);
  return answer(options.path, options.scene, console, [&](const Scene& scene) {
    const WorkspaceTask task = make_task(scene, options);
    WorkspaceReport report;
    report.label = label_of(options.path, scene);
    report.scene_path = options.path;
    report.options = options.given();
    report.jobs = options.jobs > 0
                      ? options.jobs
                      : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const fs::path folder = choose_output_folder(options.output, report.label + "_workspace");
    return sweep_into(folder, task, options, console, report);
  });
}

}  // namespace cprsim
