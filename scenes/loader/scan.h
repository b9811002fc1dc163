// SPDX-License-Identifier: BSD-3-Clause
// What the XML library does not tell: the columns of tags, attributes and texts; and a first look
// that refuses hostile files before the library sees them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/model/place.h"

namespace cprsim {

class Reporter;

struct ScannedAttribute {
  Place name, value;
};

/// One start tag, in document order.
struct ScannedTag {
  std::string_view name;
  Place place, text;  ///< text: first character after the tag that is not white space
  std::vector<ScannedAttribute> attributes;
};

/// Start tags of `text`. Reports and returns an empty list if the file must not be parsed.
/// Limits: nesting 90 (the library's own is 98), 256 attributes per tag, 100 000 elements.
std::vector<ScannedTag> scan_tags(const std::string& text, int file, Reporter& report);

/// Position of the first byte that is not valid UTF-8 or is a forbidden control character, or npos.
std::size_t find_bad_byte(std::string_view text);

}  // namespace cprsim
