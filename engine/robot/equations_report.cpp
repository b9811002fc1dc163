// SPDX-License-Identifier: BSD-3-Clause
// What the equations say of themselves: names of rows, counts.
#include "engine/math/state_text.h"
#include "engine/robot/equations.h"

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
  for (Pose& from : slip_from_)
    archive(from);
}

// A file may say anything: whatever is an index must lead somewhere.
void Equations::expect_contacts(const RobotUnknowns& u) const {
  const auto leads = [](auto index, std::size_t size) {
    return index >= 0 && static_cast<std::size_t>(index) < size;
  };
  const auto in_cell = [&](std::size_t rod, std::size_t cell, double xi) {
    const std::size_t nodes = robot_.rods[rod].model->touching()->contact_grid().size();
    return xi >= 0 && xi <= 1 && cell < (xi == 0 ? nodes : nodes - 1);
  };
  for (std::size_t r = 0; r < u.rods.size(); ++r) {
    const std::vector<RodContact>& contacts = u.rods[r].contacts;
    if (contacts.empty()) continue;
    TouchingRod* side = robot_.rods[r].model->touching();
    bool sound = side && side->may_touch();
    for (const RodContact& c : contacts) {
      if (!sound) break;
      const bool echo = c.role == ContactRole::kEcho, paired = echo || c.other_rod >= 0;
      sound = in_cell(r, c.cell, c.xi) && c.body < static_cast<int>(robot_.bodies.size()) &&
              (paired || c.body >= -1) &&
              (c.grip == Grip::kTie || echo || leads(c.surface, side->surfaces().size()));
      if (!sound || !paired) continue;
      sound = leads(c.other_rod, u.rods.size()) &&
              leads(c.partner, u.rods[static_cast<std::size_t>(c.other_rod)].contacts.size());
      if (!sound) break;
      const RodContact& other = u.rods[static_cast<std::size_t>(c.other_rod)]
                                    .contacts[static_cast<std::size_t>(c.partner)];
      sound = other.other_rod == static_cast<int>(r) &&
              (other.role == ContactRole::kEcho) != echo &&
              (c.grip == Grip::kTie) == (other.grip == Grip::kTie);
    }
    if (!sound) throw StateError("the state has contacts that are not this robot's");
  }
  for (const BodyContact& c : u.body_contacts)
    if (!leads(c.probe, robot_.probes.size()) || c.law.grip == Grip::kTie)
      throw StateError("the state has contacts that are not this robot's");
}

}  // namespace cprsim
