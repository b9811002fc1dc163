// SPDX-License-Identifier: BSD-3-Clause
// Rods. A rod takes each part it does not give itself from its class, that class from its own, and
// so on; within <material>, <stiffness>, <damping> and <drag> value by value, everything else as a
// whole.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scenes/loader/disks.h"
#include "scenes/loader/reading.h"
#include "scenes/loader/rest_table.h"
#include "scenes/loader/rod_ends.h"
#include "scenes/loader/sections.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

using Chain = std::vector<const Node*>;  ///< the rod, its class, that class's class, ...

// of a radius: a layer that begins this little within what it lies around begins on it
constexpr double kFit = 1e-9;

const Node* find_class(const Reading& r, int scope, std::string_view name,
                       std::vector<std::string>& known) {
  for (int s = scope; s >= 0; s = r.frames.scopes()[at(s)].parent)
    for (const Node* node : r.frames.scopes()[at(s)].node->all("cprsim:rod_class")) {
      if (node->value("name") == name) return node;
      known.emplace_back(node->value("name"));
    }
  return nullptr;
}

Chain inheritance(Reading& r, const RodEntry& rod) {
  Chain chain{rod.node};
  while (const Attribute* a = chain.back()->attribute("class")) {
    std::vector<std::string> known;
    const Node* next = find_class(r, rod.scope, a->value, known);
    if (!next) {
      r.report.bad_value("E408", *chain.back(), *a, "there is no rod class '" + a->value + "'",
                         mean(nearest_name(a->value, known)));
      return {};
    }
    if (std::find(chain.begin(), chain.end(), next) != chain.end()) {
      std::string loop;
      for (std::size_t i = 1; i < chain.size(); ++i)
        loop += std::string(chain[i]->value("name")) + " -> ";
      r.report.error("E405", *next, "rod classes form a loop: " + loop + a->value);
      return {};
    }
    chain.push_back(next);
  }
  return chain;
}

const Node* part(const Chain& chain, std::string_view name) {
  for (const Node* node : chain)
    if (const Node* found = node->child(name)) return found;
  return nullptr;
}

const Node* part(const Chain& chain, std::string_view group, std::string_view key) {
  for (const Node* node : chain)
    if (const Node* found = node->child(group))
      if (const Node* value = found->child(key)) return value;
  return nullptr;
}

// given at all, even if wrong: then somebody has already complained
bool mentioned(const Chain& chain, std::string_view name) {
  for (const Node* node : chain)
    for (const auto& child : node->children)
      if (child->name == name) return true;
  return false;
}

void read_section(Reading& r, const Chain& chain, RodSpec& rod) {
  const Node* node = part(chain, "cross_section");
  if (!node) {
    if (!mentioned(chain, "cross_section"))
      r.report.missing("E505", *chain.front(),
                       describe(*chain.front()) + " has no <cross_section>");
    return;
  }
  rod.sections = read_sections(r, node->parent->all("cross_section"));
  if (!rod.sections.empty()) rod.section = rod.sections.front();
  rod.section.place = node->place;
  if (rod.sections.size() < 2) rod.sections.clear();
}

void read_shear_modulus(Reading& r, const Chain& chain, MaterialSpec& material) {
  for (const Node* node : chain) {
    const Node* group = node->child("material");
    if (!group) continue;
    const Node* modulus = group->child("shear_modulus");
    const Node* ratio = group->child("poisson_ratio");
    if (modulus && ratio)
      r.report.error("E310", *ratio, "give <shear_modulus> or <poisson_ratio>, not both");
    if (modulus) material.shear_modulus = number_of(modulus, 0);
    if (ratio) {
      const double nu = number_of(ratio, 0);
      const bool possible = nu > -1 && nu <= 0.5;
      if (!possible)
        r.report.bad_text("E306", *ratio, "Poisson's ratio lies above -1 and is at most 0.5");
      if (!modulus)
        material.shear_modulus = material.youngs_modulus / (2 * (1 + (possible ? nu : 0)));
    }
    if (modulus || ratio) return;
  }
}

std::optional<MaterialSpec> read_material(Reading& r, const Chain& chain,
                                          const std::string& owner) {
  const Node* group = part(chain, "material");
  if (!group) return std::nullopt;
  MaterialSpec material;
  material.place = group->place;
  for (const char* key : {"density", "youngs_modulus"})
    if (!part(chain, "material", key) && !mentioned({group}, key))
      r.report.missing("E505", *group, "<material> of " + owner + " has no <" + key + ">");
  material.density = number_of(part(chain, "material", "density"), 0);
  material.youngs_modulus = number_of(part(chain, "material", "youngs_modulus"), 0);
  material.thermal_expansion = number_of(part(chain, "material", "thermal_expansion"), 0);
  read_shear_modulus(r, chain, material);
  return material;
}

bool round(const SectionSpec& section) {
  return section.shape == SectionShape::kCircle || section.shape == SectionShape::kAnnulus;
}

// Rings of other materials around the rod, from the inside out, bonded to each other.
void read_layers(Reading& r, const Chain& chain, RodSpec& rod) {
  const Node* first = part(chain, "layer");
  if (!first) return;
  double within = rod.section.size.x();
  bool core_is_round = round(rod.section);
  for (const SectionSpec& section : rod.sections) {
    within = std::max(within, section.size.x());
    core_is_round = core_is_round && round(section);
  }
  if (!core_is_round)
    r.report.error("E506", *first, "layers lie around a round section: the rod's is another");
  const std::string owner = "a layer of " + describe(*chain.front());
  for (const Node* node : first->parent->all("layer")) {
    LayerSpec layer;
    layer.place = node->place;
    const std::vector<const Node*> shapes = node->all("cross_section");
    const std::vector<SectionSpec> sections = read_sections(r, shapes);
    const std::optional<MaterialSpec> material = read_material(r, {node}, owner);
    if (shapes.size() != 1 || !material) {
      if (!mentioned({node}, "cross_section") || !mentioned({node}, "material") ||
          shapes.size() > 1)
        r.report.missing("E505", *node, "a <layer> has one <cross_section> and a <material>");
      continue;
    }
    if (sections.empty()) continue;
    layer.section = sections.front();
    layer.material = *material;
    if (layer.section.shape != SectionShape::kAnnulus)
      r.report.error("E506", *shapes.front(), "a layer is an <annulus>");
    else if (core_is_round && layer.section.size.y() < within * (1 - kFit))
      r.report.error("E506", *shapes.front(),
                     "the layer begins at a radius of " + format_number(layer.section.size.y()) +
                         " m, within what it lies around: that ends at " + format_number(within) +
                         " m");
    within = layer.section.size.x();
    rod.layers.push_back(layer);
  }
}

void read_stiffness(const Chain& chain, RodSpec& rod) {
  const auto value = [&](const char* key) {
    const Node* node = part(chain, "stiffness", key);
    return node ? parse_number(node->text) : std::nullopt;
  };
  StiffnessSpec& k = rod.stiffness;
  k.bending_x = value("bending_x");
  k.bending_y = value("bending_y");
  k.torsion = value("torsion");
  k.axial = value("axial");
  k.shear_x = value("shear_x");
  k.shear_y = value("shear_y");
  if (const Node* group = part(chain, "stiffness")) k.place = group->place;
}

// A helix of radius r and pitch 2 pi c has curvature r / (r2 + c2) and torsion c / (r2 + c2); its
// section frame turns about a fixed axis, so that both are constant in section axes.
void read_rest(Reading& r, const Chain& chain, RodSpec& rod) {
  const Node* rest = part(chain, "rest");
  if (!rest) return;
  const Node* curvature = rest->child("curvature");
  const Node* helix = rest->child("helix");
  const Node* file = rest->child("file");
  if ((curvature != nullptr) + (helix != nullptr) + (file != nullptr) > 1)
    r.report.error("E310", *rest, "give <curvature>, <helix> or <file>, one of them");
  else if (rest->children.empty())
    r.report.missing("E303", *rest, "<rest> has no shape").suggestion =
        "<curvature>bending_x bending_y twist</curvature>";
  if (curvature) rod.rest_curvature = vec3_of(curvature, Vec3::Zero());
  if (helix) {
    const double radius = number_of(helix->child("radius"), 0),
                 c = number_of(helix->child("pitch"), 0) / (2 * std::numbers::pi);
    if (radius > 0) rod.rest_curvature = Vec3(0, radius, c) / (radius * radius + c * c);
  }
  if (file) rod.rest_samples = read_rest_table(r, *file);
  double half = 0, bend = rod.rest_curvature.head<2>().norm();
  const auto widen = [&](const SectionSpec& section) {
    half = std::max(half,
                    section.size.maxCoeff() / (section.shape == SectionShape::kRectangle ? 2 : 1));
  };
  widen(rod.section);
  for (const SectionSpec& section : rod.sections)
    widen(section);
  for (const LayerSpec& layer : rod.layers)
    widen(layer.section);
  for (const RestSample& sample : rod.rest_samples)
    bend = std::max(bend, sample.curvature.head<2>().norm());
  if (bend * half >= 1)
    r.report.error("E506", *rest,
                   "without load " + describe(*chain.front()) +
                       " would be bent more tightly than its own thickness allows");
}

void read_drag(Reading& r, const Chain& chain, RodSpec& rod) {
  const Node* drag = part(chain, "drag");
  if (!drag) return;
  const auto value = [&](const char* key) { return number_of(part(chain, "drag", key), 0); };
  rod.drag = DragSpec{value("normal"), value("tangential"), value("fluid_density"),
                      value("added_mass"), drag->place};
  if (rod.drag->added_mass > 0 && !part(chain, "drag", "fluid_density") &&
      !mentioned({drag}, "fluid_density"))
    r.report.missing("E505", *drag, "<added_mass> is a multiple of the fluid displaced")
        .suggestion = "add <fluid_density>";
}

// what neither measured stiffness nor material gives
void require_stiffness(Reading& r, const Chain& chain, const RodSpec& rod) {
  const Node& node = *chain.front();
  const bool elastic = rod.material && rod.material->youngs_modulus > 0;
  const bool shears = rod.material && rod.material->shear_modulus > 0;
  const Scene& scene = r.scene;
  std::string lacking;
  const auto need = [&](bool available, const char* name) {
    if (!available) lacking += std::string(lacking.empty() ? "" : ", ") + name;
  };
  need(elastic || rod.stiffness.bending_x, "bending_x");
  need(elastic || rod.stiffness.bending_y, "bending_y");
  need(shears || rod.stiffness.torsion, "torsion");
  if (scene.effects.has(Effect::kExtension)) need(elastic || rod.stiffness.axial, "axial");
  if (scene.effects.has(Effect::kShear)) {
    need(shears || rod.stiffness.shear_x, "shear_x");
    need(shears || rod.stiffness.shear_y, "shear_y");
  }
  // what is written there and wrong has been complained about
  const Node* group = part(chain, "material");
  const bool shear_written =
      group && (mentioned({group}, "shear_modulus") || mentioned({group}, "poisson_ratio"));
  const bool broken = (mentioned(chain, "material") && !elastic) || (!shears && shear_written);
  if (lacking.empty() || broken) return;
  Diagnostic& d =
      r.report.missing("E505", node, describe(node) + " has no stiffness in " + lacking);
  d.suggestion = elastic ? "add <shear_modulus> or <poisson_ratio> to its <material>"
                         : "give a <material>, or these values in <stiffness>";
}

void read_without(Reading& r, const Chain& chain, RodSpec& rod) {
  std::vector<std::string> names;
  for (int k = 0; k < kEffectCount; ++k)
    names.emplace_back(effect_name(static_cast<Effect>(k)));
  for (const Node* node : chain)
    for (const Node* without : node->all("without"))
      for (const std::string_view word : split_words(without->text)) {
        if (std::find(names.begin(), names.end(), word) == names.end())
          r.report.bad_text("E307", *without, "there is no effect '" + std::string(word) + "'",
                            mean(nearest_name(word, names)));
        rod.without.emplace_back(word);
      }
}

}  // namespace

void read_rods(Reading& r, const Node&) {
  std::vector<RodOnRod> on_rods;
  for (const RodEntry& entry : r.frames.rods()) {
    RodSpec rod;
    rod.name = entry.name;
    rod.place = entry.node->place;
    rod.length = number_of(entry.node->child("length"), 0);
    read_rod_ends(r, entry, rod, on_rods);
    const Chain chain = inheritance(r, entry);
    if (!chain.empty()) {
      for (auto node = chain.rbegin(); node != chain.rend(); ++node)
        if (const auto method = method_attribute(**node)) rod.method = method;
      read_section(r, chain, rod);
      rod.material = read_material(r, chain, describe(*chain.front()));
      read_layers(r, chain, rod);
      read_stiffness(chain, rod);
      read_rest(r, chain, rod);
      require_stiffness(r, chain, rod);
      if (const Node* damping = part(chain, "damping")) {
        const auto value = [&](const char* key) {
          return number_of(part(chain, "damping", key), 0);
        };
        rod.damping = DampingSpec{value("bending"), value("torsion"), value("axial"),
                                  value("shear"), damping->place};
      }
      read_drag(r, chain, rod);
      if (const Node* disks = part(chain, "disks")) read_disks(r, *disks->parent, rod);
      if (const Node* magnet = part(chain, "magnetization")) read_magnets(r, *magnet->parent, rod);
      if (const Node* heat = part(chain, "temperature")) read_temperature(r, *heat, rod);
      rod.gravity = flag_of(part(chain, "gravity"), true);
      read_without(r, chain, rod);
      if (const Node* visual = part(chain, "visual"))
        rod.look = read_look(visual->child("material"), {});
      if (const Node* surface = part(chain, "surface")) {
        rod.surface = read_surface(surface);
        if (!r.scene.effects.has(Effect::kContact) && !r.scene.effects.has(Effect::kSelfContact))
          r.report.note("W511", *surface,
                        "<surface> of a rod is given, contact is not among the effects");
      }
    }
    r.scene.rods.push_back(std::move(rod));
  }
  join_rods(r, std::move(on_rods));
}

}  // namespace cprsim
