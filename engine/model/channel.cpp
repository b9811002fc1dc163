// SPDX-License-Identifier: BSD-3-Clause
// Names to channels. A pattern splits into an entity, an optional point on a rod and a rest:
//   robot::leg_*(s=0.5).position.x  ->  robot::leg_* | 0.5 | position.x
// Every entity has a list of scalar names; the rest selects those that it matches as a whole or up
// to a dot. Of these `pose` stands for position and orientation, `wrench` groups force and moment,
// and `shape` stands for eleven points. `contact(a,b).rest` is apart: two names, then the rest.
#include "engine/model/channel.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/model/scene.h"

namespace cprsim {

namespace {

constexpr int kShapePoints = 11;
constexpr const char* kAxes[] = {"x", "y", "z", "w"};

struct Scalar {
  std::string suffix;  ///< after the entity, e.g. "tip.position.x" or "(s=0.5).position.x"
  Channel channel;
};

struct Entity {
  std::string name;
  ChannelEntity kind = ChannelEntity::kBody;
  int index = -1;
};

bool glob(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, mark = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      mark = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++mark;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*')
    ++p;
  return p == pattern.size();
}

const char* unit_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::kPosition:
    case Quantity::kLength:
    case Quantity::kDisplacement:
    case Quantity::kContactPenetration:
    case Quantity::kContactGap:
      return "m";
    case Quantity::kLinearVelocity:
    case Quantity::kContactSlip:
      return "m/s";
    case Quantity::kAngularVelocity:
      return "rad/s";
    case Quantity::kForce:
    case Quantity::kTension:
    case Quantity::kContactForce:
    case Quantity::kContactFriction:
      return "N";
    case Quantity::kMoment:
      return "N m";
    case Quantity::kCurvature:
      return "1/m";
    case Quantity::kEnergyKinetic:
    case Quantity::kEnergyElastic:
    case Quantity::kEnergyGravity:
    case Quantity::kEnergyDissipated:
    case Quantity::kEnergyWork:
    case Quantity::kEnergyTotal:
    case Quantity::kEnergyBalance:
      return "J";
    case Quantity::kSolverStep:
    case Quantity::kSolverWallTime:
      return "s";
    default:
      return "1";
  }
}

class List {
 public:
  explicit List(const Entity& entity) : entity_(entity) {}

  void add(const std::string& suffix, Quantity quantity, int component = 0,
           const char* unit = nullptr) {
    Scalar scalar;
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

  std::vector<Scalar> scalars;
  double s = 0;

 private:
  Entity entity_;
};

void add_joint(List& list, const JointSpec& joint) {
  const bool ball = joint.kind == JointKind::kBall;
  const int count = ball ? 3 : freedom_count(joint.kind);
  const auto add = [&](const char* name, Quantity quantity, const char* turn, const char* slide) {
    for (int i = 0; i < count; ++i) {
      std::string suffix = name;
      if (ball) suffix += std::string(".") + kAxes[i];
      if (!ball && count > 1) suffix += "." + std::to_string(i + 1);
      list.add(suffix, quantity, i, slides(joint.kind, i) ? slide : turn);
    }
  };
  add("position", Quantity::kJointPosition, "rad", "m");
  add("velocity", Quantity::kJointVelocity, "rad/s", "m/s");
  add("effort", Quantity::kJointEffort, "N m", "N");
  bool limited = false;
  for (int i = 0; i < freedom_count(joint.kind); ++i)
    limited = limited || axis_of(joint, i).limited();
  if (limited) add("limit", Quantity::kJointLimit, "N m", "N");
}

void add_sums(List& list, ChannelEntity kind) {
  if (kind == ChannelEntity::kEnergy) {
    list.add("kinetic", Quantity::kEnergyKinetic);
    list.add("elastic", Quantity::kEnergyElastic);
    list.add("gravity", Quantity::kEnergyGravity);
    list.add("dissipated", Quantity::kEnergyDissipated);
    list.add("work", Quantity::kEnergyWork);
    list.add("total", Quantity::kEnergyTotal);
    list.add("balance", Quantity::kEnergyBalance);
  } else if (kind == ChannelEntity::kSolver) {
    list.add("iterations", Quantity::kSolverIterations);
    list.add("residual", Quantity::kSolverResidual);
    list.add("step", Quantity::kSolverStep);
    list.add("wall_time", Quantity::kSolverWallTime);
  } else {
    list.add("count", Quantity::kContactCount);
    list.add("penetration", Quantity::kContactPenetration);
    list.add("force", Quantity::kContactForce);
    list.add("friction", Quantity::kContactFriction);
    list.add("slip", Quantity::kContactSlip);
  }
}

// every scalar of an entity but those of arbitrary points of a rod
std::vector<Scalar> scalars_of(const Scene& scene, const Entity& entity) {
  List list(entity);
  switch (entity.kind) {
    case ChannelEntity::kBody:
    case ChannelEntity::kFrame:
      list.add_vector("position", Quantity::kPosition);
      list.add_vector("orientation", Quantity::kOrientation, 4);
      list.add_vector("linear_velocity", Quantity::kLinearVelocity);
      list.add_vector("angular_velocity", Quantity::kAngularVelocity);
      break;
    case ChannelEntity::kJoint:
      add_joint(list, scene.joints[static_cast<std::size_t>(entity.index)]);
      break;
    case ChannelEntity::kRod:
    case ChannelEntity::kRodPoint:
      list.add("length", Quantity::kLength);
      list.add_point("base", 0);
      list.add_point("tip", 1);
      break;
    case ChannelEntity::kTendon:
      list.add("tension", Quantity::kTension);
      list.add("displacement", Quantity::kDisplacement);
      break;
    default:
      add_sums(list, entity.kind);
  }
  return std::move(list.scalars);
}

std::vector<Entity> entities_of(const Scene& scene) {
  std::vector<Entity> all;
  const auto add = [&](const std::string& name, ChannelEntity kind, std::size_t index) {
    all.push_back({name, kind, static_cast<int>(index)});
  };
  for (std::size_t k = 0; k < scene.bodies.size(); ++k)
    add(scene.bodies[k].name, ChannelEntity::kBody, k);
  for (std::size_t k = 0; k < scene.frames.size(); ++k)
    add(scene.frames[k].name, ChannelEntity::kFrame, k);
  for (std::size_t k = 0; k < scene.joints.size(); ++k)
    add(scene.joints[k].name, ChannelEntity::kJoint, k);
  for (std::size_t k = 0; k < scene.rods.size(); ++k)
    add(scene.rods[k].name, ChannelEntity::kRod, k);
  for (std::size_t k = 0; k < scene.tendons.size(); ++k)
    add(scene.tendons[k].name, ChannelEntity::kTendon, k);
  all.push_back({"energy", ChannelEntity::kEnergy, 0});
  all.push_back({"solver", ChannelEntity::kSolver, 0});
  all.push_back({"contact", ChannelEntity::kContact, 0});
  return all;
}

std::string point_suffix(double s) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, s);
  return "(s=" + (error == std::errc() ? std::string(buffer, end) : std::string("?")) + ")";
}

struct Pattern {
  std::string_view entity, rest;
  bool at_point = false;
  double s = 0;
  bool valid = true;
};

Pattern split(std::string_view text) {
  Pattern p;
  const std::size_t open = text.find("(s=");
  if (open == std::string_view::npos) {
    const std::size_t dot = text.find('.');
    p.valid = dot != std::string_view::npos && dot > 0;
    if (!p.valid) return p;
    p.entity = text.substr(0, dot);
    p.rest = text.substr(dot + 1);
    return p;
  }
  const std::size_t close = text.find(").", open);
  p.valid = open > 0 && close != std::string_view::npos;
  if (!p.valid) return p;
  p.entity = text.substr(0, open);
  p.rest = text.substr(close + 2);
  p.at_point = true;
  const std::string_view number = text.substr(open + 3, close - open - 3);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), p.s);
  p.valid = error == std::errc() && end == number.data() + number.size() && p.s >= 0 && p.s <= 1;
  return p;
}

// "tip.pose" -> "tip.position", "tip.orientation"
std::vector<std::string> expand_pose(std::string_view rest) {
  constexpr std::string_view kPose = "pose";
  const std::size_t found = rest.find(kPose);
  const bool whole = found != std::string_view::npos && (found == 0 || rest[found - 1] == '.') &&
                     found + kPose.size() == rest.size();
  if (!whole) return {std::string(rest)};
  const std::string head(rest.substr(0, found));
  return {head + "position", head + "orientation"};
}

bool selects(std::string_view rest, std::string_view name) {
  if (glob(rest, name)) return true;
  for (std::size_t dot = name.find('.'); dot != std::string_view::npos;
       dot = name.find('.', dot + 1))
    if (glob(rest, name.substr(0, dot))) return true;
  return false;
}

void pick(const std::vector<Scalar>& scalars, const std::string& head, std::string_view rest,
          std::vector<Channel>& out) {
  for (const std::string& wanted : expand_pose(rest))
    for (const Scalar& scalar : scalars)
      if (selects(head + wanted, scalar.suffix)) out.push_back(scalar.channel);
}

void pick_point(const Entity& rod, double s, std::string_view rest, std::vector<Channel>& out) {
  List list(rod);
  const std::string where = point_suffix(s);
  list.add_point(where, s);
  pick(list.scalars, where + ".", rest, out);
}

void pick_from(const Scene& scene, const Entity& entity, const Pattern& pattern,
               std::vector<Channel>& out) {
  const bool rod = entity.kind == ChannelEntity::kRod;
  if (pattern.at_point) {
    if (rod) pick_point(entity, pattern.s, pattern.rest, out);
    return;
  }
  const bool shape = pattern.rest == "shape";
  if (rod && (shape || pattern.rest == "curvature" || pattern.rest == "strain")) {
    for (int k = 0; k < kShapePoints; ++k)
      pick_point(entity, k / double(kShapePoints - 1), shape ? "position" : pattern.rest, out);
    return;
  }
  pick(scalars_of(scene, entity), "", pattern.rest, out);
}

std::vector<Scalar> scalars_of_pair(const Scene& scene, const ContactPair& pair) {
  const std::string name =
      "contact(" + party_name(scene, pair[0]) + "," + party_name(scene, pair[1]) + ")";
  List list({name, ChannelEntity::kContactPair, 0});
  list.add("count", Quantity::kContactCount);
  list.add("penetration", Quantity::kContactPenetration);
  if (pair[0].rod || pair[1].rod) list.add("gap", Quantity::kContactGap);
  list.add_vector("force", Quantity::kForce);
  list.add("force.normal", Quantity::kContactForce);
  list.add("force.friction", Quantity::kContactFriction);
  list.add_vector("position", Quantity::kPosition);
  list.add("slip", Quantity::kContactSlip);
  for (Scalar& scalar : list.scalars)
    scalar.channel.pair = pair;
  return std::move(list.scalars);
}

// `force` is the vector; its sizes are asked for by name, or by *.
void pick_pair(const Scene& scene, const ContactPair& pair, std::string_view rest,
               std::vector<Channel>& out) {
  for (const Scalar& scalar : scalars_of_pair(scene, pair)) {
    const bool size = scalar.channel.quantity == Quantity::kContactForce ||
                      scalar.channel.quantity == Quantity::kContactFriction;
    if (size ? glob(rest, scalar.suffix) : selects(rest, scalar.suffix))
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
    if (!glob(pattern.a, party_name(scene, a))) continue;
    for (const ContactParty& b : parties) {
      if (!glob(pattern.b, party_name(scene, b))) continue;
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

int distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

// names without their components: what people write
std::vector<std::string> stems_of(const Scene& scene, const Entity& entity) {
  std::vector<std::string> stems;
  for (const Scalar& scalar : scalars_of(scene, entity)) {
    std::string name = scalar.channel.name;
    const bool component = name.size() > 2 && name[name.size() - 2] == '.';
    if (component) name.resize(name.size() - 2);
    if (stems.empty() || stems.back() != name) stems.push_back(std::move(name));
  }
  if (stems.empty()) return stems;
  if (entity.kind == ChannelEntity::kBody || entity.kind == ChannelEntity::kFrame)
    stems.push_back(entity.name + ".pose");
  if (entity.kind == ChannelEntity::kRod)
    for (const char* more : {".base.pose", ".tip.pose", ".base.wrench", ".tip.wrench", ".shape",
                             ".curvature", ".strain"})
      stems.push_back(entity.name + more);
  return stems;
}

/// Each name as it is where it is one, else the nearest.
std::vector<std::string> nearest_pairs(const Scene& scene, const PairPattern& pattern,
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
      if (glob(wanted, name)) return Ranked{{0, std::string(wanted)}};
      ranked.emplace_back(distance(wanted, name), name);
    }
    return best(std::move(ranked));
  };
  Ranked rests;
  for (const char* rest : {"*", "count", "penetration", "gap", "force", "force.normal",
                           "force.friction", "position", "slip"})
    rests.emplace_back(distance(pattern.rest, rest), rest);
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

}  // namespace

std::vector<Channel> find_channels(const Scene& scene, std::string_view pattern) {
  std::vector<Channel> channels;
  if (const PairPattern pair = pair_pattern(pattern); pair.is_one) {
    if (pair.whole) pick_pairs(scene, pair, channels);
    return channels;
  }
  const Pattern parts = split(pattern);
  if (!parts.valid) return channels;
  for (const Entity& entity : entities_of(scene))
    if (glob(parts.entity, entity.name)) pick_from(scene, entity, parts, channels);
  return channels;
}

std::vector<std::string> nearest_channels(const Scene& scene, std::string_view pattern,
                                          std::size_t count) {
  constexpr std::size_t kLongest = 200;
  pattern = pattern.substr(0, kLongest);
  if (const PairPattern pair = pair_pattern(pattern); pair.is_one)
    return nearest_pairs(scene, pair, count);
  // the entity decides first, so that a wrong quantity is answered with that entity's own
  const auto entity_of = [](std::string_view name) {
    return name.substr(0, name.find_first_of(".("));
  };
  const std::string_view wanted = entity_of(pattern);
  std::vector<std::pair<int, std::string>> ranked;
  for (const Entity& entity : entities_of(scene)) {
    const int apart = 2 * distance(wanted, entity.name);
    for (const std::string& stem : stems_of(scene, entity))
      ranked.emplace_back(apart + distance(pattern, stem), stem);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (std::size_t k = 0; k < ranked.size() && k < count; ++k)
    names.push_back(ranked[k].second);
  return names;
}

}  // namespace cprsim
