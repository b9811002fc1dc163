// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/robot/echoes.h"
#include "engine/solve/phase_clock.h"

namespace cprsim {
namespace {

// of the robot's force: pulls below are round-off
constexpr double kPull = 1e-9;
// of the radius: less is no way along the force of friction, but round-off
constexpr double kCreep = 1e-6;
// from this round on one change at a time
constexpr int kPatience = 12;
// later the first, not the worst: no cycle then (Murty, Opsearch 11, 1974)
constexpr int kFirstOnly = 40;
// and points stay where they are on their rods
constexpr int kHeld = 30;

bool same_place(const RodContact& a, const RodContact& b) {
  // a point in a cell slides along its rod; a node comes or goes
  return a.surface == b.surface &&
         (a.at_node() && b.at_node() ? a.cell == b.cell
                                     : std::abs(place_in_list(a) - place_in_list(b)) <= 1);
}

}  // namespace

// Of neighbours that pull, only the hardest lets go: the others may press once it has.
bool RodContacts::pulls_most(const Rod& rod, std::size_t contact) const {
  const std::vector<RodContact>& contacts = rod.side->contacts();
  const std::vector<ContactRows>& rows = rod.side->contact_state();
  const auto pressure = [&](std::size_t i) {
    return contacts[i].found() ? rows[i].at.n.dot(contacts[i].force)
                               : std::numeric_limits<double>::infinity();
  };
  const double own = pressure(contact);
  return own < 0 && (contact == 0 || own <= pressure(contact - 1)) &&
         (contact + 1 == contacts.size() || own <= pressure(contact + 1));
}

// Points that pull go; what came without friction slips; beyond the friction cone stick becomes
// slip, and slip along the friction force stick.
void RodContacts::review(std::size_t index, std::vector<Change>& changes) const {
  const Rod& rod = rods_[index];
  const std::vector<RodContact>& contacts = rod.side->contacts();
  const std::vector<ContactRows>& rows = rod.side->contact_state();
  const double unit = robot_.scale.force;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const RodContact& contact = contacts[i];
    if (!contact.found()) continue;
    const Vec3& n = rows[i].at.n;
    const double pressure = n.dot(contact.force);
    const double limit = contact.most_friction(pressure);
    const Vec3 grip = contact.force - pressure * n, slip = rows[i].slip - n.dot(rows[i].slip) * n;
    const ContactScale scale = rod.side->contact_scale();
    const double way = slip.norm() / scale.rate * scale.length;
    Change change{0, index, static_cast<int>(i), false, contact};
    if (pressure < -kPull * unit) {
      if (!pulls_most(rod, i)) continue;
      change.urgency = -pressure / unit;
      change.drop = contact.grip != Grip::kStick || contact.friction == 0 || eased_ == 0;
      change.contact.grip = Grip::kSlip;
    } else if (lagged_ && contact.grip == Grip::kSlip) {
      continue;  // its rows are those of stick, too
    } else if (contact.grip == Grip::kSmooth && limit > 0 && pressure > kPull * unit) {
      // as it moved without friction, as far as that is a way at all
      change.urgency = limit / unit;
      change.contact.grip = way > kSlide * rod.radius ? Grip::kSlip : Grip::kStick;
    } else if (contact.grip == Grip::kStick && grip.norm() > limit + kPull * unit) {
      change.urgency = (grip.norm() - limit) / unit;
      change.contact.grip = Grip::kSlip;
    } else if (contact.grip == Grip::kSlip &&
               ((slip.dot(grip) > 0 && way > kCreep * rod.radius) ||
                (contact.may_rest && grip.norm() < limit - kPull * unit))) {
      change.urgency = grip.norm() / unit;
      change.contact.grip = Grip::kStick;
    } else {
      continue;
    }
    changes.push_back(change);
  }
}

void RodContacts::apply(const std::vector<Change>& changes) {
  for (std::size_t r = 0; r < rods_.size(); ++r) {
    std::vector<RodContact> next;
    std::vector<RodContact>& contacts = rods_[r].side->contacts();
    std::vector<char> gone(contacts.size(), 0);
    for (const Change& change : changes) {
      if (change.rod != r) continue;
      if (change.existing < 0) {
        next.push_back(change.contact);
      } else if (change.drop) {
        gone[static_cast<std::size_t>(change.existing)] = 1;
      } else {
        contacts[static_cast<std::size_t>(change.existing)] = change.contact;
      }
    }
    for (std::size_t i = 0; i < contacts.size(); ++i)
      if (!gone[i]) next.push_back(contacts[i]);
    contacts = std::move(next);
  }
  if (robot_.rods_meet)
    mirror_contacts(robot_);
  else
    for (Rod& rod : rods_)
      put_in_order(rod.side->contacts());
}

bool RodContacts::revise(int round) {
  const PhaseTimer timer(any() ? robot_.clock : nullptr, Phase::kContact);
  bool again = bodies_.revise(round);
  std::vector<Change> changes;
  for (std::size_t r = 0; r < rods_.size(); ++r) {
    Rod& rod = rods_[r];
    if (far_away(rod)) continue;
    scan(rod);
    std::vector<RodContact>& contacts = rod.side->contacts();
    if (round == 0) {
      rod.slides.clear();
      rod.valleys.clear();
    }
    for (std::size_t i = 0; i < contacts.size(); ++i)
      if (contacts[i].found() &&
          follow(rod, contacts[i], rod.side->contact_state()[i], round < kHeld))
        again = true;
    review(r, changes);
    search(r, changes, round >= kPatience);
  }
  if (changes.empty() && !again) {
    if (robot_.rods_meet) update_echoes(robot_);
    return false;
  }
  if (round >= kFirstOnly && !changes.empty()) {
    const auto first =
        std::min_element(changes.begin(), changes.end(), [](const Change& a, const Change& b) {
          return a.rod != b.rod ? a.rod < b.rod
                                : place_in_list(a.contact) < place_in_list(b.contact);
        });
    changes = {*first};
  } else if (round >= kPatience && !changes.empty()) {
    const auto worst =
        std::max_element(changes.begin(), changes.end(),
                         [](const Change& a, const Change& b) { return a.urgency < b.urgency; });
    changes = {*worst};
  }
  apply(changes);
  return true;
}

bool RodContacts::ease() {
  constexpr int kEasedSteps = 20;
  if (left_ == 0 && !lagged_) return false;  // statics is led to where it rests
  eased_ = kEasedSteps;
  bool any = bodies_.ease(kEasedSteps);
  for (Rod& rod : rods_)
    for (RodContact& contact : rod.side->contacts()) {
      contact.may_rest = true;
      any = any || contact.grip == Grip::kSlip;
    }
  return any;
}

bool RodContacts::hold() {
  if (left_ == 0) return false;
  bool any = bodies_.hold();
  for (Rod& rod : rods_)
    for (RodContact& contact : rod.side->contacts()) {
      if (contact.grip != Grip::kSlip) continue;
      contact.grip = contact.bound == 0 ? Grip::kSmooth : Grip::kStick;
      any = true;
    }
  return any;
}

bool RodContacts::touches(const Rod& rod) {
  const std::vector<RodContact>& all = rod.side->contacts();
  return std::any_of(all.begin(), all.end(),
                     [](const RodContact& contact) { return contact.grip != Grip::kTie; });
}

bool RodContacts::touching() const {
  return bodies_.touching() ||
         std::any_of(rods_.begin(), rods_.end(), [](const Rod& rod) { return touches(rod); });
}

void RodContacts::begin_step() {
  const PhaseTimer timer(any() ? robot_.clock : nullptr, Phase::kContact);
  left_ = 0;
  rates_ = false;
  eased_ = std::max(0, eased_ - 1);
  if (bodies_.any()) bodies_.begin_step(lagged_);
  for (Rod& rod : rods_) {
    rod.before = rod.side->contacts();
    rod.begun = rod.side->contact_nodes();
    for (RodContact& contact : rod.side->contacts())
      set_terms(rod, contact);
    // while a rod is far away, the distances of an older scan will do
    if (rod.scan.nodes.empty() || touches(rod) || 8 * moved(rod, rod.scan) >= rod.scan.clearance)
      scan(rod);
    if (rod.start.number != rod.scan.number) rod.start = rod.scan;
  }
}

void RodContacts::begin_stage(double since) {
  left_ = recovery_ > 0 ? std::exp(-since / recovery_) : 0;
  rates_ = true;
  if (bodies_.any()) bodies_.begin_stage(left_, since);
  refresh();
}

/// What the step asks of a contact, whichever guess it came with.
void RodContacts::set_terms(const Rod& rod, RodContact& contact) const {
  contact.may_rest = lagged_ || eased_ > 0;
  if (!contact.found()) return;
  contact.bound = -1;
  if (lagged_) {
    const auto was = std::find_if(rod.before.begin(), rod.before.end(), [&](const RodContact& c) {
      return c.found() && same_place(c, contact);
    });
    const double pressure = was == rod.before.end() ? 0 : -was->lever.dot(was->force) / rod.radius;
    contact.bound = contact.friction * std::max(0.0, pressure);
    contact.grip = contact.bound > 0 ? Grip::kSlip : Grip::kSmooth;
  }
  contact.sunk = sunk(rod, contact);
  contact.lag = rates_ ? rod.obstacles[static_cast<std::size_t>(contact.surface)].lag : 0;
}

void RodContacts::refresh() {
  bodies_.refresh();
  for (Rod& rod : rods_)
    for (RodContact& contact : rod.side->contacts())
      set_terms(rod, contact);
}

bool RodContacts::changed(const Rod& rod, bool soft_too) {
  // echoes change with the contacts whose they are, ties never
  const auto of_interest = [&](const std::vector<RodContact>& all,
                               const std::vector<RodContact>& others) {
    std::vector<RodContact> kept;
    for (const RodContact& c : all) {
      const bool comes = std::none_of(others.begin(), others.end(), [&](const RodContact& other) {
        return other.found() && same_place(c, other);
      });
      const bool passed_over = !soft_too && c.give > 0 && comes;
      if (c.found() && !passed_over) kept.push_back(c);
    }
    return kept;
  };
  const std::vector<RodContact> now = of_interest(rod.side->contacts(), rod.before),
                                before = of_interest(rod.before, rod.side->contacts());
  const auto alike = [&](const RodContact& a, const RodContact& b) {
    return a.grip == b.grip && same_place(a, b);
  };
  return now.size() != before.size() || !std::equal(now.begin(), now.end(), before.begin(), alike);
}

bool RodContacts::changed() const {
  return bodies_.changed() ||
         std::any_of(rods_.begin(), rods_.end(), [](const Rod& rod) { return changed(rod, true); });
}

bool RodContacts::struck() const {
  return bodies_.changed() || std::any_of(rods_.begin(), rods_.end(),
                                          [](const Rod& rod) { return changed(rod, false); });
}

bool RodContacts::leapt() const {
  if (bodies_.leapt()) return true;
  for (const Rod& rod : rods_) {
    if (2 * moved(rod, rod.start) < rod.start.clearance) continue;
    const std::vector<RodContact>& contacts = rod.side->contacts();
    const std::size_t cells = rod.start.nodes.size() - 1;
    for (std::size_t c = 0; c < cells; ++c)
      for (std::size_t o = 0; o < rod.obstacles.size(); ++o) {
        const Near& was = near(rod.start, rod, c, o);
        if (rod.obstacles[o].plane || passed(rod, rod.start, o, c) <= 0.5 * was.distance) continue;
        const bool held_back =
            std::any_of(contacts.begin(), contacts.end(), [&](const RodContact& contact) {
              return (contact.cell == c || (contact.at_node() && contact.cell == c + 1)) &&
                     contact.lever.dot(was.normal) < -0.5 * rod.radius;
            });
        if (!held_back) return true;
      }
  }
  return false;
}

std::string RodContacts::overlap() {
  for (Rod& rod : rods_) {
    scan(rod);
    if (rod.scan.clearance >= -kContactTolerance * rod.radius) continue;
    for (std::size_t o = 0; o < rod.obstacles.size(); ++o)
      for (std::size_t c = 0; c + 1 < rod.scan.nodes.size(); ++c) {
        double xi = 0;
        const double gap = lowest(rod, o, c, xi) - rod.radius;
        // what gives may be sunk into
        const double most = rod.obstacles[o].give > 0 ? 0.5 : kContactTolerance;
        if (gap < -most * rod.radius)
          return "rod '" + rod.rod->spec->name + "' begins " +
                 (rod.obstacles[o].itself    ? "in its own way"
                  : rod.obstacles[o].rod < 0 ? "inside '" + rod.obstacles[o].name + "'"
                                             : "in the way of '" + rod.obstacles[o].name + "'");
      }
  }
  return bodies_.overlap();
}

}  // namespace cprsim
