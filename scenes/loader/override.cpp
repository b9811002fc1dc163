// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/override.h"

#include <algorithm>

#include "scenes/loader/reporter.h"
#include "scenes/loader/schema.h"
#include "scenes/loader/solver_setting.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

constexpr std::string_view kPrefix = "cprsim:";

struct Target {
  Node* node = nullptr;
  std::string attribute;  ///< empty: the element's text
};

struct Lookup {
  std::vector<Target> found;
  std::vector<std::string> candidates;  ///< when not exactly one was found
  std::string problem;
};

// "a/b::c/@d" -> a, b, c, @d; brackets may hold slashes
std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    depth += path[i] == '[' ? 1 : path[i] == ']' ? -1 : 0;
    const bool scope = depth == 0 && path.substr(i, 2) == "::";
    if (depth == 0 && (path[i] == '/' || scope)) {
      parts.emplace_back();
      i += scope ? 1 : 0;
    } else {
      parts.back() += path[i];
    }
  }
  return parts;
}

bool named(const Node& node, std::string_view key) {
  for (const char* attribute : {"name", "rod", "joint", "at", "camera", "prefix"})
    if (node.value(attribute) == key) return true;
  return false;
}

bool fits(const Node& node, std::string_view segment) {
  if (node.name == segment || node.value("name") == segment) return true;
  return node.name.substr(0, kPrefix.size()) == kPrefix &&
         std::string_view(node.name).substr(kPrefix.size()) == segment;
}

std::vector<Node*> step_down(const std::vector<Node*>& from, std::string_view segment) {
  const std::size_t bracket = segment.find('[');
  const std::string_view head = segment.substr(0, bracket);
  std::vector<Node*> matches;
  for (Node* node : from)
    for (const auto& child : node->children)
      if (!child->foreign && fits(*child, head)) matches.push_back(child.get());
  if (bracket == std::string_view::npos || segment.back() != ']') return matches;
  const std::string_view key = segment.substr(bracket + 1, segment.size() - bracket - 2);
  std::vector<Node*> chosen;
  for (Node* node : matches)
    if (named(*node, key)) chosen.push_back(node);
  const auto number = parse_integer(key);
  if (chosen.empty() && number && *number >= 1 && *number <= static_cast<long long>(matches.size()))
    chosen.push_back(matches[static_cast<std::size_t>(*number - 1)]);
  return chosen;
}

std::string path_of(const Node& node) {
  std::string text;
  for (const Node* at = &node; at->parent && at->name != "world"; at = at->parent) {
    const std::string_view name = at->value("name");
    const bool entity = at->name == "model" || at->name == "link" || at->name == "joint" ||
                        at->name == "cprsim:joint" || at->name == "cprsim:rod" ||
                        at->name == "frame";
    std::string part = name.empty() ? at->name
                       : entity     ? std::string(name)
                                    : at->name + "[" + std::string(name) + "]";
    text = part + (text.empty() ? "" : "/") + text;
  }
  return text;
}

void collect(Node& node, std::string_view segment, std::vector<std::string>& paths) {
  constexpr std::size_t kMost = 8;
  for (const auto& child : node.children) {
    if (paths.size() >= kMost) return;
    if (fits(*child, segment)) paths.push_back(path_of(*child));
    collect(*child, segment, paths);
  }
}

Lookup look_up(Node& world, std::string_view path) {
  Lookup result;
  std::vector<std::string> parts = split_path(path);
  std::vector<Node*> here{&world};
  if (!parts.empty() && (parts.front() == "world" || parts.front() == world.value("name")) &&
      parts.size() > 1)
    parts.erase(parts.begin());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string& part = parts[i];
    if (part.substr(0, 1) == "@" && i + 1 == parts.size()) {
      for (Node* node : here)
        result.found.push_back({node, part.substr(1)});
      return result;
    }
    std::vector<Node*> next = step_down(here, part);
    if (next.empty()) {
      result.problem = "nothing here is called '" + part + "'";
      std::vector<std::string> names;
      for (const Node* node : here)
        for (const auto& child : node->children) {
          names.push_back(child->name);
          if (!child->value("name").empty()) names.emplace_back(child->value("name"));
        }
      if (const std::string best = nearest_name(part, names); !best.empty())
        result.problem += ", did you mean '" + best + "'?";
      const std::string& last = parts.back();
      collect(world, last.substr(0, last.find('[')), result.candidates);
      return result;
    }
    here = std::move(next);
  }
  for (Node* node : here)
    result.found.push_back({node, ""});
  return result;
}

// exactly one value, or the reason why not
Lookup single(Node& world, std::string_view path) {
  Lookup result = look_up(world, path);
  if (result.found.size() > 1) {
    result.problem = "it fits " + std::to_string(result.found.size()) + " places";
    for (const Target& target : result.found) {
      if (result.candidates.size() >= 8) break;
      result.candidates.push_back(path_of(*target.node) +
                                  (target.attribute.empty() ? "" : "/@" + target.attribute));
    }
  } else if (result.found.size() == 1 && result.found[0].attribute.empty() &&
             !result.found[0].node->children.empty()) {
    Node& node = *result.found[0].node;
    result.problem = "<" + node.name + "> holds elements, not a value";
    for (const auto& child : node.children)
      result.candidates.push_back(path_of(*child));
  } else if (result.found.size() == 1 && result.found[0].node == &world) {
    result.problem = "it names the world itself";
  }
  return result;
}

void explain(Diagnostic& diagnostic, const Lookup& lookup) {
  for (const std::string& path : lookup.candidates)
    diagnostic.details.push_back("candidate: " + path);
}

// "a/pose#3" -> "a/pose" and 3; 0 where no number is picked
std::pair<std::string, std::size_t> split_pick(const std::string& path) {
  const std::size_t hash = path.rfind('#');
  if (hash == std::string::npos) return {path, 0};
  const auto pick = parse_integer(path.substr(hash + 1));
  if (!pick || *pick < 1 || *pick > 1000) return {path, 0};
  return {path.substr(0, hash), static_cast<std::size_t>(*pick)};
}

std::string text_of(const Target& target) {
  return std::string(target.attribute.empty() ? std::string_view(target.node->text)
                                              : target.node->value(target.attribute));
}

/// One target and the number picked from it, or the reason why not.
struct Spot {
  Lookup lookup;
  std::vector<std::string> words;  ///< of a text from which one is picked
  std::size_t pick = 0;
};

Spot spot_at(Node& world, const std::string& path) {
  const auto [bare, pick] = split_pick(path);
  Spot spot{single(world, bare), {}, pick};
  if (!spot.lookup.problem.empty() || pick == 0) return spot;
  const std::string text = text_of(spot.lookup.found[0]);
  for (const std::string_view word : split_words(text))
    spot.words.emplace_back(word);
  if (pick > spot.words.size())
    spot.lookup.problem =
        "there are " + std::to_string(spot.words.size()) + " numbers at '" + bare + "'";
  return spot;
}

void set_value(Node& world, const std::string& path, const std::string& value, Reporter& report) {
  Spot spot = spot_at(world, path);
  const Lookup& lookup = spot.lookup;
  if (!lookup.problem.empty()) {
    if (is_solver_setting(path)) return set_solver_setting(world, path, std::string(trim(value)));
    explain(report.at(Severity::kError, "E311", {}, 0,
                      "--set " + path + "=" + value + ": " + lookup.problem),
            lookup);
    return;
  }
  std::string text(trim(value));
  if (spot.pick > 0) {
    spot.words[spot.pick - 1] = text;
    text.clear();
    for (const std::string& word : spot.words)
      text += (text.empty() ? "" : " ") + word;
  }
  Node& node = *lookup.found[0].node;
  if (lookup.found[0].attribute.empty()) {
    node.text = text;
    node.text_place = {};
  } else {
    node.set_attribute(lookup.found[0].attribute, text);
    for (Attribute& a : node.attributes)
      if (a.name == lookup.found[0].attribute) a.place = a.value_place = {};
  }
}

}  // namespace

void apply_overrides(Node& world, const LoadOptions& options, Reporter& report) {
  if (options.duration) {
    Node& simulation = world.need("cprsim:simulation");
    if (!simulation.attribute("mode")) simulation.set_attribute("mode", "dynamic");
    Node& duration = simulation.need("duration");
    duration.text = format_number(*options.duration);
    duration.text_place = {};
  }
  if (options.method) set_solver_setting(world, "method", *options.method);
  if (options.accuracy) set_solver_setting(world, "accuracy", format_number(*options.accuracy));
  if (options.step) set_solver_setting(world, "step", format_number(*options.step));
  for (const auto& [path, value] : options.set)
    set_value(world, path, value, report);
}

std::vector<std::string> values_at(Node& world, const std::vector<std::string>& paths,
                                   Reporter& report) {
  std::vector<std::string> texts;
  for (const std::string& path : paths) {
    const Spot spot = spot_at(world, path);
    texts.emplace_back();
    if (!spot.lookup.problem.empty()) {
      explain(
          report.at(Severity::kError, "E311", {}, 0, "path '" + path + "': " + spot.lookup.problem),
          spot.lookup);
    } else {
      texts.back() = spot.pick > 0 ? spot.words[spot.pick - 1] : text_of(spot.lookup.found[0]);
    }
  }
  return texts;
}

void check_path(const Node& world, const Attribute& path, const Node& where, Reporter& report) {
  const auto copy = world.clone();
  copy->parent = nullptr;
  const Lookup lookup = single(*copy, path.value);
  if (!lookup.problem.empty() && !is_solver_setting(path.value))
    explain(report.bad_value("E311", where, path, "path '" + path.value + "': " + lookup.problem),
            lookup);
}

}  // namespace cprsim
