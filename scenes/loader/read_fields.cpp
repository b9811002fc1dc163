// SPDX-License-Identifier: BSD-3-Clause
// What surrounds rods: magnetic fields and what of a rod they act on, heat.
#include "scenes/loader/reading.h"
#include "scenes/loader/values.h"

namespace cprsim {
namespace {

bool has_child(const Node& node, std::string_view name) {
  for (const auto& child : node.children)
    if (child->name == name) return true;
  return false;
}

const Node& rod_node(const Reading& r, std::size_t rod) {
  return *r.frames.rods()[rod].node;
}

bool feels(const Scene& scene, const RodSpec& rod, Effect effect) {
  return scene.effects.has(effect) && !rod.lacks(effect_name(effect));
}

void warn_of_effect(Reading& r, Effect effect, const std::string& message) {
  const std::string name = effect_name(effect);
  r.report.at(Severity::kWarning, "W503",
              r.scene.effects.asked_at[static_cast<std::size_t>(effect)],
              static_cast<int>(name.size()), message);
}

void check_magnets(Reading& r, const Node& world) {
  const Scene& scene = r.scene;
  const bool listed = scene.effects.has(Effect::kMagnetic);
  const Node* field = world.child("cprsim:magnetic_field");
  bool any = false;
  for (std::size_t k = 0; k < scene.rods.size(); ++k) {
    const RodSpec& rod = scene.rods[k];
    if (rod.magnets.empty()) continue;
    any = true;
    if (!listed)
      r.report.note("W511", rod_node(r, k),
                    "rod '" + rod.name + "' has <magnetization>, magnetic is not listed");
  }
  if (!listed) {
    if (field)
      r.report.note("W511", *field, "a magnetic field is given, magnetic is not among the effects");
    return;
  }
  if (!has_child(world, "cprsim:magnetic_field"))
    r.report.missing("E503", world, "magnetic is listed and there is no <cprsim:magnetic_field>");
  if (!any && !r.report.failed())
    warn_of_effect(r, Effect::kMagnetic,
                   "magnetic is listed and no rod has <magnetization>; links do not feel it");
}

void check_heat(Reading& r) {
  const Scene& scene = r.scene;
  const bool listed = scene.effects.has(Effect::kThermal);
  bool any = false;
  for (std::size_t k = 0; k < scene.rods.size(); ++k) {
    const RodSpec& rod = scene.rods[k];
    if (!rod.temperature) continue;
    any = true;
    const Node& node = rod_node(r, k);
    if (!listed)
      r.report.note("W511", node,
                    "rod '" + rod.name + "' has <temperature>, thermal is not listed");
    if (!feels(scene, rod, Effect::kThermal)) continue;
    bool expands = rod.material && rod.material->thermal_expansion != 0, alike = true;
    for (const LayerSpec& layer : rod.layers) {
      const double alpha = layer.material.thermal_expansion;
      expands = expands || alpha != 0;
      alike = alike && rod.material && alpha == rod.material->thermal_expansion;
    }
    if (!alike && rod.sections.size() > 1)
      r.report.error("E520", node,
                     "layers that expand unlike the rod '" + rod.name +
                         "', whose sections vary, are not available in this version");
    if (!expands && !r.report.failed())
      r.report
          .missing("E503", node,
                   "thermal is listed, rod '" + rod.name + "' has no <thermal_expansion>")
          .suggestion = "give it in the rod's <material>";
    if (rod.temperature->rise != 0 && !feels(scene, rod, Effect::kExtension))
      r.report
          .missing("E503", node,
                   "rod '" + rod.name +
                       "' grows warmer, but cannot grow longer: extension is not listed")
          .suggestion = "list extension, or give a <gradient> only";
  }
  if (listed && !any && !r.report.failed())
    warn_of_effect(r, Effect::kThermal, "thermal is listed and no rod has a <temperature>");
}

}  // namespace

void read_magnets(Reading& r, const Node& owner, RodSpec& rod) {
  for (const Node* node : owner.all("magnetization")) {
    MagnetSpec magnet;
    magnet.moment = vec3_of(node, Vec3::Zero());
    magnet.from = number_attribute(*node, "from", 0);
    magnet.to = number_attribute(*node, "to", 1);
    if (magnet.to > 1 || magnet.from >= magnet.to)
      r.report.error("E306", *node, "from and to are fractions of the length, 0 <= from < to <= 1");
    rod.magnets.push_back(magnet);
  }
}

void read_temperature(Reading& r, const Node& node, RodSpec& rod) {
  TemperatureSpec heat;
  heat.place = node.place;
  heat.rise = number_of(node.child("rise"), 0);
  if (const Node* gradient = node.child("gradient"))
    if (const auto values = parse_numbers(gradient->text); values && values->size() == 2)
      heat.gradient = Vec2((*values)[0], (*values)[1]);
  if (!has_child(node, "rise") && !has_child(node, "gradient"))
    r.report.missing("E303", node, "<temperature> has no <rise> and no <gradient>");
  heat.has_profile = read_time_function(r, node, heat.profile);
  rod.temperature = heat;
}

void read_magnetic_fields(Reading& r, const Node& world) {
  for (const Node* node : world.all("cprsim:magnetic_field")) {
    MagneticFieldSpec field;
    field.place = node->place;
    const Node *uniform = node->child("uniform"), *dipole = node->child("dipole");
    if (has_child(*node, "uniform") == has_child(*node, "dipole"))
      r.report.error("E310", *node, "a magnetic field is <uniform> or of a <dipole>: give one");
    field.dipole = dipole;
    field.uniform = vec3_of(uniform, Vec3::Zero());
    if (dipole) {
      field.position = vec3_of(dipole->child("position"), Vec3::Zero());
      field.moment = vec3_of(dipole->child("moment"), Vec3::Zero());
    }
    field.has_profile = read_time_function(r, *node, field.profile);
    r.scene.magnetic_fields.push_back(std::move(field));
  }
}

void check_fields(Reading& r, const Node& world) {
  check_magnets(r, world);
  check_heat(r);
}

}  // namespace cprsim
