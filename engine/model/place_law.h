// SPDX-License-Identifier: BSD-3-Clause
// Loads along rods whose force per length follows from where a section is: what scenes call them
// and their values. The forces themselves are in engine/section/place_laws.h, in the same order.
#pragma once

#include <array>

namespace cprsim {

struct LawValue {
  enum Kind { kPositive, kPlace, kDirection };  ///< one number; three; a unit vector

  const char* word = nullptr;
  Kind kind = kPositive;
  const char* unit = "";
  const char* doc = "";

  int size() const { return kind == kPositive ? 1 : 3; }
};

struct PlaceLaw {
  const char* word;
  const char* doc;
  std::array<LawValue, 4> values;  ///< those without a word are none
};

/// Of all values of a law, one after the other.
constexpr std::size_t kLawNumbers = 12;

inline constexpr PlaceLaw kPlaceLaws[] = {
    {"foundation",
     "Springs all along, towards a plane.",
     {{{"stiffness", LawValue::kPositive, "N/m2", "Force per length and distance."},
       {"point", LawValue::kPlace, "m", "A point of the plane."},
       {"normal", LawValue::kDirection, "", "Its normal."}}}},
    {"conducting_plane",
     "Grounded: attracts a charged rod.",
     {{{"charge", LawValue::kPositive, "C/m", "Of the rod, per length."},
       {"point", LawValue::kPlace, "m", "A point of the plane."},
       {"normal", LawValue::kDirection, "", "Its normal."}}}},
};

}  // namespace cprsim
