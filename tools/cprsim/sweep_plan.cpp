// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/sweep_plan.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenes/loader/solver_setting.h"
#include "scenes/loader/values.h"
#include "tools/cprsim/accuracy_control.h"
#include "tools/cprsim/resolution.h"
#include "tools/series/read_series.h"
#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

constexpr std::size_t kMost = 100000;

bool of_solver(const std::string& name) {
  return is_solver_setting(name) || name.find("cprsim:solver/") != std::string::npos ||
         name.find("/solver/") != std::string::npos || name.ends_with("max_step_size");
}

bool numeric(const SweepAxis& axis) {
  return axis.values.size() > 1 &&
         std::all_of(axis.values.begin(), axis.values.end(),
                     [](const std::string& value) { return parse_number(value).has_value(); });
}

/// The axis along which a line of the diagram goes: the last that refines, else the last number.
std::string refined_of(const std::vector<SweepAxis>& grid) {
  for (auto axis = grid.rbegin(); axis != grid.rend(); ++axis)
    if (of_solver(axis->name) && numeric(*axis)) return axis->name;
  for (auto axis = grid.rbegin(); axis != grid.rend(); ++axis)
    if (numeric(*axis)) return axis->name;
  return "";
}

/// What the runs of a line have in common, and what they refine: "esdirk43 / points 6 / step". No
/// commas: gnuplot finds its lines by this name in a table.
std::string line_of(const Settings& settings, const std::string& refined) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : settings) {
    if (name == refined) continue;
    const bool says_itself = name == "scheme" || name == "integrator" || name == "method";
    parts.push_back(says_itself ? value : name + " " + value);
  }
  if (!refined.empty()) parts.push_back(refined);
  return fmt::format("{}", fmt::join(parts, " / "));
}

void add_grid(const std::vector<SweepAxis>& grid, SweepPlan& plan) {
  std::size_t count = 1;
  for (const SweepAxis& axis : grid) {
    count *= axis.values.size();
    if (count > kMost) throw UsageError(fmt::format("a sweep has at most {} runs", kMost));
    if (std::find(plan.axes.begin(), plan.axes.end(), axis.name) == plan.axes.end())
      plan.axes.push_back(axis.name);
  }
  const std::string refined = refined_of(grid);
  for (std::size_t k = 0; k < count; ++k) {
    SweepPoint point;
    std::size_t rest = k;
    for (auto axis = grid.rbegin(); axis != grid.rend(); ++axis) {  // the last axis fastest
      point.settings.emplace_back(axis->name, axis->values[rest % axis->values.size()]);
      rest /= axis->values.size();
    }
    std::reverse(point.settings.begin(), point.settings.end());
    point.refined = refined;
    point.line = line_of(point.settings, refined);
    plan.points.push_back(std::move(point));
  }
}

const SweepSpec* sweep_of(const Scene& scene, const SweepOptions& options) {
  if (!options.vary.empty() || options.sweep == "all") return nullptr;
  std::vector<std::string> names;
  for (const SweepSpec& spec : scene.sweeps) {
    if (options.sweep.empty() || spec.name == options.sweep) return &spec;
    names.push_back(spec.name);
  }
  if (options.sweep.empty()) return nullptr;
  throw UsageError("--sweep: " + not_one_of(options.sweep, "a sweep of the scene", names));
}

SweepMeasureName measure_named(const Scene& scene, const std::string& name, Norm norm) {
  SweepMeasureName measure{name, "", {}, norm};
  for (const Channel& channel : find_channels(scene, name)) {
    measure.channels.push_back(channel.name);
    measure.unit = channel.quantity == Quantity::kOrientation ? "rad" : channel.unit;
  }
  if (measure.channels.empty())
    throw UsageError(fmt::format("--measure: there is no channel '{}'; near it: {}", name,
                                 fmt::join(nearest_channels(scene, name), ", ")));
  const std::size_t count = measure.channels.size();
  if (count != 1 && count != 3 && count != 4)
    throw UsageError(
        fmt::format("--measure {}: one number, a vector or an orientation is compared, "
                    "these are {} numbers",
                    name, count));
  return measure;
}

Norm norm_named(const std::string& name) {
  return name == "rms" ? Norm::kRms : name == "final" ? Norm::kFinal : Norm::kMax;
}

/// name=value,name=value
Settings settings_of(const std::string& text) {
  Settings settings;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, end - at);
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--reference: '" + part + "' is not of the form NAME=VALUE");
    settings.emplace_back(part.substr(0, equals), part.substr(equals + 1));
    at = end + 1;
  }
  return settings;
}

/// Cells that shooting cuts the scene's rods into, of the one with most of them: more than six
/// where a rod is wound up or tied.
int usual_cells(Scene scene) {
  constexpr int kPlain = 6;
  int most = kPlain;
  free_settings(scene.solver);
  scene.solver.accuracy.reset();
  scene.solver.method = Method::kShooting;
  try {
    for (const Resolution& rod : resolution_of(scene))
      if (rod.method == Method::kShooting) most = std::max(most, rod.elements);
  } catch (const std::invalid_argument&) {
    return kPlain;  // not by shooting: runs will say why
  }
  return most;
}

/// So many times the usual, of a rod that usually has six.
std::vector<std::string> cells_as(const std::vector<int>& of_six, int usual) {
  std::vector<std::string> values;
  for (const int n : of_six)
    values.push_back(std::to_string((n * usual + 5) / 6));
  return values;
}

/// A solution that is tight in space and time, and one that is less so.
std::pair<Settings, Settings> tight_settings(const SweepPlan& plan, const SweepOptions& options,
                                             const char* scheme) {
  double tolerance = 1e-6;
  int points = plan.usual_cells;
  for (const SweepPoint& point : plan.points)
    for (const auto& [name, value] : point.settings) {
      const double number = parse_number(value).value_or(0);
      if (name == "tolerance" && number > 0) tolerance = std::min(tolerance, number);
      if (name == "points")
        points = std::max(points, static_cast<int>(std::min(number, 4.0 * plan.usual_cells)));
    }
  tolerance = std::max(tolerance / 100, options.quick ? 1e-9 : 1e-11);
  points *= 2;
  const Settings space{{"method", "shooting"},
                       {"integrator", "gauss6"},
                       {"points", std::to_string(points)},
                       {"residual", "1e-12"}};
  Settings tight = space, loose = space;
  loose[2].second = std::to_string(points / 2);
  if (plan.dynamic) {
    tight.insert(tight.end(),
                 {{"scheme", scheme}, {"tolerance", fmt::format("{:.0e}", tolerance)}});
    loose.insert(loose.end(),
                 {{"scheme", scheme}, {"tolerance", fmt::format("{:.0e}", 10 * tolerance)}});
  }
  return {tight, loose};
}

/// One reference for each combination of values that are not settings of the solver.
void add_references(const SweepOptions& options, const SweepSpec* spec, SweepPlan& plan) {
  if (options.reference == "none") {
    plan.reference_kind = ReferenceKind::kNone;
    return;
  }
  if (!options.reference.empty() && std::filesystem::exists(options.reference)) {
    plan.reference_kind = ReferenceKind::kFile;
    plan.reference_file = options.reference;
    return;
  }
  Settings tight, loose;
  if (options.reference == "ida") {
    if (!plan.dynamic) throw UsageError("--reference ida is for motions: nothing moves here");
    std::tie(tight, loose) = tight_settings(plan, options, "ida");
  } else if (!options.reference.empty() && options.reference != "tight") {
    plan.reference_kind = ReferenceKind::kSettings;
    tight = settings_of(options.reference);
  } else if (spec != nullptr && spec->reference) {
    plan.reference_kind = ReferenceKind::kSettings;
    tight = {{spec->vary.front().path, *spec->reference}};
  } else {
    std::tie(tight, loose) = tight_settings(plan, options, "esdirk43");
  }
  for (SweepPoint& point : plan.points) {
    Settings own;
    for (const auto& setting : point.settings)
      if (!of_solver(setting.first)) own.push_back(setting);
    Settings reference = own, looser = own;
    reference.insert(reference.end(), tight.begin(), tight.end());
    looser.insert(looser.end(), loose.begin(), loose.end());
    const auto known = std::find(plan.references.begin(), plan.references.end(), reference);
    point.reference = static_cast<std::size_t>(known - plan.references.begin());
    if (known != plan.references.end()) continue;
    plan.references.push_back(reference);
    if (!loose.empty()) plan.looser.push_back(looser);
  }
}

}  // namespace

std::string default_channel(const Scene& scene) {
  std::vector<int> held(scene.bodies.size(), 0);
  for (const RodSpec& rod : scene.rods)
    if (rod.tip.joint != EndJoint::kFree && rod.tip.at.body >= 0)
      ++held[static_cast<std::size_t>(rod.tip.at.body)];
  const auto most = std::max_element(held.begin(), held.end());
  if (most != held.end() && *most > 0)
    return scene.bodies[static_cast<std::size_t>(most - held.begin())].name + ".position";
  if (!scene.rods.empty()) return scene.rods.front().name + ".tip.position";
  if (!scene.bodies.empty()) return scene.bodies.back().name + ".position";
  throw UsageError("nothing in the scene moves; name a channel with --measure");
}

std::vector<std::string> SweepPlan::channels() const {
  std::vector<std::string> all;
  for (const SweepMeasureName& measure : measures)
    all.insert(all.end(), measure.channels.begin(), measure.channels.end());
  return all;
}

std::vector<std::vector<SweepAxis>> default_grids(const Scene& scene, bool quick) {
  using Values = std::vector<std::string>;
  const auto pick = [quick](const Values& all, const Values& few) { return quick ? few : all; };
  const int usual = usual_cells(scene);
  std::vector<std::vector<SweepAxis>> grids;
  if (!scene.accuracy_goal &&
      !scene.rods.empty()) {  // what the program chooses by itself, with what choosing costs
    Values errors;
    for (const int digits : quick ? std::vector<int>{3, 5} : std::vector<int>{2, 3, 4, 5, 6})
      errors.push_back(fmt::format("{:.3g}", longest_rod(scene) * std::pow(10, -digits)));
    grids.push_back({{"accuracy", errors}});
  }
  if (scene.simulation.mode != Mode::kDynamic) {
    const Values points = cells_as(
        quick ? std::vector<int>{2, 4, 8} : std::vector<int>{1, 2, 3, 4, 6, 9, 12, 18, 24}, usual);
    const SweepAxis shooting{"method", {"shooting"}};
    grids.push_back({shooting, {"integrator", {"gauss2", "gauss4", "gauss6"}}, {"points", points}});
    grids.push_back(
        {shooting,
         {"integrator", pick({"euler", "rk4"}, {"rk4"})},
         {"points", cells_as(quick ? std::vector<int>{12, 24} : std::vector<int>{6, 12, 24, 48, 96},
                             usual)}});
    grids.push_back({{"method", {"strain"}},
                     {"order", pick({"2", "4", "6", "8", "10", "12"}, {"2", "4", "8"})}});
    grids.push_back({{"method", {"collocation"}},
                     {"degree", pick({"3", "5"}, {"5"})},
                     {"elements", pick({"2", "4", "8", "16", "32"}, {"4", "8"})}});
    return grids;
  }
  const double h = scene.max_step_size;
  Values steps, tolerances;
  for (const double factor :
       quick ? std::vector<double>{4, 1} : std::vector<double>{8, 4, 2, 1, 0.5, 0.25})
    if (factor * h * 20 <= scene.simulation.duration)
      steps.push_back(fmt::format("{:.6g}", factor * h));
  for (const int digits : quick ? std::vector<int>{4, 6} : std::vector<int>{3, 4, 5, 6, 7, 8})
    tolerances.push_back(fmt::format("1e-{}", digits));
  const SweepAxis shooting{"method", {"shooting"}},
      points{"points", cells_as(quick ? std::vector<int>{6} : std::vector<int>{3, 6}, usual)};
  if (!steps.empty())
    grids.push_back({shooting,
                     points,
                     {"scheme",
                      {"backward_euler", "bdf2", "bdf_alpha", "generalized_alpha", "tr_bdf2",
                       "esdirk32", "esdirk43", "radau5"}},
                     {"step", steps}});
  Values adaptive{"tr_bdf2", "esdirk32", "esdirk43"};
  if (!scene.effects.has(Effect::kContact) && !scene.effects.has(Effect::kSelfContact))
    adaptive.emplace_back("ida");
  grids.push_back({shooting, points, {"scheme", adaptive}, {"tolerance", tolerances}});
  grids.push_back({{"method", {"strain"}},
                   {"order", pick({"4", "6"}, {"6"})},
                   {"scheme", {"esdirk43"}},
                   {"tolerance", tolerances}});
  grids.push_back({{"method", {"collocation"}},
                   {"elements", pick({"4", "8"}, {"4"})},
                   {"scheme", {"esdirk43"}},
                   {"tolerance", tolerances}});
  return grids;
}

SweepPlan make_plan(const Scene& scene, const SweepOptions& options) {
  SweepPlan plan;
  plan.label = label_of(options.path, scene);
  plan.scene_hash = scene.hash;
  plan.dynamic = scene.simulation.mode == Mode::kDynamic;
  plan.duration = scene.simulation.mode == Mode::kStatic ? 0 : scene.simulation.duration;
  for (const RodSpec& rod : scene.rods)
    plan.length = std::max(plan.length, rod.length);
  plan.usual_cells = usual_cells(scene);
  const SweepSpec* spec = sweep_of(scene, options);
  if (!options.vary.empty()) {
    add_grid(options.vary, plan);
  } else if (spec != nullptr) {
    std::vector<SweepAxis> grid;
    for (const SweepVary& vary : spec->vary)
      grid.push_back({vary.path, vary.values});
    add_grid(grid, plan);
  } else {
    for (const auto& grid : default_grids(scene, options.quick))
      add_grid(grid, plan);
  }
  const auto norm = [&](Norm asked) {
    return options.norm.empty() ? asked : norm_named(options.norm);
  };
  for (const std::string& name : options.measure)
    plan.measures.push_back(measure_named(scene, name, norm(Norm::kMax)));
  if (plan.measures.empty() && spec != nullptr)
    for (const SweepMeasure& measure : spec->measures)
      plan.measures.push_back(measure_named(scene, measure.name, norm(measure.norm)));
  if (plan.measures.empty())
    plan.measures.push_back(measure_named(scene, default_channel(scene), norm(Norm::kMax)));
  add_references(options, spec, plan);
  return plan;
}

}  // namespace cprsim
