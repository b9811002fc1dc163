// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/sweep_journal.h"

#include <nlohmann/json.hpp>

#include "tools/cprsim/command_line.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

using Json = nlohmann::json;

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

std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

void SweepJournal::resume(SweepResult& result) const {
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

void SweepJournal::begin(const SweepResult& result) {
  std::string text = signature_ + "\n";
  if (!result.reference_spread.empty()) text += line_of({{"spread", result.reference_spread}});
  for (std::size_t i = 0; i < result.runs.size(); ++i)
    if (result.runs[i].known) text += line_of(journal_entry(i, result.runs[i]));
  write_file(path_, text);
  stream_ = std::ofstream(path_, std::ios::app);
}

void SweepJournal::add(std::size_t index, const SweepRun& run) {
  add_line(line_of(journal_entry(index, run)));
}

void SweepJournal::add_spread(const std::vector<double>& spread) {
  add_line(line_of({{"spread", spread}}));
}

void SweepJournal::add_line(const std::string& line) {
  stream_ << line;
  if (!stream_.flush()) throw OutputError("cannot write " + path_.string());
}

}  // namespace cprsim
