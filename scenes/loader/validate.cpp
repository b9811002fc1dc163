// SPDX-License-Identifier: BSD-3-Clause
// The schema table applied to a tree. After this, readers may take every value that is not in a
// broken element for granted.
#include <cmath>
#include <map>

#include "scenes/loader/reporter.h"
#include "scenes/loader/schema.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

struct Verdict {
  const char* code = nullptr;  ///< null: the value is fine
  std::string message;
};

std::string quoted(std::string_view text) {
  constexpr std::size_t kShown = 60;
  if (text.size() > kShown) return "'" + std::string(text.substr(0, kShown)) + "...'";
  return "'" + std::string(text) + "'";
}

Verdict wrong_type(std::string_view text, ValueType type) {
  return {"E305", quoted(text) + " is not " + type_name(type)};
}

Verdict check_number(std::string_view text, ValueType type) {
  const auto value = parse_number(text, type == ValueType::kLimit);
  if (!value) {
    const auto as_number = type == ValueType::kLimit ? type : ValueType::kNumber;
    return wrong_type(text, as_number);
  }
  const bool too_small = (type == ValueType::kPositive && *value <= 0) ||
                         (type == ValueType::kNonNegative && *value < 0);
  if (too_small) return {"E306", quoted(text) + " is not " + type_name(type)};
  return {};
}

Verdict check_integer(std::string_view text, ValueType type) {
  constexpr long long kLargest = 2147483647;
  const auto value = parse_integer(text);
  if (!value) return wrong_type(text, type);
  if (*value < (type == ValueType::kCount ? 1 : 0) || *value > kLargest)
    return {"E306", quoted(text) + " is not " + type_name(type) + " (and at most 2147483647)"};
  return {};
}

Verdict check_numbers(std::string_view text, ValueType type) {
  const auto numbers = parse_numbers(text);
  const std::size_t count = numbers ? numbers->size() : 0;
  bool fits = count > 0;
  if (type == ValueType::kVec2) fits = count == 2;
  if (type == ValueType::kVec3) fits = count == 3;
  if (type == ValueType::kRgba) fits = count == 3 || count == 4;
  if (type == ValueType::kPose) fits = numbers && (count == 0 || count == 6 || count == 7);
  if (!fits) return wrong_type(text, type);
  if (type == ValueType::kRgba)
    for (const double x : *numbers)
      if (x < 0) return {"E306", quoted(text) + " is not " + type_name(type)};
  return {};
}

Verdict check_keyframes(std::string_view text) {
  const auto frames = parse_keyframes(text);
  if (!frames) return wrong_type(text, ValueType::kKeyframes);
  for (std::size_t i = 1; i < frames->size(); ++i)
    if ((*frames)[i].time <= (*frames)[i - 1].time)
      return {"E306", "the keyframes' times do not ascend"};
  return {};
}

Verdict check_name(std::string_view text, ValueType type) {
  const bool malformed = text.empty() || text.find_first_of(" \t\r\n") != std::string_view::npos;
  if (malformed) return {"E402", quoted(text) + " is not " + type_name(type)};
  if (type == ValueType::kRef) return {};
  if (text.find_first_of(".()[]/*\"'<>") != std::string_view::npos ||
      text.find("::") != std::string_view::npos)
    return {"E402", quoted(text) + " is not " + type_name(type)};
  const bool reserved = text == "world" || (text.size() >= 4 && text.substr(0, 2) == "__" &&
                                            text.substr(text.size() - 2) == "__");
  if (reserved) return {"E402", quoted(text) + " is a reserved name"};
  return {};
}

Verdict check_value(std::string_view text, ValueType type) {
  switch (type) {
    case ValueType::kNumber:
    case ValueType::kPositive:
    case ValueType::kNonNegative:
    case ValueType::kLimit:
      return check_number(text, type);
    case ValueType::kCount:
    case ValueType::kInteger:
      return check_integer(text, type);
    case ValueType::kBool:
      return parse_bool(text) ? Verdict{} : wrong_type(text, type);
    case ValueType::kVec2:
    case ValueType::kVec3:
    case ValueType::kRgba:
    case ValueType::kPose:
    case ValueType::kNumbers:
      return check_numbers(text, type);
    case ValueType::kKeyframes:
      return check_keyframes(text);
    case ValueType::kName:
    case ValueType::kRef:
      return check_name(text, type);
    default:
      return {};
  }
}

std::vector<std::string> choices(const char* words, bool available_only) {
  std::vector<std::string> list;
  std::string_view rest = words;
  while (!rest.empty()) {
    const std::size_t bar = rest.find('|');
    const std::string_view word = rest.substr(0, bar);
    if (word.front() != '!')
      list.emplace_back(word);
    else if (!available_only)
      list.emplace_back(word.substr(1));
    rest.remove_prefix(bar == std::string_view::npos ? rest.size() : bar + 1);
  }
  return list;
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string did_you_mean(const std::string& name, bool element) {
  if (name.empty()) return {};
  return element ? "did you mean <" + name + ">?" : "did you mean " + name + "?";
}

class Validator {
 public:
  Validator(bool lax, Reporter& report) : lax_(lax), report_(report) {}

  void element(Node& node, const ElementRule& rule) {
    node.rule = &rule;
    if (rule.type == ValueType::kAny) return;
    attributes(node, rule.key());
    text(node, rule);
    std::map<std::string, const Node*> first;
    for (const auto& child : node.children)
      one_child(node, *child, rule.key(), first);
    for (const std::string& name : element_names(rule.key())) {
      const ElementRule* wanted = find_element(rule.key(), name);
      if ((wanted->occurs == '1' || wanted->occurs == '+') && !first.count(name))
        report_.missing("E303", node, describe(node) + " has no <" + name + ">");
    }
  }

  void finish() {
    summarise("W590", Severity::kWarning, no_effect_, "no effect here: ");
    summarise("W590", Severity::kNote, quiet_, "no effect, by the nature of this program: ");
    summarise("W591", Severity::kNote, foreign_, "of other namespaces, skipped: ");
  }

 private:
  struct Mention {
    std::string name;
    Place place;
  };

  void one_child(Node& node, Node& child, std::string_view owner,
                 std::map<std::string, const Node*>& first) {
    if (child.foreign) {
      child.broken = true;
      foreign_.push_back({"<" + child.name + ">", child.place});
      return;
    }
    const ElementRule* rule = find_element(owner, child.name);
    if (!rule) return unknown(node, child, owner);
    const auto [earlier, is_first] = first.emplace(child.name, &child);
    if (!is_first && (rule->occurs == '?' || rule->occurs == '1')) {
      report_.error("E304", child,
                    "a second <" + child.name + "> in " + describe(node) + "; the first is at " +
                        report_.locate(earlier->second->place));
      child.broken = true;
      return;
    }
    if (allowed(child, nullptr, rule->status, rule->unit))
      element(child, *rule);
    else
      child.broken = true;
  }

  void unknown(const Node& node, Node& child, std::string_view owner) {
    const std::string best = nearest_name(child.name, element_names(owner));
    std::string hint = did_you_mean(best, true);
    if (best.empty() && find_attribute(owner, child.name))
      hint = "write it as an attribute: " + child.name + "=\"...\"";
    report_.error("E301", child, "<" + child.name + "> is not part of <" + node.name + ">", hint);
    child.broken = true;
  }

  // decides by status; false: the thing is not to be read. `attribute` is null for an element
  bool allowed(const Node& node, const Attribute* attribute, Status status,
               const std::string& hint) {
    const std::string what = attribute ? node.name + "/@" + attribute->name : "<" + node.name + ">";
    const Place place = attribute && attribute->place.known() ? attribute->place : node.place;
    if (status == Status::kSupported) return true;
    if (status == Status::kNoEffect || status == Status::kQuiet) {
      (status == Status::kQuiet ? quiet_ : no_effect_).push_back({what, place});
      return true;
    }
    std::string message = what + " is not available in this version";
    if (status == Status::kOnlyFalse) {
      const std::string& value = attribute ? attribute->value : node.text;
      const auto number = parse_number(value);
      if (value == "false" || (number && *number == 0)) return false;
      message += ", except as false or 0";
    }
    const bool tolerated = status == Status::kRejected && lax_;
    const std::size_t caret = attribute ? attribute->name.size() : node.name.size() + 1;
    Diagnostic& d = report_.at(tolerated ? Severity::kWarning : Severity::kError, "E520", place,
                               static_cast<int>(caret), message);
    d.suggestion = hint;
    d.context = context_of(node);
    return false;
  }

  void attributes(Node& node, std::string_view owner) {
    for (Attribute& a : node.attributes) {
      if (a.name.find(':') != std::string::npos || a.name == "xmlns") continue;
      const AttributeRule* rule = find_attribute(owner, a.name);
      if (!rule) {
        unknown_attribute(node, a, owner);
        continue;
      }
      if (!allowed(node, &a, rule->status, rule->unit)) continue;
      check_attribute(node, a, *rule);
    }
    for (const std::string& name : attribute_names(owner))
      if (find_attribute(owner, name)->required && !node.attribute(name)) {
        report_.error("E308", node, "<" + node.name + "> has no attribute " + name);
        node.broken = true;
      }
  }

  void unknown_attribute(const Node& node, const Attribute& a, std::string_view owner) {
    std::string hint = did_you_mean(nearest_name(a.name, attribute_names(owner)), false);
    if (find_element(owner, a.name))
      hint = "write it as an element: <" + a.name + ">" + a.value + "</" + a.name + ">";
    Diagnostic& d = report_.at(Severity::kError, "E302", a.place.known() ? a.place : node.place,
                               static_cast<int>(a.name.size()),
                               "attribute " + a.name + " is not part of <" + node.name + ">");
    d.suggestion = hint;
    d.context = context_of(node);
  }

  void check_attribute(Node& node, const Attribute& a, const AttributeRule& rule) {
    if (rule.type == ValueType::kChoice) {
      check_choice(node, a, rule);
      return;
    }
    // SDF allows an empty reference, which means the default frame
    if (rule.type == ValueType::kRef && a.value.empty() && !rule.required) return;
    const Verdict verdict = check_value(a.value, rule.type);
    if (!verdict.code) return;
    report_.bad_value(verdict.code, node, a, a.name + ": " + verdict.message);
    node.broken = true;
  }

  void check_choice(Node& node, const Attribute& a, const AttributeRule& rule) {
    const auto available = choices(rule.unit, true);
    for (const std::string& word : available)
      if (word == a.value) return;
    const auto all = choices(rule.unit, false);
    bool known = false;
    for (const std::string& word : all)
      known = known || word == a.value;
    node.broken = true;
    if (known) {
      report_.bad_value("E520", node, a,
                        a.name + "=\"" + a.value + "\" is not available in this version",
                        "available: " + join(available));
      return;
    }
    const std::string best = nearest_name(a.value, available);
    report_.bad_value("E307", node, a, quoted(a.value) + " is not a possible " + a.name,
                      best.empty() ? "possible: " + join(available) : did_you_mean(best, false));
  }

  void text(Node& node, const ElementRule& rule) {
    if (rule.type == ValueType::kGroup || rule.type == ValueType::kEmpty) {
      if (!node.text.empty())
        report_.bad_text("E309", node,
                         "text " + quoted(node.text) + " in " + describe(node) + ", which holds " +
                             type_name(rule.type));
      return;
    }
    const bool may_be_empty = rule.type == ValueType::kPose ||
                              (rule.type == ValueType::kVec3 && node.attribute("frame")) ||
                              node.name == "overlay" || node.name == "vary";
    if (node.text.empty() && may_be_empty) return;
    Verdict verdict = check_value(node.text, rule.type);
    if (!verdict.code && node.text.empty()) verdict = wrong_type("", rule.type);
    if (!verdict.code) return;
    report_.bad_text(verdict.code, node, "<" + node.name + ">: " + verdict.message);
    node.broken = true;
  }

  void summarise(std::string_view code, Severity severity, const std::vector<Mention>& mentions,
                 const std::string& intro) {
    constexpr std::size_t kMost = 12;
    if (mentions.empty()) return;
    std::string list;
    for (std::size_t i = 0; i < mentions.size() && i < kMost; ++i)
      list += (i ? ", " : "") + mentions[i].name + " (line " +
              std::to_string(mentions[i].place.line) + ")";
    if (mentions.size() > kMost)
      list += " and " + std::to_string(mentions.size() - kMost) + " more";
    report_.at(severity, code, mentions.front().place, 0, intro + list);
  }

  bool lax_;
  Reporter& report_;
  std::vector<Mention> no_effect_, quiet_, foreign_;
};

}  // namespace

void validate(Node& root, bool lax, Reporter& report) {
  const ElementRule* rule = find_element("", root.name);
  if (!rule) return;
  Validator validator(lax, report);
  validator.element(root, *rule);
  validator.finish();
}

}  // namespace cprsim
