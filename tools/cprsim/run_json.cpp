// SPDX-License-Identifier: BSD-3-Clause
// run.json: everything but `timings` and `host` is the same for two runs of one scene.
#include <sys/utsname.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tools/cprsim/names.h"
#include "tools/cprsim/run_report.h"
#include "tools/cprsim/version.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

Json scene_json(const Scene& scene, const RunReport& report) {
  return {{"path", report.scene_path},
          {"name", scene.name},
          {"hash", scene.hash},
          {"files", scene.files}};
}

Json host_json() {
  utsname system{};
  uname(&system);
  std::string processor, line;
  std::ifstream cpuinfo("/proc/cpuinfo");
  while (processor.empty() && std::getline(cpuinfo, line)) {
    if (line.rfind("model name", 0) == 0) processor = line.substr(line.find(':') + 2);
  }
  return {{"system", std::string(system.sysname) + " " + system.release},
          {"machine", system.machine},
          {"processor", processor},
          {"threads", std::thread::hardware_concurrency()}};
}

Json options_json(const RunReport& report) {
  Json options = Json::array();
  for (const auto& [name, value] : report.options) {
    options.push_back(value.empty() ? Json{{"name", name}}
                                    : Json{{"name", name}, {"value", value}});
  }
  return options;
}

Json effects_json(const Scene& scene) {
  Json effects = Json::object();
  for (int i = 0; i < kEffectCount; ++i) {
    const auto effect = static_cast<Effect>(i);
    Json entry = {{"on", scene.effects.has(effect)}};
    const std::string place =
        place_name(scene, scene.effects.asked_at[static_cast<std::size_t>(i)]);
    if (!place.empty()) entry["asked_at"] = place;
    effects[effect_name(effect)] = entry;
  }
  return effects;
}

Json rod_json(const RodFacts& rod) {
  return {{"name", rod.name},
          {"length", rod.length},
          {"mass", rod.mass},
          {"stiffness",
           {{"bending_x", rod.bending_x},
            {"bending_y", rod.bending_y},
            {"torsion", rod.torsion},
            {"axial", rod.axial},
            {"shear_x", rod.shear_x}}},
          {"first_frequency", rod.first_frequency},
          {"buckling_load", rod.buckling_load},
          {"growth_exponent", rod.growth_exponent},
          {"method", method_name(rod.method)},
          {"method_reason", rod.method_reason},
          {"section_law", rod.section_law},
          {"rule", rod.rule},
          {"elements", rod.elements},
          {"order", rod.order},
          {"segments", rod.segments},
          {"unknowns", rod.unknowns}};
}

Json method_json(const Scene& scene, const ProblemFacts& facts) {
  Json method = {{"mode", mode_name(scene.simulation.mode)},
                 {"method", method_name(scene.solver.method)},
                 {"kernel", facts.planar ? "planar" : "spatial"},
                 {"scheme", facts.scheme},
                 {"step", facts.step},
                 {"body_unknowns", facts.body_unknowns},
                 {"constraint_unknowns", facts.constraint_unknowns},
                 {"rods", Json::array()}};
  if (scene.solver.accuracy) method["accuracy"] = *scene.solver.accuracy;
  if (scene.solver.tolerance) method["tolerance"] = *scene.solver.tolerance;
  if (scene.solver.residual_tolerance)
    method["residual_tolerance"] = *scene.solver.residual_tolerance;
  for (const RodFacts& rod : facts.rods)
    method["rods"].push_back(rod_json(rod));
  return method;
}

Json statistics_json(const RunStatistics& statistics) {
  return {{"steps", statistics.steps},
          {"rejected", statistics.rejected},
          {"retried", statistics.retried},
          {"smallest_step", statistics.smallest_step},
          {"largest_step", statistics.largest_step},
          {"start_iterations", statistics.start_iterations},
          {"iterations", statistics.iterations},
          {"max_iterations", statistics.max_iterations},
          {"section_evaluations", statistics.section_evaluations},
          {"factorizations", statistics.factorizations},
          {"worst_residual", statistics.worst_residual}};
}

Json energy_json(const Extremes& extremes) {
  const EnergySample& energy = extremes.energy();
  Json json = {{"kinetic", energy.kinetic},
               {"elastic", energy.elastic},
               {"gravity", energy.gravity},
               {"magnetic", energy.magnetic},
               {"dissipated", energy.dissipated},
               {"work", energy.work},
               {"total", energy.total},
               {"balance", energy.balance},
               {"worst_balance", extremes.worst_balance()},
               {"exchanged", extremes.exchanged()}};
  if (const auto relative = extremes.relative_balance()) json["worst_relative_balance"] = *relative;
  return json;
}

Json failure_json(const RunReport& report) {
  Json failure = {{"code", report.failure_code},
                  {"reason", to_string(report.end)},
                  {"message", report.failure},
                  {"time", report.time}};
  if (report.end != RunEnd::kFailed) return failure;
  const SolveReport& solve = report.last_solve;
  failure["solve"] = {{"status", to_string(solve.status)}, {"stage", to_string(solve.stage)},
                      {"iterations", solve.iterations},    {"residual", solve.residual},
                      {"worst_row", solve.worst_row},      {"growth", solve.growth},
                      {"loads_carried", solve.loaded},     {"residual_history", solve.history}};
  failure["likely_causes"] = report.likely_causes;
  return failure;
}

Json expectation_json(const Scene& scene, const ExpectResult& result) {
  Json checks = Json::array();
  for (const CheckResult& check : result.checks) {
    Json entry = {{"kind", check.kind}, {"verdict", to_string(check.verdict)}};
    const std::string place = place_name(scene, check.place);
    if (!place.empty()) entry["asked_at"] = place;
    if (!check.channel.empty()) {
      entry["channel"] = check.channel;
      entry["limit"] = check.limit;
      entry["value"] = check.value;
      entry["time"] = check.time;
    }
    checks.push_back(entry);
  }
  return {{"name", result.name}, {"verdict", to_string(result.verdict)}, {"checks", checks}};
}

/// Those at least this severe.
Json diagnostics_json(const std::vector<Diagnostic>& diagnostics, Severity least) {
  Json list = Json::array();
  for (const Diagnostic& d : diagnostics) {
    if (d.severity >= least) list.push_back(Json::parse(to_json(d)));
  }
  return list;
}

Json timings_json(const RunReport& report) {
  const Timings& timings = report.timings;
  Json json = {{"started", timings.started},
               {"jobs", timings.jobs},
               {"total", timings.total},
               {"load", timings.load},
               {"build", timings.build},
               {"start", timings.start},
               {"steps", timings.steps},
               {"outputs", timings.outputs},
               {"real_time_factor", report.real_time_factor()}};
  if (!report.phases) return json;
  for (int i = 0; i < kPhaseCount; ++i) {
    const PhaseClock::Sum& sum = (*report.phases)[static_cast<std::size_t>(i)];
    json["phases"][to_string(static_cast<Phase>(i))] = {{"seconds", sum.seconds},
                                                        {"count", sum.count}};
  }
  return json;
}

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string to_json(const Scene& scene, const RunReport& report) {
  Json json = {{"schema", "cprsim-run/1"},
               {"status", to_string(report.end)},
               {"interrupted", report.interrupted()},
               {"exit_code", report.exit_code},
               {"label", report.label},
               {"scene", scene_json(scene, report)},
               {"version",
                {{"number", version().number},
                 {"revision", version().revision},
                 {"build", version().build}}},
               {"options", options_json(report)},
               {"effects", effects_json(scene)},
               {"method", method_json(scene, report.facts)},
               {"time", report.time},
               {"end_time", report.end_time},
               {"statistics", statistics_json(report.statistics)},
               {"energy", energy_json(report.extremes)},
               {"largest_penetration", report.extremes.deepest_penetration()},
               {"warnings", diagnostics_json(report.diagnostics, Severity::kWarning)},
               {"expectations", Json::array()},
               {"files", Json::array()}};
  for (const ExpectResult& result : report.expectations) {
    json["expectations"].push_back(expectation_json(scene, result));
  }
  for (const WrittenFile& file : report.files) {
    json["files"].push_back({{"name", file.name}, {"kind", file.kind}, {"count", file.count}});
  }
  if (!report.stability.empty())
    json["stability"] = {{"verdict", report.stability},
                         {"unstable_directions", report.unstable_directions}};
  if (report.accuracy) {
    const AccuracyReport& accuracy = *report.accuracy;
    json["accuracy"] = {{"asked", accuracy.asked},
                        {"unit", accuracy.unit},
                        {"estimate", accuracy.estimate},
                        {"reached", accuracy.reached()},
                        {"runs", accuracy.runs},
                        {"section_evaluations_before", accuracy.evaluations},
                        {"fixed_by_the_scene", accuracy.held_back}};
  }
  if (report.real_time) {
    const RealTimeReport& real_time = *report.real_time;
    json["real_time"] = {{"asked", real_time.asked},
                         {"factor_of_the_trial", real_time.factor},
                         {"kept_up", real_time.kept_up()},
                         {"accuracy", real_time.accuracy},
                         {"estimate", real_time.estimate ? Json(*real_time.estimate) : Json()},
                         {"runs", real_time.runs}};
  }
  if (!report.failure.empty()) json["failure"] = failure_json(report);
  if (!report.film_device.empty()) json["drawn_by"] = report.film_device;
  json["host"] = host_json();
  json["timings"] = timings_json(report);
  return text_of(json);
}

std::string rejection_json(const std::string& path, int exit_code,
                           const std::vector<Diagnostic>& diagnostics) {
  return text_of({{"schema", "cprsim-run/1"},
                  {"status", "rejected"},
                  {"exit_code", exit_code},
                  {"scene", {{"path", path}}},
                  {"diagnostics", diagnostics_json(diagnostics, Severity::kNote)}});
}

}  // namespace cprsim
