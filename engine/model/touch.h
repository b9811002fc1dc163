// SPDX-License-Identifier: BSD-3-Clause
// Who may touch whom: links and rods of a scene by twos.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace cprsim {

struct Channel;
struct Scene;
struct TieSpec;

/// A link or a rod.
struct ContactParty {
  bool rod = false;
  int index = -1;  ///< into Scene::rods or Scene::bodies

  bool operator==(const ContactParty& other) const {
    return rod == other.rod && index == other.index;
  }
};

using ContactPair = std::array<ContactParty, 2>;

inline bool same_pair(const ContactPair& a, const ContactPair& b) {
  return (a[0] == b[0] && a[1] == b[1]) || (a[0] == b[1] && a[1] == b[0]);
}

/// All links, then all rods.
std::vector<ContactParty> contact_parties(const Scene& scene);

const std::string& party_name(const Scene& scene, const ContactParty& party);

/// The first tie of two rods, indices into Scene::rods; null if nothing ties them.
const TieSpec* tie_between(const Scene& scene, int rod, int other);

/// Why a pair can never touch as the scene stands; empty if it may.
std::string why_never_touching(const Scene& scene, const ContactPair& pair);

/// What a channel `contact(a,b).rest` names; the views are of the text.
struct PairPattern {
  bool is_one = false;  ///< begins with "contact("
  bool whole = false;   ///< and has two names and a rest
  std::string_view a, b, rest;
};

PairPattern pair_pattern(std::string_view text);

/// Has the distances of the channels' pairs measured in runs of the scene: `gap`, `penetration` and
/// `position` need them, and they cost time.
void watch_pairs(Scene& scene, const std::vector<Channel>& channels);

}  // namespace cprsim
