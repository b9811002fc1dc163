// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/touch.h"

#include <algorithm>

#include "engine/model/flight.h"
#include "engine/model/scene.h"

namespace cprsim {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ')
    text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ')
    text.remove_suffix(1);
  return text;
}

const RodSpec& rod_of(const Scene& scene, const ContactParty& party) {
  return scene.rods[static_cast<std::size_t>(party.index)];
}

const BodySpec& body_of(const Scene& scene, const ContactParty& party) {
  return scene.bodies[static_cast<std::size_t>(party.index)];
}

/// What it has to touch with.
std::vector<const SurfaceSpec*> surfaces_of(const Scene& scene, const ContactParty& party) {
  std::vector<const SurfaceSpec*> surfaces;
  if (party.rod) {
    surfaces.push_back(&rod_of(scene, party).surface);
    return surfaces;
  }
  for (const ColliderSpec& collider : body_of(scene, party).colliders)
    if (collider.shape.kind != ShapeKind::kEmpty) surfaces.push_back(&collider.surface);
  return surfaces;
}

bool holds(const Scene& scene, const ContactParty& body, const RodSpec& rod) {
  const auto at = [&](const RodEndSpec& end) {
    return end.joint != EndJoint::kFree && end.at.body == body.index;
  };
  return !body_of(scene, body).is_static && (at(rod.base) || at(rod.tip));
}

std::string why_not_with_rod(const Scene& scene, const ContactParty& link, const RodSpec& rod) {
  const auto b = static_cast<std::size_t>(link.index);
  if (holds(scene, link, rod))
    return "'" + body_of(scene, link).name + "' holds '" + rod.name + "'";
  if (flying_bodies(scene)[b] && !bodies_among_rods(scene)[b])
    return "rods pass through '" + body_of(scene, link).name + "', which flies freely";
  return {};
}

/// The part of a scoped name before its last "::".
std::string model_of(const std::string& name) {
  const std::size_t at = name.rfind("::");
  return at == std::string::npos ? std::string() : name.substr(0, at);
}

std::string why_not_links(const Scene& scene, const ContactPair& pair) {
  const std::vector<char> flying = flying_bodies(scene);
  const auto flies = [&](const ContactParty& p) {
    return flying[static_cast<std::size_t>(p.index)] != 0;
  };
  if (flies(pair[0]) || flies(pair[1])) return {};
  const BodySpec &a = body_of(scene, pair[0]), &b = body_of(scene, pair[1]);
  if (a.is_static && b.is_static) return "of two links one has to move";
  if (model_of(a.name) == model_of(b.name))
    return "links of one model that joints or rods hold do not touch each other";
  for (const JointSpec& joint : scene.joints)
    if ((joint.parent == pair[0].index && joint.child == pair[1].index) ||
        (joint.parent == pair[1].index && joint.child == pair[0].index))
      return "joint '" + joint.name + "' joins them";
  return {};
}

}  // namespace

const TieSpec* tie_between(const Scene& scene, int rod, int other) {
  for (const TieSpec& tie : scene.ties)
    if ((tie.rod == rod && tie.other == other) || (tie.rod == other && tie.other == rod))
      return &tie;
  return nullptr;
}

std::vector<ContactParty> contact_parties(const Scene& scene) {
  std::vector<ContactParty> all;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k)
    all.push_back({false, static_cast<int>(k)});
  for (std::size_t k = 0; k < scene.rods.size(); ++k)
    all.push_back({true, static_cast<int>(k)});
  return all;
}

const std::string& party_name(const Scene& scene, const ContactParty& party) {
  return party.rod ? rod_of(scene, party).name : body_of(scene, party).name;
}

std::string why_never_touching(const Scene& scene, const ContactPair& pair) {
  const auto &a = pair[0], &b = pair[1];
  const bool itself = a == b;
  const std::string effect = itself ? "self_contact" : "contact";
  if (itself && !a.rod) return "a link does not touch itself";
  if (!scene.effects.has(itself ? Effect::kSelfContact : Effect::kContact))
    return effect + " is not among the effects";
  for (const ContactParty& party : pair) {
    if (party.rod && rod_of(scene, party).lacks(effect.c_str()))
      return "'" + party_name(scene, party) + "' is <without>" + effect + "</without>";
    if (surfaces_of(scene, party).empty())
      return "'" + party_name(scene, party) + "' has no <collision>";
  }
  if (itself) return {};
  const auto of_a = surfaces_of(scene, a), of_b = surfaces_of(scene, b);
  const bool by_bits = std::any_of(of_a.begin(), of_a.end(), [&](const SurfaceSpec* one) {
    return std::any_of(of_b.begin(), of_b.end(),
                       [&](const SurfaceSpec* other) { return may_touch(*one, *other); });
  });
  if (!by_bits) return "their bitmasks keep them apart";
  if (a.rod && b.rod) {
    const TieSpec* tie = tie_between(scene, a.index, b.index);
    return tie ? "tie '" + tie->name + "' holds them together" : std::string();
  }
  if (a.rod) return why_not_with_rod(scene, b, rod_of(scene, a));
  if (b.rod) return why_not_with_rod(scene, a, rod_of(scene, b));
  return why_not_links(scene, pair);
}

PairPattern pair_pattern(std::string_view text) {
  constexpr std::string_view kHead = "contact(";
  PairPattern p;
  p.is_one = text.substr(0, kHead.size()) == kHead;
  if (!p.is_one) return p;
  text.remove_prefix(kHead.size());
  const std::size_t comma = text.find(','), close = text.find(").");
  if (comma == std::string_view::npos || close == std::string_view::npos || close < comma) return p;
  p.a = trimmed(text.substr(0, comma));
  p.b = trimmed(text.substr(comma + 1, close - comma - 1));
  p.rest = text.substr(close + 2);
  p.whole = !p.a.empty() && !p.b.empty() && !p.rest.empty();
  return p;
}

void watch_pairs(Scene& scene, const std::vector<Channel>& channels) {
  for (const Channel& channel : channels) {
    const bool measured = channel.entity == ChannelEntity::kContactPair &&
                          (channel.quantity == Quantity::kContactGap ||
                           channel.quantity == Quantity::kContactPenetration ||
                           channel.quantity == Quantity::kPosition);
    const bool known =
        std::any_of(scene.watched.begin(), scene.watched.end(),
                    [&](const ContactPair& pair) { return same_pair(pair, channel.pair); });
    if (measured && !known) scene.watched.push_back(channel.pair);
  }
}

}  // namespace cprsim
