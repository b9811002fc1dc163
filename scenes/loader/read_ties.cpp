// SPDX-License-Identifier: BSD-3-Clause
// Ties between rods (engine/model/tie_spec.h).
#include <algorithm>

#include "scenes/loader/reading.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

constexpr std::size_t kMostPlaces = 200;

int rod_named(Reading& r, const Node& node, const char* key, int scope) {
  const Attribute& name = *node.attribute(key);
  const auto found = r.frames.find_outwards(scope, name.value);
  if (found && found->kind == FrameKind::kRod) return found->index;
  r.report.bad_value("E404", node, name, "there is no rod '" + name.value + "'",
                     mean(nearest_name(name.value, r.frames.known_names(scope))));
  return -1;
}

std::vector<double> places(Reading& r, const Node& node) {
  const std::vector<double> all = parse_numbers(node.text).value_or(std::vector<double>{});
  bool inside = !all.empty() && all.size() <= kMostPlaces;
  for (const double s : all)
    inside = inside && s > 0 && s <= 1;
  if (!inside)
    r.report.bad_text("E306", node,
                      "a tie has 1 to " + std::to_string(kMostPlaces) +
                          " places, fractions of the length above 0 and at most 1");
  return all;
}

/// What a tied rod cannot have besides; empty if it may be tied.
std::string obstacle(const Reading& r, const TieSpec& tie, int index, std::string& hint) {
  const Scene& scene = r.scene;
  const RodSpec& rod = scene.rods[at(index)];
  const Effects& effects = scene.effects;
  const std::string whose = "rod '" + rod.name + "'";
  hint.clear();
  if (!effects.has(Effect::kExtension) || rod.lacks("extension")) {
    hint = "list <extension/> among the effects";
    return "ties of a rod that cannot stretch, as " + whose;
  }
  // what is fed in at the base moves along with the rod, but not at a fraction of its length
  const std::vector<double>& places = index == tie.rod ? tie.s : tie.other_s;
  const bool inside = std::any_of(places.begin(), places.end(), [](double s) { return s < 1; });
  for (const DriveSpec& drive : scene.drives)
    if (inside && drive.rod == index) {
      hint = "tie its tip, s = 1";
      return "a length drive of a rod that is tied along its length, as " + whose;
    }
  return {};
}

void read_tie(Reading& r, const Node& node, int scope) {
  TieSpec tie;
  tie.place = node.place;
  tie.name = r.frames.scopes()[at(scope)].prefix + std::string(node.value("name"));
  for (const TieSpec& other : r.scene.ties)
    if (other.name == tie.name)
      r.report.error("E401", node, "the name '" + tie.name + "' is already used");
  tie.rod = rod_named(r, node, "rod", scope);
  tie.other = rod_named(r, node, "other", scope);
  if (tie.rod >= 0 && tie.rod == tie.other)
    r.report.bad_value("E310", node, *node.attribute("other"), "a rod is tied to another one");
  if (const Node* s = node.child("s")) tie.other_s = tie.s = places(r, *s);
  if (const Node* s = node.child("other_s")) {
    tie.other_s = places(r, *s);
    if (tie.other_s.size() != tie.s.size())
      r.report.bad_text("E306", *s,
                        "<other_s> has as many places as <s>, " + std::to_string(tie.s.size()));
  }
  if (const Node* offset = node.child("offset")) tie.offset = vec3_of(offset, Vec3::Zero());
  r.scene.ties.push_back(std::move(tie));
}

}  // namespace

void read_ties(Reading& r) {
  for_each_scope(r, [&](int scope, const Node& node) {
    for (const Node* tie : node.all("cprsim:tie"))
      read_tie(r, *tie, scope);
  });
}

void check_ties(Reading& r) {
  if (r.report.failed()) return;
  for (const TieSpec& tie : r.scene.ties)
    for (const int rod : {tie.rod, tie.other}) {
      std::string hint;
      const std::string what = obstacle(r, tie, rod, hint);
      if (what.empty()) continue;
      r.report.at(Severity::kError, "E520", tie.place, 10, what + ": not available in this version")
          .suggestion = hint;
      break;
    }
}

}  // namespace cprsim
