// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scenes/loader/document.h"

namespace cprsim {

const Attribute* Node::attribute(std::string_view key) const {
  for (const Attribute& a : attributes)
    if (a.name == key) return &a;
  return nullptr;
}

std::string_view Node::value(std::string_view key) const {
  const Attribute* found = attribute(key);
  return found ? std::string_view(found->value) : std::string_view();
}

const Node* Node::child(std::string_view element) const {
  for (const auto& node : children)
    if (node->name == element && !node->broken) return node.get();
  return nullptr;
}

std::vector<const Node*> Node::all(std::string_view element) const {
  std::vector<const Node*> found;
  for (const auto& node : children)
    if (node->name == element && !node->broken) found.push_back(node.get());
  return found;
}

std::unique_ptr<Node> Node::clone() const {
  auto copy = std::make_unique<Node>();
  copy->name = name;
  copy->text = text;
  copy->place = place;
  copy->text_place = text_place;
  copy->attributes = attributes;
  copy->foreign = foreign;
  copy->broken = broken;
  for (const auto& node : children)
    copy->append(node->clone());
  return copy;
}

void Node::set_attribute(std::string_view key, std::string_view to) {
  for (Attribute& a : attributes)
    if (a.name == key) {
      a.value = to;
      return;
    }
  attributes.push_back({std::string(key), std::string(to), place, Place{}});
}

Node& Node::need(std::string_view element) {
  for (const auto& node : children)
    if (node->name == element) return *node;
  auto node = std::make_unique<Node>();
  node->name = element;
  node->place = place;
  append(std::move(node));
  return *children.back();
}

void Node::append(std::unique_ptr<Node> node) {
  node->parent = this;
  children.push_back(std::move(node));
}

std::string context_of(const Node& node) {
  std::string text;
  for (const Node* at = &node; at; at = at->parent) {
    const std::string_view name = at->value("name");
    if (name.empty() || !at->parent) continue;
    text = at->name + " '" + std::string(name) + "'" + (text.empty() ? "" : " / ") + text;
  }
  return text.empty() ? text : "in " + text;
}

std::string describe(const Node& node) {
  std::string text = "<" + node.name + ">";
  for (const char* key : {"name", "rod", "joint", "at", "of"})
    if (const std::string_view value = node.value(key); !value.empty())
      return text + " '" + std::string(value) + "'";
  return text;
}

}  // namespace cprsim
