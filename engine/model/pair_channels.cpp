// SPDX-License-Identifier: BSD-3-Clause
// Names of what passes between two: contact(a,b).rest.
#include <algorithm>

#include "engine/model/channel_list.h"
#include "engine/model/scene.h"

namespace cprsim {

namespace {

std::vector<ChannelScalar> scalars_of_pair(const Scene& scene, const ContactPair& pair) {
  const std::string name =
      "contact(" + party_name(scene, pair[0]) + "," + party_name(scene, pair[1]) + ")";
  ChannelList list({name, ChannelEntity::kContactPair, 0});
  list.add("count", Quantity::kContactCount);
  list.add("penetration", Quantity::kContactPenetration);
  if (pair[0].rod || pair[1].rod) list.add("gap", Quantity::kContactGap);
  list.add_vector("force", Quantity::kForce);
  list.add("force.normal", Quantity::kContactForce);
  list.add("force.friction", Quantity::kContactFriction);
  list.add_vector("position", Quantity::kPosition);
  list.add("slip", Quantity::kContactSlip);
  for (ChannelScalar& scalar : list.scalars)
    scalar.channel.pair = pair;
  return std::move(list.scalars);
}

// `force` is the vector; its sizes are asked for by name, or by *.
void pick_pair(const Scene& scene, const ContactPair& pair, std::string_view rest,
               std::vector<Channel>& out) {
  for (const ChannelScalar& scalar : scalars_of_pair(scene, pair)) {
    const bool size = scalar.channel.quantity == Quantity::kContactForce ||
                      scalar.channel.quantity == Quantity::kContactFriction;
    if (size ? glob_fits(rest, scalar.suffix) : selects_channel(rest, scalar.suffix))
      out.push_back(scalar.channel);
  }
}

// Of names with * those pairs that may touch, each once; of names in full whatever they name.
void pick_pairs(const Scene& scene, const PairPattern& pattern, std::vector<Channel>& out) {
  const bool globs = pattern.a.find('*') != std::string_view::npos ||
                     pattern.b.find('*') != std::string_view::npos;
  const std::vector<ContactParty> parties = contact_parties(scene);
  std::vector<ContactPair> taken;
  for (const ContactParty& a : parties) {
    if (!glob_fits(pattern.a, party_name(scene, a))) continue;
    for (const ContactParty& b : parties) {
      if (!glob_fits(pattern.b, party_name(scene, b))) continue;
      const ContactPair pair{a, b};
      const auto same = [&](const ContactPair& other) { return same_pair(pair, other); };
      if (globs && (!why_never_touching(scene, pair).empty() ||
                    std::any_of(taken.begin(), taken.end(), same)))
        continue;
      taken.push_back(pair);
      pick_pair(scene, pair, pattern.rest, out);
    }
  }
}

}  // namespace

std::vector<Channel> find_pair_channels(const Scene& scene, const PairPattern& pattern) {
  std::vector<Channel> channels;
  if (pattern.whole) pick_pairs(scene, pattern, channels);
  return channels;
}

/// Each name as it is where it is one, else the nearest.
std::vector<std::string> nearest_pair_channels(const Scene& scene, const PairPattern& pattern,
                                               std::size_t count) {
  using Ranked = std::vector<std::pair<int, std::string>>;
  const auto best = [&](Ranked ranked) {
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    if (ranked.size() > count) ranked.resize(count);
    return ranked;
  };
  const auto near = [&](std::string_view wanted) {
    Ranked ranked;
    for (const ContactParty& party : contact_parties(scene)) {
      const std::string& name = party_name(scene, party);
      if (glob_fits(wanted, name)) return Ranked{{0, std::string(wanted)}};
      ranked.emplace_back(letters_apart(wanted, name), name);
    }
    return best(std::move(ranked));
  };
  Ranked rests;
  for (const char* rest : {"*", "count", "penetration", "gap", "force", "force.normal",
                           "force.friction", "position", "slip"})
    rests.emplace_back(letters_apart(pattern.rest, rest), rest);
  std::vector<Channel> found;
  const ContactPair any{ContactParty{true, 0}, ContactParty{true, 0}};
  if (!scene.rods.empty()) pick_pair(scene, any, pattern.rest, found);
  if (!found.empty()) rests = {{0, std::string(pattern.rest)}};
  Ranked all;
  for (const auto& [da, a] : near(pattern.a))
    for (const auto& [db, b] : near(pattern.b))
      for (const auto& [dr, rest] : best(rests)) {
        std::string name = "contact(";
        name += a + "," + b + ")." + rest;
        all.emplace_back(da + db + dr, std::move(name));
      }
  std::vector<std::string> names;
  for (const auto& [apart, name] : best(std::move(all)))
    names.push_back(name);
  return names;
}

}  // namespace cprsim
