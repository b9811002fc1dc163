// SPDX-License-Identifier: BSD-3-Clause
// cprsim info: what is in a scene, what follows from it, and which effects would matter.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <tuple>

#include "tools/cprsim/advisor.h"
#include "tools/cprsim/build_simulation.h"
#include "tools/cprsim/commands.h"
#include "tools/cprsim/estimates.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/names.h"
#include "tools/cprsim/scene_options.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

/// Rods that differ in nothing but their name.
struct RodGroup {
  const RodFacts* facts;
  std::vector<std::string> names;
};

bool alike(const RodFacts& a, const RodFacts& b) {
  const auto numbers = [](const RodFacts& r) {
    return std::vector<double>{
        r.mass,           r.bending_x,        r.bending_y,     r.torsion,         r.axial,
        r.shear_x,        r.first_frequency,  r.buckling_load, r.growth_exponent, r.gravity_number,
        r.shear_number,   r.extension_number, r.damping_ratio, r.drag_number,     r.magnetic_number,
        r.thermal_number, r.rotary_number};
  };
  const auto pieces = [](const RodFacts& r) {
    return std::tuple(r.method, r.method_reason, r.section_law, r.rule, r.elements, r.order,
                      r.segments);
  };
  return numbers(a) == numbers(b) && pieces(a) == pieces(b);
}

std::vector<RodGroup> groups_of(const ProblemFacts& facts) {
  std::vector<RodGroup> groups;
  for (const RodFacts& rod : facts.rods) {
    auto group = groups.begin();
    while (group != groups.end() && !alike(*group->facts, rod))
      ++group;
    if (group == groups.end()) group = groups.insert(group, RodGroup{&rod, {}});
    group->names.push_back(rod.name);
  }
  return groups;
}

std::string contents_text(const Scene& scene) {
  std::string text = fmt::format("{}: {} bodies, {} joints, {} rods, {} drives, {} loads\n",
                                 scene.name, scene.bodies.size(), scene.joints.size(),
                                 scene.rods.size(), scene.drives.size(), scene.loads.size());
  text += fmt::format("  mode       {}", mode_name(scene.simulation.mode));
  if (scene.simulation.mode != Mode::kStatic) {
    text += fmt::format(", {} s", scene.simulation.duration);
  }
  return text + "\n";
}

std::string solver_text(const ProblemFacts& facts) {
  std::string text = "  solver     " + pieces_text(facts);
  if (facts.planar) text += ", planar";
  if (!facts.scheme.empty()) text += ", " + facts.scheme;
  if (facts.step > 0) text += fmt::format(", step {} s", facts.step);
  return text + fmt::format("; {} body unknowns, {} constraint unknowns\n", facts.body_unknowns,
                            facts.constraint_unknowns);
}

std::string effects_text(const Scene& scene) {
  std::string on = "effects on\n  bending, torsion     always\n", off;
  for (int i = 0; i < kEffectCount; ++i) {
    const auto effect = static_cast<Effect>(i);
    if (!scene.effects.has(effect)) {
      off += std::string(" ") + effect_name(effect);
      continue;
    }
    const std::string place =
        place_name(scene, scene.effects.asked_at[static_cast<std::size_t>(i)]);
    on += fmt::format("  {:<20} {}\n", effect_name(effect), place.empty() ? "--with" : place);
  }
  return on + (off.empty() ? "" : "effects off\n " + off + "\n");
}

const char* kind_name(JointKind kind) {
  switch (kind) {
    case JointKind::kRevolute:
      return "revolute";
    case JointKind::kContinuous:
      return "continuous";
    case JointKind::kPrismatic:
      return "prismatic";
    case JointKind::kBall:
      return "ball";
    case JointKind::kUniversal:
      return "universal";
    case JointKind::kScrew:
      return "screw";
    case JointKind::kCylindrical:
      return "cylindrical";
    case JointKind::kPlanar:
      return "planar";
    case JointKind::kFixed:
      break;
  }
  return "fixed";
}

const char* drive_name(const Scene& scene, std::size_t joint, int axis) {
  for (const DriveSpec& drive : scene.drives) {
    if (drive.joint != static_cast<int>(joint) || drive.freedom != axis) continue;
    if (drive.quantity == DriveQuantity::kPosition) return "position drive";
    return drive.quantity == DriveQuantity::kVelocity ? "velocity drive" : "effort drive";
  }
  return "free";
}

/// What drives and resists each axis of a joint.
std::vector<std::string> axis_texts(const Scene& scene, std::size_t index) {
  const JointSpec& joint = scene.joints[index];
  std::vector<std::string> texts;
  const int count = joint.kind == JointKind::kBall ? 1 : freedom_count(joint.kind);
  for (int i = 0; i < count; ++i) {
    const AxisSpec& axis = axis_of(joint, i);
    std::string text = drive_name(scene, index, i);
    if (axis.limited()) text += fmt::format(", limits {:.6g} to {:.6g}", axis.lower, axis.upper);
    if (axis.spring_stiffness > 0) text += fmt::format(", spring {:.6g}", axis.spring_stiffness);
    if (axis.damping > 0) text += fmt::format(", damping {:.6g}", axis.damping);
    if (axis.friction > 0) text += fmt::format(", friction {:.6g}", axis.friction);
    texts.push_back(std::move(text));
  }
  return texts;
}

std::string ties_text(const Scene& scene) {
  std::string text;
  for (const TieSpec& tie : scene.ties)
    text += fmt::format("tie {}: {} to {}, at {} {}\n", tie.name,
                        scene.rods[static_cast<std::size_t>(tie.rod)].name,
                        scene.rods[static_cast<std::size_t>(tie.other)].name, tie.s.size(),
                        tie.s.size() == 1 ? "place" : "places");
  return text;
}

std::string joints_text(const Scene& scene) {
  std::string text;
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const JointSpec& joint = scene.joints[j];
    if (joint.kind == JointKind::kFixed) continue;
    text += fmt::format("joint {}: {}", joint.name, kind_name(joint.kind));
    if (joint.kind == JointKind::kScrew)
      text += fmt::format(", {:.6g} m per turn", joint.screw_pitch);
    text += fmt::format("; {}\n", fmt::join(axis_texts(scene, j), " | "));
  }
  return text;
}

/// Each effect's absence, or presence, that something is known of.
std::string estimates_text(const EffectEstimates& estimates) {
  std::string text;
  std::string unknown;
  for (const EffectEstimate& one : estimates.effects) {
    if (!one.unknown.empty()) {
      unknown += std::string(" ") + effect_name(one.effect);
      continue;
    }
    text += fmt::format("  {:<8} {:<15} {:>9.2g}  {}\n", one.listed ? "without" : "with",
                        effect_name(one.effect), one.change, one.by);
  }
  if (text.empty()) return {};
  return fmt::format("estimated change of {}, over the {:.6g} m of the longest rod\n",
                     estimates.watched, estimates.length) +
         text + (unknown.empty() ? "" : "  not known without a run:" + unknown + "\n");
}

Json estimates_json(const EffectEstimates& estimates) {
  Json json = {
      {"watched", estimates.watched}, {"length", estimates.length}, {"effects", Json::array()}};
  for (const EffectEstimate& one : estimates.effects) {
    Json entry = {{"effect", effect_name(one.effect)}, {"listed", one.listed}};
    if (one.unknown.empty())
      entry.update({{"change", one.change}, {"by", one.by}});
    else
      entry["unknown"] = one.unknown;
    json["effects"].push_back(entry);
  }
  return json;
}

std::string rod_text(const Scene& scene, const RodGroup& group) {
  const RodFacts& rod = *group.facts;
  std::string text = fmt::format("rod {}\n", fmt::join(group.names, ", "));
  text += fmt::format(
      "  mass {:.6g} kg, first frequency {:.4g} Hz (cantilever), buckling load {:.4g} N\n",
      rod.mass, rod.first_frequency, rod.buckling_load);
  text += fmt::format("  EI {:.6g} {:.6g} N m^2, GJ {:.6g} N m^2, EA {:.6g} N, GA {:.6g} N\n",
                      rod.bending_x, rod.bending_y, rod.torsion, rod.axial, rod.shear_x);
  text += fmt::format("  {}; {} unknowns, growth exponent {:.3g}; {}\n", pieces_text(rod),
                      rod.unknowns, rod.growth_exponent, rod.method_reason);
  if (!rod.section_law.empty()) text += fmt::format("  sections: {}\n", rod.section_law);
  for (const AdviceLine& line : advise(scene, rod)) {
    text += fmt::format("  {:<15} {:<18} {:>9.2g}  {}\n", effect_name(line.effect), line.formula,
                        line.number, to_string(line.advice));
  }
  return text;
}

Json rod_json(const Scene& scene, const RodFacts& rod) {
  Json json = {{"name", rod.name},
               {"mass", rod.mass},
               {"bending_x", rod.bending_x},
               {"bending_y", rod.bending_y},
               {"torsion", rod.torsion},
               {"axial", rod.axial},
               {"shear_x", rod.shear_x},
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
               {"unknowns", rod.unknowns},
               {"advice", Json::array()}};
  for (const AdviceLine& line : advise(scene, rod)) {
    json["advice"].push_back({{"effect", effect_name(line.effect)},
                              {"formula", line.formula},
                              {"number", line.number},
                              {"listed", line.listed},
                              {"advice", to_string(line.advice)}});
  }
  return json;
}

Json to_json(const Scene& scene, const ProblemFacts& facts, const EffectEstimates& estimates) {
  Json json = {{"schema", "cprsim-info/1"},
               {"name", scene.name},
               {"hash", scene.hash},
               {"mode", mode_name(scene.simulation.mode)},
               {"duration", scene.simulation.duration},
               {"kernel", facts.planar ? "planar" : "spatial"},
               {"scheme", facts.scheme},
               {"step", facts.step},
               {"body_unknowns", facts.body_unknowns},
               {"constraint_unknowns", facts.constraint_unknowns},
               {"effects", Json::object()},
               {"estimates", estimates_json(estimates)},
               {"joints", Json::array()},
               {"rods", Json::array()},
               {"channels", Json::array()}};
  for (int i = 0; i < kEffectCount; ++i) {
    const auto effect = static_cast<Effect>(i);
    json["effects"][effect_name(effect)] = {
        {"on", scene.effects.has(effect)},
        {"asked_at", place_name(scene, scene.effects.asked_at[static_cast<std::size_t>(i)])}};
  }
  for (std::size_t j = 0; j < scene.joints.size(); ++j)
    json["joints"].push_back({{"name", scene.joints[j].name},
                              {"type", kind_name(scene.joints[j].kind)},
                              {"axes", axis_texts(scene, j)}});
  for (const RodFacts& rod : facts.rods)
    json["rods"].push_back(rod_json(scene, rod));
  for (const Channel& channel : find_channels(scene, "*")) {
    json["channels"].push_back({{"name", channel.name}, {"unit", channel.unit}});
  }
  return json;
}

}  // namespace

int info_command(const Words& words) {
  std::string path;
  SceneOptions options;
  ConsoleOptions console_options;
  CommandLine line(
      "cprsim info",
      "Tells what is in a scene and what follows from it, without simulating: stiffness, mass, "
      "first\n"
      "frequency, growth exponents, the effects that are on, those that would matter, and what "
      "leaving\n"
      "one out or adding it is estimated to change, from the equilibrium at the start.\n\n"
      "Examples\n"
      "  cprsim info scene.xml\n"
      "  cprsim info scene.xml --step 0.001 --json");
  line.scene(path);
  add_scene_options(line, options);
  add_console_options(line, console_options);
  if (const auto code = line.parse(words)) return *code;

  const Console console(console_options);
  const LoadedScene loaded = load_and_show(path, options, console);
  if (loaded.scene == nullptr) return kExitSceneInvalid;
  const Scene& scene = *loaded.scene;
  try {
    const auto simulation = build_simulation(scene);
    const ProblemFacts& facts = simulation->facts();
    const EffectEstimates estimates = estimate_effects(path, options, scene, facts);
    if (console.json()) write_to_stdout(to_json(scene, facts, estimates).dump(2) + "\n");
    console.say(contents_text(scene) + solver_text(facts) + effects_text(scene) +
                joints_text(scene) + ties_text(scene));
    for (const RodGroup& group : groups_of(facts))
      console.say(rod_text(scene, group));
    console.say(estimates_text(estimates));
  } catch (const std::invalid_argument& error) {
    console.error(path + ": " + error.what());
    return kExitSceneInvalid;
  }
  return kExitDone;
}

}  // namespace cprsim
