// SPDX-License-Identifier: BSD-3-Clause
// Coulomb's friction as the limit of friction that is bounded by what pressed a solve before.
#include <algorithm>
#include <cmath>

#include "engine/robot/contacts.h"

namespace cprsim {
namespace {

// of the robot's force: friction nearer to its bound is about to slip
constexpr double kSlack = 1e-9;

}  // namespace

bool RodContacts::bound_by_pressure() {
  // of all friction that there may be: less is no change, more is what only just lands
  constexpr double kSame = 1e-3, kLands = 0.2;
  const auto each = [&](const auto& act) {
    for (Rod& rod : rods_) {
      std::vector<RodContact>& contacts = rod.side->contacts();
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        if (!contacts[i].found() || contacts[i].friction == 0) continue;
        const double pressure = rod.side->contact_state()[i].at.n.dot(contacts[i].force);
        act(contacts[i], contacts[i].friction * std::max(0.0, pressure));
      }
    }
  };
  double all = 0, before = 0, change = 0;
  each([&](const RodContact& contact, double bound) {
    all += bound;
    before += contact.bound;
    change += std::abs(bound - contact.bound);
  });
  if (change <= kSame * all || all - before > kLands * all) return false;
  each([](RodContact& contact, double bound) {
    contact.bound = bound;
    contact.grip = bound > 0 ? Grip::kSlip : Grip::kSmooth;
    contact.may_rest = true;
  });
  return true;
}

void RodContacts::grip_what_rests() {
  lagged_ = false;
  for (Rod& rod : rods_) {
    std::vector<RodContact>& contacts = rod.side->contacts();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      RodContact& contact = contacts[i];
      if (!contact.found() || contact.bound < 0) continue;
      const Vec3& n = rod.side->contact_state()[i].at.n;
      const double grip = (contact.force - n.dot(contact.force) * n).norm();
      contact.grip = contact.friction == 0                                ? Grip::kSmooth
                     : grip < contact.bound - kSlack * robot_.scale.force ? Grip::kStick
                                                                          : Grip::kSlip;
      contact.bound = -1;
      contact.may_rest = false;
    }
  }
}

}  // namespace cprsim
