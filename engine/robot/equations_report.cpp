// SPDX-License-Identifier: BSD-3-Clause
// What the equations say of themselves: names of rows, counts.
#include <algorithm>

#include "engine/math/state_text.h"
#include "engine/robot/equations.h"
#include "engine/robot/rod_between.h"

namespace cprsim {

std::string Equations::worst_row() const {
  static const char* const kWrench[] = {"moment x", "moment y", "moment z",
                                        "force x",  "force y",  "force z"};
  static const char* const kClosure[] = {"rotation x", "rotation y", "rotation z",
                                         "position x", "position y", "position z",
                                         "effort",     "effort 2",   "effort 3"};
  static const char* const kPlanarWrench[] = {"moment about the normal", "force 1", "force 2"};
  static const char* const kPlanarClosure[] = {"angle", "position 1", "position 2"};
  const auto i = static_cast<std::size_t>(worst_.index);
  switch (worst_.kind) {
    case Worst::Kind::kBody: {
      const int link = robot_.bodies[i].links.front();
      return "balance of " + robot_.scene->bodies[static_cast<std::size_t>(link)].name + ", " +
             (robot_.plane ? kPlanarWrench : kWrench)[worst_.row];
    }
    case Worst::Kind::kJoint:
      return "joint " + robot_.joints[i].spec->name + ", " +
             (robot_.plane && worst_.row < 3 ? kPlanarClosure : kClosure)[worst_.row];
    case Worst::Kind::kContact:
      return pair_name(pairs_[i]);
    case Worst::Kind::kBodyContact:
      return body_contact_name(i);
    case Worst::Kind::kRod:
      break;
  }
  return robot_.rods.empty() ? "" : robot_.rods[i].model->row_name(worst_.row);
}

long Equations::section_evaluations() const {
  long sum = 0;
  for (const RobotRod& rod : robot_.rods)
    sum += rod.model->section_evaluations();
  return sum;
}

long Equations::work() const {
  long direction = 0;
  for (const RobotRod& rod : robot_.rods)
    direction += direction_work(*rod.model);
  return section_evaluations() + factorizations_ * direction + work_alone_;
}

int Equations::unknown_count() const {
  int sum = body_unknowns_;
  for (const Joint& joint : robot_.joints)
    sum += unknowns_of(joint);
  for (const RobotRod& rod : robot_.rods)
    sum += rod.model->unknown_count();
  return sum;
}

void visit(RobotUnknowns& u, Archive& archive) {
  for (RodModel::Unknowns& rod : u.rods) {
    constexpr std::size_t kMost = 100'000;
    archive(rod.values);
    if (!rod.starts.empty()) archive.resized_doubles(rod.starts, kMost);
    archive.doubles(rod.nodes);
    visit(rod.contacts, archive);
  }
  visit(u.body_contacts, archive);
  for (Pose& body : u.bodies)
    archive(body);
  archive.doubles(u.joint_q);
  archive.doubles(u.joint_lambda);
}

void Equations::visit(Archive& archive) {
  archive(t_);
  archive(before_);
  rates_.visit(archive);
  archive(equilibrium_time_);
  // coefficients of the last solve; what was found with them follows
  if (archive.reading()) set_instant(t_, before_, rates_);
  for (RigidBody& body : robot_.bodies)
    body.visit(archive);
  for (Joint& joint : robot_.joints)
    joint.visit(archive);
  for (RobotRod& rod : robot_.rods)
    rod.model->visit(archive);
  cprsim::visit(robot_.body_contacts, archive);
  cprsim::visit(robot_.body_contact_rows, archive);
  if (archive.reading()) expect_contacts(unknowns());
  slip_from_.resize(archive.count(slip_from_.size(), robot_.bodies.size()));
  if (archive.reading() && (robot_.rods_meet || !robot_.probes.empty()) &&
      slip_from_.size() != robot_.bodies.size())
    throw StateError("the state is that of another robot");
  for (Pose& from : slip_from_)
    archive(from);
}

namespace {

bool leads(int index, std::size_t size) {
  return index >= 0 && static_cast<std::size_t>(index) < size;
}

/// What contacts are looked up in, of a robot whose state is read.
class ContactCheck {
 public:
  ContactCheck(const Robot& robot, const RobotUnknowns& u) : robot_(robot), rods_(u.rods) {}

  bool sound() const {
    std::size_t ties = 0, tied = 0;
    for (std::size_t r = 0; r < rods_.size(); ++r) {
      const std::vector<RodContact>& contacts = rods_[r].contacts;
      if (!contacts.empty() && !side(r)) return false;
      double last = 0;
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        const RodContact& c = contacts[i];
        if (!sound(r, static_cast<int>(i))) return false;
        if (c.grip == Grip::kTie && c.role == ContactRole::kShared) ++ties;
        if (c.role == ContactRole::kEcho) continue;
        const double at = static_cast<double>(c.cell) + (c.at_node() ? 0 : 0.5);
        if (at < last) return false;
        last = at;
      }
    }
    for (const TieSpec& tie : robot_.scene->ties)
      tied += tie.s.size();
    return ties == tied;
  }

 private:
  const TouchingRod* side(std::size_t rod) const {
    const TouchingRod* found = robot_.rods[rod].model->touching();
    return found && found->may_touch() ? found : nullptr;
  }

  bool in_cell(std::size_t rod, std::size_t cell, double xi) const {
    if (!side(rod)) return false;
    const std::size_t nodes = side(rod)->contact_grid().size();
    return xi >= 0 && xi <= 1 && cell < (xi == 0 ? nodes : nodes - 1);
  }

  bool sound(std::size_t r, int index) const {
    const RodContact& c = rods_[r].contacts[static_cast<std::size_t>(index)];
    if (!in_cell(r, c.cell, c.xi)) return false;
    const bool tie = c.grip == Grip::kTie, echo = c.role == ContactRole::kEcho;
    if (tie && !c.at_node()) return false;
    if (!tie && !echo && !leads(c.surface, side(r)->surfaces().size())) return false;
    if (echo || c.other_rod >= 0) return c.body == -1 && paired(r, index);
    // of two rods no surface has a shape
    if (tie || !side(r)->surfaces()[static_cast<std::size_t>(c.surface)].shape) return false;
    const bool own = c.body == -1 && side(r)->owns_forces();
    return c.other_rod == -1 && c.partner == -1 && (c.role == ContactRole::kOwn) == own &&
           (own || robot_.rods_meet) && (c.body == -1 || leads(c.body, robot_.bodies.size()));
  }

  /// One of two entries that two rods have of the same point.
  bool paired(std::size_t r, int index) const {
    const RodContact& c = rods_[r].contacts[static_cast<std::size_t>(index)];
    if (!leads(c.other_rod, rods_.size()) || !robot_.rods_meet) return false;
    const auto other_rod = static_cast<std::size_t>(c.other_rod);
    const std::vector<RodContact>& others = rods_[other_rod].contacts;
    if (!leads(c.partner, others.size()) || c.role == ContactRole::kOwn) return false;
    const RodContact& other = others[static_cast<std::size_t>(c.partner)];
    const bool tie = c.grip == Grip::kTie;
    if (other.other_rod != static_cast<int>(r) || other.partner != index || other.role == c.role ||
        other.role == ContactRole::kOwn || (other.grip == Grip::kTie) != tie)
      return false;
    if (c.role == ContactRole::kEcho) return true;
    if (!in_cell(other_rod, c.other_cell, c.other_xi)) return false;
    return tie || !side(r)->surfaces()[static_cast<std::size_t>(c.surface)].shape;
  }

  const Robot& robot_;
  const std::vector<RodModel::Unknowns>& rods_;
};

}  // namespace

// A file may say anything: whatever is an index must lead somewhere, and roles must fit.
void Equations::expect_contacts(const RobotUnknowns& u) const {
  const bool meet =
      std::all_of(u.body_contacts.begin(), u.body_contacts.end(), [&](const BodyContact& contact) {
        return contact.probe < robot_.probes.size() && contact.law.grip != Grip::kTie;
      });
  if (!meet || !ContactCheck(robot_, u).sound())
    throw StateError("the state has contacts that are not this robot's");
}

}  // namespace cprsim
