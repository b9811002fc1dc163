// SPDX-License-Identifier: BSD-3-Clause
// Tendons. Their names live beside those of rods and links, but name no frame.
#include <cmath>

#include "scenes/loader/reading.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

// "0 0.01 0, 0.5 0 0.01, 1 0.01 0": s / length, x and y
void read_points(Reading& r, const Node& node, TendonSpec& tendon) {
  for (const std::string& piece : split(node.text, ',')) {
    const auto numbers = parse_numbers(piece);
    if (!numbers || numbers->size() != 3) {
      r.report.bad_text("E305", node, "a point of a tendon is three numbers: s, x and y",
                        "0 0.01 0, 1 0.01 0");
      return;
    }
    const Vec3 point((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    if (!tendon.points.empty() && point.x() <= tendon.points.back().x()) {
      r.report.bad_text("E306", node, "s must grow from point to point of a tendon");
      return;
    }
    tendon.points.push_back(point);
  }
  const double first = tendon.points.front().x(), last = tendon.points.back().x();
  if (tendon.points.size() < 2 || first != 0 || last < tendon.termination || last > 1)
    r.report.bad_text("E306", node,
                      "the points of a tendon begin at s = 0 and go on to its end, s = " +
                          format_number(tendon.termination));
}

void read_route(Reading& r, const Node& node, TendonSpec& tendon) {
  const Node* route = nullptr;
  for (const char* name : {"parallel", "helical", "points"})
    if (const Node* child = node.child(name)) {
      if (route) r.report.error("E310", *child, describe(node) + " has one way along its rod");
      route = child;
    }
  if (!route) {
    bool mentioned = false;
    for (const auto& child : node.children)
      mentioned = mentioned || child->broken;
    if (!mentioned)
      r.report.missing("E303", node, describe(node) + " has no way along its rod").suggestion =
          "<parallel>, <helical> or <points>";
    return;
  }
  if (route->name == "points") {
    tendon.route = TendonRoute::kPoints;
    read_points(r, *route, tendon);
    return;
  }
  tendon.radius = number_attribute(*route, "radius", 0);
  tendon.angle = number_attribute(*route, "angle", 0);
  if (route->name == "parallel") return;
  tendon.route = TendonRoute::kHelical;
  tendon.turns = number_attribute(*route, "turns", 0);
}

void read_tendon(Reading& r, const Node& node, int scope) {
  TendonSpec tendon;
  tendon.place = node.place;
  tendon.name = r.frames.scopes()[at(scope)].prefix + std::string(node.value("name"));
  if (find_tendon(r, scope, node.value("name"), true) || r.frames.find(scope, node.value("name"))) {
    r.report.error("E401", node,
                   "the name '" + std::string(node.value("name")) + "' is already used");
    return;
  }
  const Attribute& rod = *node.attribute("rod");
  const auto found = r.frames.find_outwards(scope, rod.value);
  if (!found || found->kind != FrameKind::kRod) {
    r.report.bad_value("E404", node, rod, "there is no rod '" + rod.value + "'",
                       mean(nearest_name(rod.value, r.frames.known_names(scope))));
  } else {
    tendon.rod = found->index;
  }
  if (const Node* termination = node.child("termination")) {
    tendon.termination = number_attribute(*termination, "s", 1);
    if (tendon.termination <= 0 || tendon.termination > 1)
      r.report.bad_value("E306", *termination, *termination->attribute("s"),
                         "a tendon ends at a fraction of the length, above 0 and at most 1");
  }
  if (const Node* friction = node.child("friction"))
    tendon.friction = number_attribute(*friction, "mu", 0);
  read_route(r, node, tendon);
  r.scene.tendons.push_back(std::move(tendon));
}

}  // namespace

std::optional<int> find_tendon(const Reading& r, int scope, std::string_view name, bool only_here) {
  for (int s = scope; s >= 0; s = only_here ? -1 : r.frames.scopes()[at(s)].parent) {
    const std::string full = r.frames.scopes()[at(s)].prefix + std::string(name);
    for (std::size_t k = 0; k < r.scene.tendons.size(); ++k)
      if (r.scene.tendons[k].name == full) return static_cast<int>(k);
  }
  return std::nullopt;
}

void read_tendons(Reading& r) {
  for_each_scope(r, [&](int scope, const Node& node) {
    for (const Node* tendon : node.all("cprsim:tendon"))
      read_tendon(r, *tendon, scope);
  });
}

// That the effect and its data are both there.
void check_friction(Reading& r) {
  const bool listed = r.scene.effects.has(Effect::kTendonFriction);
  bool any = false;
  for (const TendonSpec& tendon : r.scene.tendons) {
    any = any || tendon.friction > 0;
    if (tendon.friction > 0 && !listed)
      r.report.at(Severity::kNote, "W511", tendon.place, 14,
                  "tendon '" + tendon.name + "' has <friction>, tendon_friction is not listed");
  }
  if (listed && !any && !r.report.failed())
    r.report.at(Severity::kWarning, "W503",
                r.scene.effects.asked_at[static_cast<std::size_t>(Effect::kTendonFriction)], 15,
                "tendon_friction is listed and no tendon has <friction>");
}

// A tendon that nothing pulls is a mistake rather than a slack one.
void check_tendons(Reading& r) {
  check_friction(r);
  for (std::size_t k = 0; k < r.scene.tendons.size(); ++k) {
    const TendonSpec& tendon = r.scene.tendons[k];
    bool driven = false;
    for (const DriveSpec& drive : r.scene.drives)
      driven = driven || drive.tendon == static_cast<int>(k);
    if (!driven && !r.report.failed())
      r.report
          .at(Severity::kError, "E310", tendon.place, 14,
              "nothing drives tendon '" + tendon.name + "'")
          .suggestion = "<cprsim:drive tendon=\"" + tendon.name +
                        "\" quantity=\"tension\"><constant value=\"1\"/></cprsim:drive>";
  }
}

}  // namespace cprsim
