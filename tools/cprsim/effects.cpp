// SPDX-License-Identifier: BSD-3-Clause
// cprsim effects: a scene with one effect more or less, and what that changes and costs.
#include <fmt/core.h>

#include <algorithm>

#include "tools/cprsim/commands.h"
#include "tools/cprsim/effects_report.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/measured_run.h"
#include "tools/cprsim/output_folder.h"
#include "tools/cprsim/study_command.h"
#include "tools/cprsim/sweep_plan.h"
#include "tools/series/comparison.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

struct EffectsOptions {
  ConsoleOptions console;
  SceneOptions scene;
  std::string path, output, measure;
  int jobs = 0;
};

bool interrupted() {
  return stop_signal() != 0;
}

/// A variant of the scene, run beside the others.
struct Variant {
  SceneOptions options;
  Settings settings;
  MeasuredRun run;
};

/// The scene as it is, the same tighter, then each effect taken out or added.
std::vector<Variant> variants_of(const Scene& scene, const EffectsOptions& options,
                                 EffectsReport& report) {
  std::vector<Variant> variants{{options.scene, {}, {}}, {options.scene, {}, {}}};
  variants[1].settings = {{"points", "12"}, {"residual", "1e-11"}};
  if (scene.simulation.mode == Mode::kDynamic)
    variants[1].settings.insert(variants[1].settings.end(),
                                {{"scheme", "esdirk43"}, {"tolerance", "1e-8"}});
  for (int i = 0; i < kEffectCount; ++i) {
    const auto effect = static_cast<Effect>(i);
    const std::string name = effect_name(effect);
    const bool on = scene.effects.has(effect);
    if (on) report.effects.push_back(name);
    EffectRow row;
    row.effect = name;
    row.added = !on;
    report.rows.push_back(row);
    variants.push_back({options.scene, {}, {}});
    (on ? variants.back().options.without : variants.back().options.with).push_back(name);
  }
  return variants;
}

ErrorNumbers difference(const MeasuredRun& a, const MeasuredRun& b) {
  const SeriesQuantity quantity = quantities_of(a.series).front();
  return compare_quantity(a.series, quantity, b.series, quantities_of(b.series).front()).numbers;
}

void fill(const std::vector<Variant>& variants, EffectsReport& report) {
  const MeasuredRun& base = variants[0].run;
  report.cpu_seconds = base.cpu_seconds;
  report.evaluations = base.statistics.section_evaluations;
  report.duration = base.end_time;
  if (variants[1].run.done()) report.numerical_error = difference(base, variants[1].run).max;
  for (std::size_t k = 0; k < report.rows.size(); ++k) {
    const MeasuredRun& run = variants[k + 2].run;
    EffectRow& row = report.rows[k];
    row.problem = run.refusal + run.failure;
    if (!row.problem.empty()) continue;
    const ErrorNumbers numbers = difference(run, base);
    row.change = numbers.max;
    row.rms = numbers.rms;
    row.cpu_seconds = run.cpu_seconds;
    row.evaluations = run.statistics.section_evaluations;
  }
}

int study(const Scene& scene, const EffectsOptions& options, const Console& console) {
  SweepOptions where;
  where.path = options.path;
  where.reference = "none";
  where.vary = {{"points", {"1"}}};
  if (!options.measure.empty()) where.measure = {options.measure};
  const SweepPlan plan = make_plan(scene, where);
  EffectsReport report;
  report.label = plan.label;
  report.scene_path = options.path;
  report.measure = plan.measures[0].name;
  report.unit = plan.measures[0].unit;
  report.length = plan.length;
  report.options = given(options.scene);
  const OutputFolder folder(choose_output_folder(options.output, report.label + "_effects"),
                            {"effects.json", "cprsim-effects/"});
  std::vector<Variant> variants = variants_of(scene, options, report);
  const Looking looking{plan.channels(), std::nullopt, 3};
  on_threads(variants.size(), options.jobs, [&](std::size_t i) {
    variants[i].run =
        measured_run(options.path, variants[i].options, variants[i].settings, looking, interrupted);
  });
  if (interrupted()) return 128 + stop_signal();
  if (!variants[0].run.done()) {
    console.error("the scene as it is cannot be run: " + variants[0].run.refusal +
                  variants[0].run.failure);
    return kExitSimulationFailed;
  }
  fill(variants, report);
  write_effects(report, folder.path(), console);
  write_file(folder.path() / "effects.json", to_json(report));
  if (console.json()) write_to_stdout(to_json(report));
  console.say(to_summary(report, folder.path().string()));
  return kExitDone;
}

}  // namespace

int effects_command(const Words& words) {
  EffectsOptions options;
  CommandLine line(
      "cprsim effects",
      "Runs a scene as it is, and with each effect taken out or added: what each of them "
      "changes in the answer and costs in time.\n\n"
      "Examples\n"
      "  cprsim effects scene.xml\n"
      "  cprsim effects scene.xml --measure robot::leg_1(s=0.5).position --duration 0.5");
  line.scene(options.path);
  line.text("--measure", options.measure, "CHANNEL",
            "What is compared (default: the link that most rods hold, or a tip)");
  line.text("-o,--output", options.output, "DIR", "Folder (default out/<scene>_effects)");
  line.count("-j,--jobs", options.jobs, 1, "Threads (default: all cores)");
  add_scene_options(line, options.scene);
  add_console_options(line, options.console);
  if (const auto code = line.parse(words)) return *code;
  const Console console(options.console);
  return answer(options.path, options.scene, console, [&](const Scene& scene) {
    if (options.path == "-")
      throw UsageError("effects reads its scene again and again: name a file");
    return study(scene, options, console);
  });
}

}  // namespace cprsim
