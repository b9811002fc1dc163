// SPDX-License-Identifier: BSD-3-Clause
// What the names of channels are made of: patterns, and lists of an entity's scalars.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/model/channel.h"

namespace cprsim {

inline constexpr const char* kAxes[] = {"x", "y", "z", "w"};

struct ChannelScalar {
  std::string suffix;  ///< after the entity, e.g. "tip.position.x" or "(s=0.5).position.x"
  Channel channel;
};

struct NamedEntity {
  std::string name;
  ChannelEntity kind = ChannelEntity::kBody;
  int index = -1;
};

/// Whether a pattern with * fits a text as a whole.
bool glob_fits(std::string_view pattern, std::string_view text);

/// Whether it fits the name, or the name up to one of its dots.
bool selects_channel(std::string_view rest, std::string_view name);

/// Letters to insert, drop or replace.
int letters_apart(std::string_view a, std::string_view b);

const char* unit_of(Quantity quantity);

class ChannelList {
 public:
  explicit ChannelList(const NamedEntity& entity) : entity_(entity) {}

  void add(const std::string& suffix, Quantity quantity, int component = 0,
           const char* unit = nullptr) {
    ChannelScalar scalar;
    scalar.suffix = suffix;
    Channel& c = scalar.channel;
    const bool point = !suffix.empty() && suffix.front() == '(';
    c.name = entity_.name + (point ? "" : ".") + suffix;
    c.unit = unit ? unit : unit_of(quantity);
    c.entity = entity_.kind;
    c.index = entity_.index;
    c.quantity = quantity;
    c.component = component;
    c.s = s;
    scalars.push_back(std::move(scalar));
  }

  void add_vector(const std::string& suffix, Quantity quantity, int components = 3) {
    for (int k = 0; k < components; ++k)
      add(suffix + "." + kAxes[k], quantity, k);
  }

  void add_point(const std::string& where, double fraction) {
    s = fraction;
    const ChannelEntity kind = entity_.kind;
    entity_.kind = ChannelEntity::kRodPoint;
    add_vector(where + ".position", Quantity::kPosition);
    add_vector(where + ".orientation", Quantity::kOrientation, 4);
    add_vector(where + ".linear_velocity", Quantity::kLinearVelocity);
    add_vector(where + ".wrench.force", Quantity::kForce);
    add_vector(where + ".wrench.moment", Quantity::kMoment);
    add_vector(where + ".curvature", Quantity::kCurvature);
    add_vector(where + ".strain", Quantity::kShearStretch);
    entity_.kind = kind;
    s = 0;
  }

  std::vector<ChannelScalar> scalars;
  double s = 0;

 private:
  NamedEntity entity_;
};

/// Of `contact(a,b).rest`.
std::vector<Channel> find_pair_channels(const Scene& scene, const PairPattern& pattern);
std::vector<std::string> nearest_pair_channels(const Scene& scene, const PairPattern& pattern,
                                               std::size_t count);

}  // namespace cprsim
