// SPDX-License-Identifier: BSD-3-Clause
// What a scene expects to come true.
#include "scenes/loader/files.h"
#include "scenes/loader/reading.h"
#include "scenes/loader/schema.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

void check_value(Reading& r, const Node& node, Expectation& e) {
  const bool one_sided = e.above || e.below;
  if (!node.attribute("equals") && !one_sided)
    r.report.missing("E310", node, "<value> needs equals and tolerance, or above, or below");
  if (node.attribute("equals") && !e.tolerance)
    r.report.missing("E310", node, "<value equals> needs a tolerance");
  if (!e.equals.empty() && !e.channels.empty() && e.equals.size() != e.channels.size())
    r.report.bad_value("E305", node, *node.attribute("equals"),
                       "'" + std::string(node.value("of")) + "' has " +
                           std::to_string(e.channels.size()) + " components, " +
                           std::to_string(e.equals.size()) + " numbers are given");
  // a run cut short by hand may end before what the scene expects
  if (r.options.duration) return;
  const double end = r.scene.simulation.duration;
  if (r.scene.simulation.mode != Mode::kStatic && end > 0 && e.at > end * (1 + 1e-9))
    r.report.bad_value("E306", node, *node.attribute("at"), "the simulation ends before this");
}

// a trajectory of one number, a vector or an orientation, in a file beside the scene
void read_match(Reading& r, const Node& node, Expectation& e) {
  e.rms = optional_number(node, "rms");
  e.take_lag_out = node.value("align") == "time";
  if (!e.rms && !e.max) r.report.missing("E310", node, "<match> needs rms or max");
  const std::size_t count = e.channels.size();
  if (count != 0 && count != 1 && count != 3 && count != 4)
    r.report.bad_value("E411", node, *node.attribute("of"),
                       "<match> compares one number, a vector or an orientation, '" +
                           std::string(node.value("of")) + "' is " + std::to_string(count) +
                           " numbers");
  const Attribute& reference = *node.attribute("reference");
  const auto file = static_cast<std::size_t>(node.place.file < 0 ? 0 : node.place.file);
  const FoundFile found = find_resource(reference.value, r.folders[file], r.roots);
  e.reference = found.path;
  if (found.code.empty()) return;
  Diagnostic& d = r.report.bad_value(found.code, node, reference, "reference " + found.message);
  for (const std::string& place : found.tried)
    d.details.push_back("tried " + place);
}

// two names: of links or rods, or patterns of such
void read_touching(Reading& r, const Node& node, const Attribute* between, Expectation& e) {
  if (!between) {
    e.channels = find_channels(r.scene, "contact.count");
    return;
  }
  const auto names = split_words(between->value);
  if (names.size() != 2) {
    r.report.bad_value("E305", node, *between,
                       "two links or rods are needed here, as in \"robot::leg scenery::floor\"");
    return;
  }
  const std::string pattern =
      "contact(" + std::string(names[0]) + "," + std::string(names[1]) + ").count";
  e.channels = find_channels(r.scene, pattern);
  warn_of_pairs(r, node, e.channels);
  if (!e.channels.empty() || r.report.failed()) return;
  std::string hint;
  for (const std::string& name : nearest_channels(r.scene, pattern)) {
    const PairPattern pair = pair_pattern(name);
    hint += (hint.empty() ? "did you mean \"" : ", \"") + std::string(pair.a) + " " +
            std::string(pair.b) + "\"";
  }
  r.report.bad_value("E411", node, *between, "there are no two links or rods of these names",
                     hint.empty() ? hint : hint + "?");
}

void read_event(Reading& r, const Node& node, Expectation& e) {
  const std::string_view kind = node.value("kind");
  e.event = kind == "contact"      ? EventKind::kContact
            : kind == "separation" ? EventKind::kSeparation
                                   : EventKind::kLimit;
  e.from = number_attribute(node, "after", 0);
  e.to = number_attribute(node, "before", -1);
  if (e.to >= 0 && e.to < e.from)
    r.report.error("E306", node, "before lies before after: nothing can fulfil this");
  const Attribute* between = node.attribute("between");
  if (e.event != EventKind::kLimit) return read_touching(r, node, between, e);
  const std::string joint = between ? between->value : "*";
  e.channels = find_channels(r.scene, joint + ".limit*");
  if (!e.channels.empty() || r.report.failed()) return;
  const std::string message =
      between ? "'" + joint + "' is no joint with limits" : std::string("no joint has limits");
  if (between)
    r.report.bad_value("E411", node, *between, message);
  else
    r.report.error("E411", node, message);
}

Expectation read_expectation(Reading& r, const Node& node) {
  Expectation e;
  e.place = node.place;
  e.kind = node.name == "value"   ? ExpectKind::kValue
           : node.name == "bound" ? ExpectKind::kBound
           : node.name == "drift" ? ExpectKind::kDrift
           : node.name == "match" ? ExpectKind::kMatch
           : node.name == "event" ? ExpectKind::kEvent
                                  : ExpectKind::kConverged;
  if (const Attribute* of = node.attribute("of")) e.channels = channels_of(r, node, of);
  e.at = number_attribute(node, "at", 0);
  e.from = number_attribute(node, "from", 0);
  e.to = number_attribute(node, "to", -1);
  e.equals = parse_numbers(node.value("equals")).value_or(std::vector<double>{});
  e.tolerance = optional_number(node, "tolerance");
  e.above = optional_number(node, "above");
  e.below = optional_number(node, "below");
  e.min = optional_number(node, "min");
  e.max = optional_number(node, "max");
  if (e.kind == ExpectKind::kValue) check_value(r, node, e);
  if (e.kind == ExpectKind::kBound && !e.min && !e.max)
    r.report.missing("E310", node, "<bound> needs min or max");
  if (e.min && e.max && *e.min > *e.max)
    r.report.error("E306", node, "min lies above max: nothing can fulfil this");
  if (e.kind == ExpectKind::kDrift && !e.below)
    r.report.missing("E308", node, "<drift> has no attribute below");
  if (e.kind == ExpectKind::kMatch) read_match(r, node, e);
  if (e.kind == ExpectKind::kEvent) read_event(r, node, e);
  return e;
}

}  // namespace

void read_expect(Reading& r, const Node& node) {
  ExpectSpec expect;
  expect.name = node.value("name");
  expect.place = node.place;
  if (node.children.empty())
    r.report.missing("E303", node, "<cprsim:expect> '" + expect.name + "' expects nothing");
  for (const auto& child : node.children) {
    if (child->broken) continue;
    if (child->name == "fails") {
      r.expected_failure = child->value("with");
      if (explain_code(r.expected_failure).empty())
        r.report.bad_value("E307", *child, *child->attribute("with"),
                           "'" + r.expected_failure + "' is no code");
    } else {
      expect.all.push_back(read_expectation(r, *child));
    }
  }
  r.scene.expects.push_back(std::move(expect));
}

}  // namespace cprsim
