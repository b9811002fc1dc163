// SPDX-License-Identifier: BSD-3-Clause
// Drives, loads and functions of time.
#include <array>
#include <set>

#include "scenes/loader/reading.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

bool resolve_tendon(Reading& r, const Node& node, int scope, const Attribute& name,
                    DriveSpec& drive) {
  if (const auto found = find_tendon(r, scope, name.value)) {
    drive.tendon = *found;
    return true;
  }
  std::vector<std::string> names;
  for (const TendonSpec& tendon : r.scene.tendons)
    names.push_back(tendon.name);
  r.report.bad_value("E404", node, name, "there is no tendon '" + name.value + "'",
                     mean(nearest_name(name.value, names)));
  return false;
}

bool resolve_driven(Reading& r, const Node& node, int scope, DriveSpec& drive) {
  const Attribute* joint = node.attribute("joint");
  const Attribute* rod = node.attribute("rod");
  const Attribute* tendon = node.attribute("tendon");
  if (int{joint != nullptr} + int{rod != nullptr} + int{tendon != nullptr} != 1) {
    r.report.error("E310", node,
                   "a drive acts on a joint, on a rod or on a tendon: give one of the three");
    return false;
  }
  if (tendon) return resolve_tendon(r, node, scope, *tendon, drive);
  const Attribute& target = joint ? *joint : *rod;
  const auto found = r.frames.find_outwards(scope, target.value);
  const FrameKind wanted = joint ? FrameKind::kJoint : FrameKind::kRod;
  if (!found || found->kind != wanted) {
    std::vector<std::string> names;
    for (const std::string& name : r.frames.known_names(scope))
      if (const auto other = r.frames.find_outwards(scope, name); other && other->kind == wanted)
        names.push_back(name);
    r.report.bad_value(
        joint ? "E403" : "E404", node, target,
        std::string("there is no ") + (joint ? "joint" : "rod") + " '" + target.value + "'",
        mean(nearest_name(target.value, names)));
    return false;
  }
  if (rod) {
    drive.rod = found->index;
    return true;
  }
  const auto index = r.joint_of_vertex.find(found->index);
  if (index == r.joint_of_vertex.end()) return false;
  drive.joint = index->second;
  if (r.scene.joints[at(drive.joint)].kind == JointKind::kFixed)
    r.report.bad_value("E310", node, target, "a fixed joint cannot be driven");
  return true;
}

// which axis of a joint; the only one need not be named
void resolve_axis(Reading& r, const Node& node, DriveSpec& drive) {
  const Attribute* axis = node.attribute("axis");
  if (axis) drive.freedom = axis->value.empty() ? 0 : axis->value.front() - '1';
  if (drive.joint < 0) {
    if (axis) r.report.bad_value("E310", node, *axis, "only a joint's drive has an axis");
    return;
  }
  const JointSpec& joint = r.scene.joints[at(drive.joint)];
  const int count = freedom_count(joint.kind);
  const std::string named = "joint '" + joint.name + "'";
  if (joint.kind == JointKind::kBall)
    r.report.bad_value("E520", node, *node.attribute("joint"),
                       "a ball joint has no single axis to drive",
                       "available: drives of revolute, prismatic, universal, screw, cylindrical "
                       "and planar joints; a torque by <cprsim:load>");
  else if (!axis && count > 1)
    r.report.error("E310", node,
                   named + " has " + std::to_string(count) +
                       " axes: say which one with axis=\"1\" to \"" + std::to_string(count) + "\"");
  else if (axis && count > 0 && drive.freedom >= count)
    r.report.bad_value("E310", node, *axis,
                       named + " has " + std::to_string(count) + (count > 1 ? " axes" : " axis"));
}

void read_drive(Reading& r, const Node& node, int scope, std::set<std::array<int, 4>>& driven) {
  DriveSpec drive;
  drive.place = node.place;
  if (!resolve_driven(r, node, scope, drive)) return;
  resolve_axis(r, node, drive);
  const std::string_view quantity = node.value("quantity");
  drive.quantity = quantity == "velocity"       ? DriveQuantity::kVelocity
                   : quantity == "effort"       ? DriveQuantity::kEffort
                   : quantity == "length"       ? DriveQuantity::kLength
                   : quantity == "tension"      ? DriveQuantity::kTension
                   : quantity == "displacement" ? DriveQuantity::kDisplacement
                                                : DriveQuantity::kPosition;
  const bool of_rod = drive.quantity == DriveQuantity::kLength,
             of_tendon = drive.quantity == DriveQuantity::kTension ||
                         drive.quantity == DriveQuantity::kDisplacement;
  if (of_rod != (drive.rod >= 0) || of_tendon != (drive.tendon >= 0))
    r.report.bad_value("E310", node, *node.attribute("quantity"),
                       drive.rod >= 0 ? "a rod's drive has the quantity length"
                       : drive.tendon >= 0
                           ? "a tendon's drive has the quantity tension or displacement"
                           : "a joint's drive has the quantity position, velocity or effort");
  if (!driven.insert({drive.joint, drive.freedom, drive.rod, drive.tendon}).second)
    r.report.error(
        "E412", node,
        "a second drive of " + (drive.rod >= 0      ? r.scene.rods[at(drive.rod)].name
                                : drive.tendon >= 0 ? r.scene.tendons[at(drive.tendon)].name
                                                    : r.scene.joints[at(drive.joint)].name));
  bool mentioned = false;
  for (const auto& child : node.children)
    mentioned = mentioned || !child->foreign;
  if (!read_time_function(r, node, drive.profile) && !mentioned)
    r.report.missing("E303", node,
                     describe(node) +
                         " has no function of time: a profile "
                         "attribute or shapes such as <constant>");
  r.scene.drives.push_back(std::move(drive));
}

// a rod and a fraction of its length, as in leg(s=0.5), leg::tip, leg::base
struct RodPlace {
  std::string rod;
  double s = 0;
};

std::optional<RodPlace> parse_rod_place(std::string_view text) {
  const auto ends_with = [&](std::string_view end) {
    return text.size() > end.size() && text.substr(text.size() - end.size()) == end;
  };
  if (ends_with("::tip")) return RodPlace{std::string(text.substr(0, text.size() - 5)), 1};
  if (ends_with("::base")) return RodPlace{std::string(text.substr(0, text.size() - 6)), 0};
  const std::size_t open = text.find("(s=");
  if (open == std::string_view::npos || text.back() != ')') return std::nullopt;
  const auto s = parse_number(text.substr(open + 3, text.size() - open - 4));
  if (!s) return std::nullopt;
  return RodPlace{std::string(text.substr(0, open)), *s};
}

bool resolve_point(Reading& r, const Node& node, int scope, LoadSpec& load) {
  const Attribute& a = *node.attribute("at");
  const auto found = r.frames.find_outwards(scope, a.value);
  if (found && found->kind != FrameKind::kRod) {
    load.at = r.frames.frame_ref(found->index);
    return true;
  }
  if (found) {
    r.report.bad_value("E404", node, a, "'" + a.value + "' is a rod: say where on it",
                       a.value + "::tip or " + a.value + "(s=0.5)");
    return false;
  }
  if (const auto place = parse_rod_place(a.value)) {
    const auto rod = r.frames.find_outwards(scope, place->rod);
    if (rod && rod->kind == FrameKind::kRod) {
      load.rod = rod->index;
      load.rod_s = place->s;
      if (place->s < 0 || place->s > 1)
        r.report.bad_value("E306", node, a, "s is the fraction of the length, 0 to 1");
      return true;
    }
    r.report.bad_value("E404", node, a, "there is no rod '" + place->rod + "'",
                       mean(nearest_name(place->rod, r.frames.known_names(scope))));
    return false;
  }
  r.report.bad_value("E403", node, a, "there is no link, frame or rod point '" + a.value + "'",
                     mean(nearest_name(a.value, r.frames.known_names(scope))));
  return false;
}

// along="rod" from="0.2" to="0.5": per length on that part
bool resolve_line(Reading& r, const Node& node, int scope, LoadSpec& load) {
  const Attribute& a = *node.attribute("along");
  const auto rod = r.frames.find_outwards(scope, a.value);
  if (!rod || rod->kind != FrameKind::kRod) {
    r.report.bad_value("E404", node, a, "there is no rod '" + a.value + "'",
                       mean(nearest_name(a.value, r.frames.known_names(scope))));
    return false;
  }
  load.rod = rod->index;
  const auto fraction = [&](const char* key, double otherwise) {
    const Attribute* given = node.attribute(key);
    return given ? parse_number(given->value).value_or(otherwise) : otherwise;
  };
  load.rod_s = fraction("from", 0);
  load.to = fraction("to", 1);
  if (load.rod_s < 0 || *load.to > 1 || load.rod_s >= *load.to)
    r.report.bad_value("E306", node, a,
                       "from and to are fractions of the length, 0 <= from < to <= 1");
  return true;
}

/// At a point or along a rod: one of the two.
bool resolve_where(Reading& r, const Node& node, int scope, LoadSpec& load) {
  const bool along = node.attribute("along");
  if (along == (node.attribute("at") != nullptr)) {
    r.report.error("E310", node, "a load acts at a point or along a rod: give one of at, along");
    return false;
  }
  for (const char* key : {"from", "to"})
    if (const Attribute* part = node.attribute(key); part && !along) {
      r.report.bad_value("E310", node, *part, "only a load along a rod has a part of it");
      return false;
    }
  return along ? resolve_line(r, node, scope, load) : resolve_point(r, node, scope, load);
}

// components are in the world's axes, in axes that never move, or follow the loaded body or section
void resolve_axes(Reading& r, const Node& node, int scope, const std::vector<bool>& fixed,
                  LoadSpec& load) {
  const Attribute* in = node.attribute("expressed_in");
  if (!in || in->value.empty() || in->value == "world") return;
  const auto place = parse_rod_place(in->value);
  if (load.rod >= 0 && in->value == node.value(load.to ? "along" : "at")) {
    load.follower = true;
    return;
  }
  const auto found = r.frames.find_outwards(scope, in->value);
  if (!found || found->kind == FrameKind::kRod) {
    if (place && r.frames.find_outwards(scope, place->rod))
      r.report.bad_value("E520", node, *in,
                         "the axes of another rod point are not available in this version",
                         "available: world, a fixed frame, or the same place as in at");
    else
      r.report.bad_value("E403", node, *in, "there is no frame '" + in->value + "'",
                         mean(nearest_name(in->value, r.frames.known_names(scope))));
    return;
  }
  const int body = r.frames.body_of(found->index);
  const Mat3 R_WF = r.frames.X_W(found->index).R;
  if (body == kWorld || fixed[at(body)]) {
    load.R_expressed = R_WF;
  } else if (load.rod < 0 && body == load.at.body) {
    const Mat3 R_WA = r.scene.bodies[at(body)].X_WB.R * load.at.X_BF.R;
    load.R_expressed = R_WA.transpose() * R_WF;
    load.follower = true;
  } else {
    r.report.bad_value("E520", node, *in,
                       "the axes of another moving body are not available in this version",
                       "available: world, a fixed frame, or a frame of the loaded body");
  }
}

// a force by where the section is, instead of numbers
void read_law(Reading& r, const Node& node, bool numbers, LoadSpec& load) {
  for (std::size_t i = 0; i < std::size(kPlaceLaws); ++i) {
    const Node* law = node.child(kPlaceLaws[i].word);
    if (!law) continue;
    if (numbers || load.law >= 0)
      r.report.error("E310", *law, "a load is a force and a torque, or of one law: give one");
    if (!load.to)
      r.report.error("E310", *law, "<" + law->name + "> acts along a rod: give along, not at");
    load.law = static_cast<int>(i);
    double* to = load.law_values.data();
    for (const LawValue& value : kPlaceLaws[i].values) {
      if (!value.word) break;
      const Node* given = law->child(value.word);
      if (value.kind == LawValue::kPositive) {
        *to = number_of(given, 0);
      } else {
        Vec3 v = vec3_of(given, Vec3::Zero());
        if (value.kind == LawValue::kDirection) {
          if (given && v.isZero(0)) r.report.error("E306", *given, "a direction is not zero");
          if (!v.isZero(0)) v.normalize();
        }
        Eigen::Map<Vec3>{to} = v;
      }
      to += value.size();
    }
  }
}

void read_load(Reading& r, const Node& node, int scope, const std::vector<bool>& fixed) {
  LoadSpec load;
  load.place = node.place;
  if (!resolve_where(r, node, scope, load)) return;
  resolve_axes(r, node, scope, fixed, load);
  load.force = vec3_of(node.child("force"), Vec3::Zero());
  load.torque = vec3_of(node.child("torque"), Vec3::Zero());
  bool given = false;
  for (const auto& child : node.children)
    given = given || child->name == "force" || child->name == "torque";
  read_law(r, node, given, load);
  if (!given && load.law < 0)
    r.report.missing("E303", node, describe(node) + " has no <force> and no <torque>");
  load.has_profile = read_time_function(r, node, load.profile);
  r.scene.loads.push_back(std::move(load));
}

}  // namespace

bool read_time_function(Reading& r, const Node& node, Profile& profile) {
  const Attribute* name = node.attribute("profile");
  profile = read_shapes(r, node);
  if (!name) return !profile.terms.empty();
  if (!profile.terms.empty())
    r.report.error("E310", node, describe(node) + " has a profile and shapes of its own: give one");
  const auto found = r.profiles.find(name->value);
  if (found != r.profiles.end()) {
    profile = found->second;
    return true;
  }
  std::vector<std::string> known;
  for (const auto& [key, value] : r.profiles)
    known.push_back(key);
  r.report.bad_value("E409", node, *name, "there is no profile '" + name->value + "'",
                     mean(nearest_name(name->value, known)));
  return true;
}

void read_actions(Reading& r) {
  const std::vector<bool> fixed = fixed_bodies(r.scene);
  std::set<std::array<int, 4>> driven;
  for_each_scope(r, [&](int scope, const Node& node) {
    for (const Node* drive : node.all("cprsim:drive"))
      read_drive(r, *drive, scope, driven);
    for (const Node* load : node.all("cprsim:load"))
      read_load(r, *load, scope, fixed);
  });
}

}  // namespace cprsim
