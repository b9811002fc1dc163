// SPDX-License-Identifier: BSD-3-Clause
// A scene file as a tree of elements that all know where they were written, and the checks that
// come before any meaning: size, encoding, nesting, well-formed XML, namespaces.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/place.h"

namespace cprsim {

class Reporter;
struct ElementRule;

struct Attribute {
  std::string name, value;
  Place place;        ///< of the name
  Place value_place;  ///< of the first character between the quotes
};

/// One element. Names of the namespace urn:cprsim:1 always start with "cprsim:", whatever prefix
/// the file uses.
struct Node {
  std::string name;
  std::string text;  ///< trimmed
  Place place;       ///< of the '<'
  Place text_place;
  std::vector<Attribute> attributes;
  std::vector<std::unique_ptr<Node>> children;
  Node* parent = nullptr;
  const ElementRule* rule = nullptr;  ///< set by validation
  bool foreign = false;               ///< of somebody else's namespace
  bool broken = false;                ///< already complained about: do not read

  const Attribute* attribute(std::string_view key) const;
  /// Value of an attribute, or empty.
  std::string_view value(std::string_view key) const;
  const Node* child(std::string_view element) const;
  std::vector<const Node*> all(std::string_view element) const;
  std::unique_ptr<Node> clone() const;
  void set_attribute(std::string_view key, std::string_view to);
  /// The child of that name, created at the end if there is none.
  Node& need(std::string_view element);
  void append(std::unique_ptr<Node> node);
};

/// "in world 'w' / model 'm' / cprsim:rod 'leg'", without the node itself if it has no name.
std::string context_of(const Node& node);

/// "<cprsim:rod> 'leg_1'"
std::string describe(const Node& node);

/// Parses `text`, the content of the file of that index. Null after an error, which has been
/// reported.
std::unique_ptr<Node> parse_document(const std::string& text, int file, Reporter& report);

}  // namespace cprsim
