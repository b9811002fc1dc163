// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/body_contacts.h"

#include <algorithm>
#include <cmath>

namespace cprsim {
namespace {

// of the robot's force: pulls below are round-off
constexpr double kPull = 1e-9;
// of the smaller body's size: depth at which a point begins to touch; way that is none
constexpr double kNotice = 1e-6, kCreep = 1e-8;
// from this round on one change at a time, later the first (Murty, Opsearch 11, 1974)
constexpr int kPatience = 12, kFirstOnly = 40;
// of the size: deeper a scene may not begin
constexpr double kMostOverlap = 0.01;
constexpr double kMostKappa = 1e3;
// of its give: what an impact's force is to leave of it
constexpr double kImpact = 1e-3;

}  // namespace

/// Whether the present solve may have a force there.
bool BodyContacts::acts(const BodyProbe& probe) const {
  const auto flies = [&](int body) {
    return body >= 0 && flies_[static_cast<std::size_t>(body)] != 0;
  };
  return rates_ || (!flies(probe.body) && !flies(probe.other));
}

bool BodyContacts::far(const Group& group) const {
  const BodyProbe& probe = robot_.probes[group.first];
  const Vec3 centre = pose(probe.body) * group.centre;
  const Pose other = pose(probe.other);
  if (std::isfinite(group.other_radius))
    return (centre - other * group.other_centre).norm() > group.radius + group.other_radius;
  return distance_to(probe.surface, other * probe.surface.X_WC, centre).d > group.radius;
}

BodyContact BodyContacts::new_contact(std::size_t index, const Foot& foot) const {
  const BodyProbe& probe = robot_.probes[index];
  BodyContact contact;
  contact.probe = index;
  contact.at = foot.at;
  RodContact& law = contact.law;
  law.surface = 0;
  law.friction = probe.friction;
  law.grip = law.friction > 0 && !lagged_ ? Grip::kStick : Grip::kSmooth;
  law.lever = -probe.radius * foot.normal;
  contact.bounce = bounce(probe, foot);
  set_terms(contact);
  return contact;
}

/// Moves a contact to where its body now is lowest. @return whether it is to be solved again
bool BodyContacts::follow(BodyContact& contact, const ContactRows& rows) const {
  const BodyProbe& probe = robot_.probes[contact.probe];
  RodContact& law = contact.law;
  const double fine = kNotice * probe.size;
  bool again = false;
  Vec3 normal = rows.at.n;
  if (probe.kind != BodyProbe::Kind::kPoint) {
    const Foot lowest = foot(probe);
    if (lowest.gap < rows.at.d - probe.radius - fine) {
      contact.at = lowest.at;
      normal = lowest.normal;
      again = true;
    }
  }
  const Vec3 lever = -probe.radius * normal;
  if (law.friction > 0 && (lever - law.lever).norm() > fine) again = true;
  law.lever = lever;
  if (law.grip == Grip::kSlip) {
    const double rate = rows.slip.norm(), force = law.force.norm();
    if (rate > 0 && force > 0) law.kappa = std::clamp(force / rate, 1.0, kMostKappa);
  }
  law.sunk = sunk(contact, before(contact));
  return again;
}

void BodyContacts::review(std::vector<Change>& changes) const {
  const std::vector<BodyContact>& contacts = robot_.body_contacts;
  const double unit = robot_.scale.force;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const RodContact& law = contacts[i].law;
    const ContactRows& rows = robot_.body_contact_rows[i];
    const Vec3& n = rows.at.n;
    const double pressure = n.dot(law.force), limit = law.most_friction(pressure);
    const Vec3 grip = law.force - pressure * n, slip = rows.slip - n.dot(rows.slip) * n;
    Change change{0, static_cast<int>(i), false, contacts[i]};
    if (pressure < -kPull * unit) {
      change.urgency = -pressure / unit;
      change.drop = true;
    } else if (lagged_ && law.grip == Grip::kSlip) {
      continue;  // its rows are those of stick, too
    } else if (law.grip == Grip::kSmooth && limit > 0 && pressure > kPull * unit) {
      change.urgency = limit / unit;
      change.contact.law.grip = Grip::kStick;
    } else if (law.grip == Grip::kStick && grip.norm() > limit + kPull * unit) {
      change.urgency = (grip.norm() - limit) / unit;
      change.contact.law.grip = Grip::kSlip;
    } else if (law.grip == Grip::kSlip &&
               ((slip.dot(grip) > 0 &&
                 slip.norm() > kCreep * robot_.probes[contacts[i].probe].size) ||
                (law.may_rest && grip.norm() < limit - kPull * unit))) {
      change.urgency = grip.norm() / unit;
      change.contact.law.grip = Grip::kStick;
    } else {
      continue;
    }
    changes.push_back(change);
  }
}

// Corners first: an edge's or a rim's own lowest point counts where it is lower than they are.
void BodyContacts::search(std::vector<Change>& changes) const {
  const auto taken = [&](std::size_t probe) {
    return std::any_of(robot_.body_contacts.begin(), robot_.body_contacts.end(),
                       [&](const BodyContact& contact) { return contact.probe == probe; });
  };
  for (const Group& group : groups_) {
    if (!acts(robot_.probes[group.first]) || far(group)) continue;
    double corners = 0;
    for (std::size_t p = group.first; p < group.last; ++p) {
      const BodyProbe& probe = robot_.probes[p];
      const double fine = kNotice * probe.size;
      if (taken(p)) {
        corners = std::min(corners, foot(probe).gap);
        continue;
      }
      const Foot lowest = foot(probe);
      if (!(lowest.gap < -fine)) continue;
      const BodyContact contact = new_contact(p, lowest);
      const double depth = contact.law.sunk - lowest.gap;
      const bool point = probe.kind == BodyProbe::Kind::kPoint;
      if (depth > fine && (point || lowest.gap < corners - fine))
        changes.push_back({depth / probe.size, -1, false, contact});
      corners = std::min(corners, lowest.gap);
    }
  }
}

void BodyContacts::apply(const std::vector<Change>& changes) {
  std::vector<BodyContact>& contacts = robot_.body_contacts;
  std::vector<char> gone(contacts.size(), 0);
  std::vector<BodyContact> next;
  for (const Change& change : changes) {
    if (change.existing < 0)
      next.push_back(change.contact);
    else if (change.drop)
      gone[static_cast<std::size_t>(change.existing)] = 1;
    else
      contacts[static_cast<std::size_t>(change.existing)] = change.contact;
  }
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (!gone[i]) next.push_back(contacts[i]);
  std::stable_sort(next.begin(), next.end(),
                   [](const BodyContact& a, const BodyContact& b) { return a.probe < b.probe; });
  contacts = std::move(next);
}

bool BodyContacts::revise(int round) {
  bool again = false;
  for (std::size_t i = 0; i < robot_.body_contacts.size(); ++i)
    if (follow(robot_.body_contacts[i], robot_.body_contact_rows[i]) && round < kPatience)
      again = true;
  std::vector<Change> changes;
  review(changes);
  search(changes);
  if (changes.empty()) return again;
  if (round >= kFirstOnly) {
    changes = {changes.front()};
  } else if (round >= kPatience) {
    changes = {
        *std::max_element(changes.begin(), changes.end(),
                          [](const Change& a, const Change& b) { return a.urgency < b.urgency; })};
  }
  apply(changes);
  return true;
}

bool BodyContacts::ease(int steps) {
  eased_ = steps;
  bool any = false;
  for (BodyContact& contact : robot_.body_contacts) {
    contact.law.may_rest = true;
    any = any || contact.law.grip == Grip::kSlip;
  }
  return any;
}

bool BodyContacts::hold() {
  bool any = false;
  for (BodyContact& contact : robot_.body_contacts) {
    if (contact.law.grip != Grip::kSlip) continue;
    contact.law.grip = contact.law.bound == 0 ? Grip::kSmooth : Grip::kStick;
    any = true;
  }
  return any;
}

void BodyContacts::begin_step(bool lagged) {
  lagged_ = lagged;
  left_ = 0;
  rates_ = false;
  eased_ = std::max(0, eased_ - 1);
  begun_.clear();
  velocity_.clear();
  for (const RigidBody& body : robot_.bodies) {
    begun_.push_back(body.pose());
    Vec6 velocity;
    if (body.position.v0.size() == 0)
      velocity.setZero();
    else
      velocity << body.R * body.rotation.v0, body.position.v0;
    velocity_.push_back(velocity);
  }
  for (BodyContact& contact : robot_.body_contacts)
    contact.bounce = 0;
  before_ = robot_.body_contacts;
  refresh();
}

void BodyContacts::begin_stage(double left, double since) {
  left_ = left;
  since_ = since;
  rates_ = true;
  refresh();
}

/// What the step asks of a contact, whichever guess it came with.
void BodyContacts::set_terms(BodyContact& contact) const {
  RodContact& law = contact.law;
  const BodyProbe& probe = robot_.probes[contact.probe];
  const BodyContact* was = before(contact);
  contact.fresh = !was;
  if (was) contact.bounce = 0;
  contact.give = (contact.bounce > 0 ? kImpact : 1) * probe.give;
  law.held = was ? was->law.force : Vec3(Vec3::Zero());
  law.may_rest = lagged_ || eased_ > 0;
  law.bound = -1;
  if (lagged_) {
    law.bound = law.friction * std::max(0.0, -law.lever.dot(law.held) / probe.radius);
    law.grip = law.bound > 0 ? Grip::kSlip : Grip::kSmooth;
  }
  law.sunk = sunk(contact, was);
}

void BodyContacts::refresh() {
  for (BodyContact& contact : robot_.body_contacts)
    set_terms(contact);
}

bool BodyContacts::changed() const {
  const std::vector<BodyContact>& now = robot_.body_contacts;
  return !std::equal(now.begin(), now.end(), before_.begin(), before_.end(),
                     [](const BodyContact& a, const BodyContact& b) {
                       return a.probe == b.probe && a.law.grip == b.law.grip;
                     });
}

// A point may go halfway through what it could be in by now.
bool BodyContacts::leapt() const {
  if (begun_.empty()) return false;
  for (const Group& group : groups_) {
    const BodyProbe& first = robot_.probes[group.first];
    if (!acts(first) || !std::isfinite(first.thickness)) continue;
    // the body's motion as the other sees it
    const Pose other = begun_pose(first.other);
    const Pose seen = other * pose(first.other).inverse() * pose(first.body);
    const Pose was = begun_pose(first.body);
    for (std::size_t p = group.first; p < group.last; ++p) {
      const BodyProbe& probe = robot_.probes[p];
      if (probe.kind != BodyProbe::Kind::kPoint) continue;
      const Vec3 at = probe.X_BC * probe.a, way = seen * at - was * at;
      if (2 * way.norm() <= probe.thickness) continue;
      const Distance from = begun(probe, at);
      if (-2 * from.n.dot(way) > std::max(0.0, from.d) + probe.thickness) return true;
    }
  }
  return false;
}

std::string BodyContacts::overlap() const {
  for (const Group& group : groups_) {
    if (far(group)) continue;
    for (std::size_t p = group.first; p < group.last; ++p) {
      const BodyProbe& probe = robot_.probes[p];
      if (foot(probe).gap >= -kMostOverlap * probe.size) continue;
      const auto name = [&](int link) {
        return "'" + robot_.scene->bodies[static_cast<std::size_t>(link)].name + "'";
      };
      return name(probe.link) + " begins inside " + name(probe.other_link);
    }
  }
  return {};
}

void BodyContacts::add_to(ContactSample& sample) const {
  for (std::size_t i = 0; i < robot_.body_contacts.size() && i < robot_.body_contact_rows.size();
       ++i) {
    const BodyContact& contact = robot_.body_contacts[i];
    const BodyProbe& probe = robot_.probes[contact.probe];
    const ContactRows& rows = robot_.body_contact_rows[i];
    LinkContact at;
    at.link = probe.link;
    at.other = probe.other_link;
    at.normal = rows.at.n;
    at.position = pose(probe.body) * contact.at - probe.radius * rows.at.n;
    at.force = contact.law.force;
    at.slip = rows.slip - rows.at.n.dot(rows.slip) * rows.at.n;
    at.gap = rows.at.d - probe.radius;
    sample.links.push_back(at);
    ++sample.count;
    sample.penetration = std::max(sample.penetration, -at.gap);
  }
}

void BodyContacts::visit(Archive& archive) {
  archive(eased_);
}

}  // namespace cprsim
