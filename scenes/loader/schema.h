// SPDX-License-Identifier: BSD-3-Clause
// The scene language as one table: which element may stand where, what it holds, in which unit,
// whether this version carries it out. Unknown-name errors, suggestions, type checks and the
// reference text all come from it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/loader/document.h"

namespace cprsim {

class Reporter;

enum class ValueType {
  kGroup,  ///< elements only
  kAny,    ///< not looked into
  kEmpty,
  kText,
  kNumber,
  kPositive,
  kNonNegative,
  kLimit,    ///< a number, infinite allowed
  kCount,    ///< integer >= 1
  kInteger,  ///< integer >= 0
  kBool,
  kVec2,
  kVec3,
  kRgba,
  kPose,  ///< 6 or 7 numbers, or nothing
  kName,
  kRef,
  kChoice,
  kNumbers,
  kKeyframes
};

enum class Status {
  kSupported,
  kQuiet,      ///< accepted, no effect by the nature of this program: a note
  kNoEffect,   ///< accepted, no effect: one grouped warning
  kOnlyFalse,  ///< supported as long as it is false or 0
  kRejected    ///< E520, a warning with --lax
};

/// An element under each of its parents. For kRejected `unit` says what is available instead.
struct ElementRule {
  const char* parents;  ///< ids of the parents, separated by blanks
  const char* name;
  const char* id;  ///< distinguishes elements of one name; empty: the name
  ValueType type;
  const char* unit;
  char occurs;  ///< '?' at most one, '1' exactly one, '*' any number, '+' at least one
  Status status;
  const char* doc;

  std::string_view key() const { return *id ? id : name; }
};

/// For kChoice `unit` holds the words, separated by '|'; those not available in this version start
/// with '!'.
struct AttributeRule {
  const char* owners;  ///< element ids
  const char* name;
  ValueType type;
  const char* unit;
  bool required;
  Status status;
  const char* doc;
};

const std::vector<ElementRule>& element_rules();
const std::vector<AttributeRule>& attribute_rules();

/// The halves of the table, written in schema_sdf.cpp and schema_cprsim.cpp.
std::vector<ElementRule> sdf_elements();
std::vector<ElementRule> cprsim_elements();
std::vector<AttributeRule> sdf_attributes();
std::vector<AttributeRule> cprsim_attributes();

const ElementRule* find_element(std::string_view parent_id, std::string_view name);
const AttributeRule* find_attribute(std::string_view owner_id, std::string_view name);

/// Names legal below an element, or of its attributes.
std::vector<std::string> element_names(std::string_view parent_id);
std::vector<std::string> attribute_names(std::string_view owner_id);

/// Checks a whole tree against the table; marks what must not be read as broken.
void validate(Node& root, bool lax, Reporter& report);

/// What the reference says of an element ("cprsim:rod", "cross_section") at every place where it
/// may stand; empty if there is none.
std::string explain_element(std::string_view name);

/// "a finite number", "3 numbers"
std::string type_name(ValueType type);

}  // namespace cprsim
