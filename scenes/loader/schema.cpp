// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/schema.h"

#include <map>
#include <set>
#include <utility>

#include "scenes/loader/values.h"

namespace cprsim {

namespace {

using Key = std::pair<std::string, std::string>;
template <class Rule>
using Index = std::map<Key, const Rule*>;

std::vector<std::string> words_of(const char* text) {
  std::vector<std::string> words;
  for (const std::string_view word : split_words(text))
    words.emplace_back(word);
  return words;
}

const Index<ElementRule>& element_index() {
  static const Index<ElementRule> kIndex = [] {
    Index<ElementRule> index;
    for (const ElementRule& rule : element_rules()) {
      if (!*rule.parents) index[{"", rule.name}] = &rule;
      for (const std::string& parent : words_of(rule.parents))
        index[{parent, rule.name}] = &rule;
    }
    return index;
  }();
  return kIndex;
}

const Index<AttributeRule>& attribute_index() {
  static const Index<AttributeRule> kIndex = [] {
    Index<AttributeRule> index;
    for (const AttributeRule& rule : attribute_rules())
      for (const std::string& owner : words_of(rule.owners))
        index[{owner, rule.name}] = &rule;
    return index;
  }();
  return kIndex;
}

template <class Rule>
const Rule* look_up(const Index<Rule>& index, std::string_view owner, std::string_view name) {
  const auto found = index.find({std::string(owner), std::string(name)});
  return found == index.end() ? nullptr : found->second;
}

template <class Rule>
std::vector<std::string> names_below(const Index<Rule>& index, std::string_view owner) {
  std::vector<std::string> names;
  for (auto at = index.lower_bound({std::string(owner), ""});
       at != index.end() && at->first.first == owner; ++at)
    names.push_back(at->first.second);
  return names;
}

const char* availability(Status status) {
  switch (status) {
    case Status::kQuiet:
    case Status::kNoEffect:
      return "  (accepted, no effect)";
    case Status::kRejected:
      return "  (not available in this version)";
    case Status::kOnlyFalse:
      return "  (only false or 0 in this version)";
    default:
      return "";
  }
}

std::string explain_attribute(const AttributeRule& rule) {
  std::string text = "  " + std::string(rule.name) + "=\"";
  text += rule.type == ValueType::kChoice ? rule.unit : type_name(rule.type);
  text += rule.required ? "\"  required. " : "\"  ";
  return text + rule.doc + availability(rule.status) + "\n";
}

std::string explain_child(const ElementRule& rule) {
  std::string text = "  <" + std::string(rule.name) + ">";
  if (rule.type != ValueType::kGroup) text += "  " + type_name(rule.type);
  if (*rule.unit && rule.status == Status::kSupported) text += " [" + std::string(rule.unit) + "]";
  if (rule.occurs == '1' || rule.occurs == '+') text += "  required";
  return text + "  " + rule.doc + availability(rule.status) + "\n";
}

}  // namespace

const std::vector<ElementRule>& element_rules() {
  static const std::vector<ElementRule> kRules = [] {
    std::vector<ElementRule> all = sdf_elements();
    for (const ElementRule& rule : cprsim_elements())
      all.push_back(rule);
    return all;
  }();
  return kRules;
}

const std::vector<AttributeRule>& attribute_rules() {
  static const std::vector<AttributeRule> kRules = [] {
    std::vector<AttributeRule> all = sdf_attributes();
    for (const AttributeRule& rule : cprsim_attributes())
      all.push_back(rule);
    return all;
  }();
  return kRules;
}

const ElementRule* find_element(std::string_view parent_id, std::string_view name) {
  return look_up(element_index(), parent_id, name);
}

const AttributeRule* find_attribute(std::string_view owner_id, std::string_view name) {
  return look_up(attribute_index(), owner_id, name);
}

std::vector<std::string> element_names(std::string_view parent_id) {
  return names_below(element_index(), parent_id);
}

std::vector<std::string> attribute_names(std::string_view owner_id) {
  return names_below(attribute_index(), owner_id);
}

std::string type_name(ValueType type) {
  switch (type) {
    case ValueType::kGroup:
      return "elements";
    case ValueType::kAny:
      return "anything";
    case ValueType::kEmpty:
      return "nothing";
    case ValueType::kNumber:
      return "a finite number";
    case ValueType::kPositive:
      return "a number greater than 0";
    case ValueType::kNonNegative:
      return "a number of at least 0";
    case ValueType::kLimit:
      return "a number or inf";
    case ValueType::kCount:
      return "a whole number of at least 1";
    case ValueType::kInteger:
      return "a whole number of at least 0";
    case ValueType::kBool:
      return "true or false";
    case ValueType::kVec2:
      return "2 finite numbers";
    case ValueType::kVec3:
      return "3 finite numbers";
    case ValueType::kRgba:
      return "3 or 4 numbers of at least 0";
    case ValueType::kPose:
      return "x y z roll pitch yaw";
    case ValueType::kName:
      return "a name without blanks, dots, colons or brackets";
    case ValueType::kRef:
      return "a name";
    case ValueType::kChoice:
      return "a word";
    case ValueType::kNumbers:
      return "finite numbers";
    case ValueType::kKeyframes:
      return "pairs of time and value separated by commas, times ascending";
    default:
      return "text";
  }
}

std::string explain_element(std::string_view name) {
  std::string text;
  std::set<std::string_view> seen;
  for (const ElementRule& rule : element_rules()) {
    const bool prefix_left_out = std::string_view(rule.name) == "cprsim:" + std::string(name);
    if (rule.name != name && !prefix_left_out) continue;
    text += "<" + std::string(rule.name) + "> in ";
    for (const std::string& parent : words_of(rule.parents))
      text += "<" + parent + "> ";
    if (!*rule.parents) text += "the file";
    text += "\n" + explain_child(rule);
    if (!seen.insert(rule.key()).second || rule.type == ValueType::kAny) continue;
    for (const std::string& attribute : attribute_names(rule.key()))
      text += explain_attribute(*find_attribute(rule.key(), attribute));
    for (const std::string& child : element_names(rule.key()))
      text += explain_child(*find_element(rule.key(), child));
  }
  return text;
}

}  // namespace cprsim
