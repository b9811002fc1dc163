// SPDX-License-Identifier: BSD-3-Clause
// Functions of time.
#include <cmath>

#include "scenes/loader/reading.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/table.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

Interpolation interpolation_of(std::string_view word) {
  if (word == "step") return Interpolation::kStep;
  if (word == "pchip") return Interpolation::kPchip;
  if (word == "cubic") return Interpolation::kCubic;
  return Interpolation::kLinear;
}

void read_span(Reading& r, const Node& node, ProfileTerm& term) {
  term.from = number_attribute(node, "from", 0);
  term.to = number_attribute(node, "to", 0);
  term.start = number_attribute(node, "start", 0);
  term.end = number_attribute(node, "end", 0);
  if (term.end <= term.start)
    r.report.error("E306", node, "<" + node.name + "> must end after it starts");
}

void read_keyframes(const Node& node, ProfileTerm& term) {
  term.shape = ShapeOfTime::kKeyframes;
  term.interpolation = interpolation_of(node.value("interpolation"));
  const auto frames = parse_keyframes(node.text);
  if (!frames) return;
  for (const Keyframe& frame : *frames) {
    term.times.push_back(frame.time);
    term.values.push_back(frame.value);
  }
  finish_keyframes(term);
}

void read_trapezoid(Reading& r, const Node& node, ProfileTerm& term) {
  term.shape = ShapeOfTime::kTrapezoid;
  read_span(r, node, term);
  term.acceleration = number_attribute(node, "acceleration", 0);
  const double least = least_acceleration(term);
  const Attribute* given = node.attribute("acceleration");
  if (given && term.end > term.start && term.acceleration < least)
    r.report.bad_value("E306", node, *given,
                       "<trapezoid> does not arrive in time with so little acceleration",
                       "at least " + format_number(least));
}

void read_chirp(Reading& r, const Node& node, ProfileTerm& term) {
  term.shape = ShapeOfTime::kChirp;
  term.amplitude = number_attribute(node, "amplitude", 0);
  term.frequency = number_attribute(node, "f0", 1);
  term.last_frequency = number_attribute(node, "f1", 1);
  term.start = number_attribute(node, "start", 0);
  term.end = number_attribute(node, "end", 0);
  if (term.end <= term.start) r.report.error("E306", node, "<chirp> must end after it starts");
}

// False if it is none; then the drive is as good as absent, and nothing more is said of it.
bool read_expression(Reading& r, const Node& node, ProfileTerm& term) {
  term.shape = ShapeOfTime::kExpression;
  auto parsed = Expression::parse(node.text);
  if (const auto* mistake = std::get_if<Expression::Mistake>(&parsed)) {
    r.report.bad_text("E306", node,
                      mistake->what + ", at '" + node.text.substr(mistake->at, 20) + "'");
    return false;
  }
  term.expression = std::get<Expression>(std::move(parsed));
  return true;
}

// Samples of a recording or a measurement: a cubic spline, whose second derivative is continuous,
// so that steps of an integrator need not end at them. False after an error.
bool read_samples(Reading& r, const Node& node, ProfileTerm& term) {
  term.shape = ShapeOfTime::kKeyframes;
  term.interpolation = Interpolation::kCubic;
  const Attribute* const file = node.attribute("file");
  const auto table = file ? read_table(r, node, file) : std::nullopt;
  if (!table) return false;
  std::size_t columns[2] = {0, 0};
  for (const int i : {0, 1}) {
    const Attribute* const named = node.attribute(i == 0 ? "time" : "value");
    if (!named) continue;
    const auto column = table->column(named->value);
    if (!column) {
      Diagnostic& d = r.report.bad_value(
          "E110", node, *named, "'" + file->value + "' has no column '" + named->value + "'",
          nearest_name(named->value, table->names));
      for (const std::string& name : table->names)
        d.details.push_back("it has '" + name + "'");
      return false;
    }
    columns[i] = *column;
  }
  for (std::size_t i = 0; i < table->rows.size(); ++i) {
    const double t = table->rows[i][columns[0]];
    if (!term.times.empty() && t <= term.times.back()) {
      complain_of_table(r, node, file,
                        "line " + std::to_string(table->lines[i]) + ": time does not ascend");
      return false;
    }
    term.times.push_back(t);
    term.values.push_back(table->rows[i][columns[1]]);
  }
  finish_keyframes(term);
  return true;
}

bool read_term(Reading& r, const Node& node, ProfileTerm& term) {
  if (node.name == "constant") {
    term.value = number_attribute(node, "value", 0);
  } else if (node.name == "step") {
    term.shape = ShapeOfTime::kStep;
    term.from = number_attribute(node, "from", 0);
    term.to = number_attribute(node, "to", 0);
    term.start = number_attribute(node, "at", 0);
  } else if (node.name == "ramp" || node.name == "smoothstep") {
    term.shape = node.name == "ramp" ? ShapeOfTime::kRamp : ShapeOfTime::kSmoothstep;
    read_span(r, node, term);
  } else if (node.name == "sine") {
    term.shape = ShapeOfTime::kSine;
    term.amplitude = number_attribute(node, "amplitude", 0);
    term.frequency = number_attribute(node, "frequency", 1);
    term.phase = number_attribute(node, "phase", 0);
    term.start = number_attribute(node, "start", 0);
    term.end = number_attribute(node, "end", HUGE_VAL);
    if (term.end <= term.start) r.report.error("E306", node, "<sine> must end after it starts");
  } else if (node.name == "trapezoid") {
    read_trapezoid(r, node, term);
  } else if (node.name == "chirp") {
    read_chirp(r, node, term);
  } else if (node.name == "csv") {
    return read_samples(r, node, term);
  } else if (node.name == "expression") {
    return read_expression(r, node, term);
  } else if (node.name == "keyframes") {
    read_keyframes(node, term);
  } else {
    return false;
  }
  return true;
}

}  // namespace

Profile read_shapes(Reading& r, const Node& node) {
  Profile profile;
  profile.place = node.place;
  for (const auto& child : node.children) {
    if (child->broken) continue;
    ProfileTerm term;
    if (read_term(r, *child, term)) profile.terms.push_back(std::move(term));
  }
  return profile;
}

void read_profiles(Reading& r, const Node& world) {
  for (const auto& child : world.children) {
    if (child->name != "cprsim:profile") continue;
    const std::string name(child->value("name"));
    const bool fresh = r.profiles.emplace(name, read_shapes(r, *child)).second;
    if (!fresh) r.report.error("E401", *child, "a second profile '" + name + "'");
    if (child->children.empty() && !child->broken)
      r.report.missing("E303", *child,
                       describe(*child) +
                           " has no shape: constant, step, ramp, "
                           "smoothstep, sine or keyframes");
  }
}

}  // namespace cprsim
