// SPDX-License-Identifier: BSD-3-Clause
// Contacts between what moves: their forces are unknowns of the global system, three each behind
// all others, their rows those of engine/robot/contact_pair.h. A rod answers with the motion of the
// contact's cell (OpenPorts), a body with its own unknowns and the wrench
//   moment -(y - p) × f, force -f,   y = x + l                                              (1)
#include <algorithm>

#include "engine/math/linear_solve.h"
#include "engine/math/so3.h"
#include "engine/robot/equations.h"
#include "engine/solve/phase_clock.h"

namespace cprsim {
namespace {

// of a cell: nearer to its end a rod's point counts as the end
constexpr double kAtEnd = 1.5e-3;

bool at_end(const TouchingRod& side, std::size_t cell, double xi) {
  const double at = static_cast<double>(cell) + xi,
               last = static_cast<double>(side.contact_nodes().size() - 1);
  return at < kAtEnd || at > last - kAtEnd;
}

Vec6 wrench_on_body(const Vec3& arm, const Vec3& f) {
  Vec6 w;
  w << -arm.cross(f), -f;
  return w;
}

}  // namespace

/// Linear terms of a rod in some rows of the global system.
struct Equations::RodTerms {
  Eigen::Matrix<double, Eigen::Dynamic, 6> by_z, by_A;
  MatX by_F;
  VecX value;

  RodTerms(const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 12>>& rows,
           const OpenPorts::Motion& motion)
      : by_z(rows * motion.by_z),
        by_A(rows * motion.by_A),
        by_F(rows * motion.by_F),
        value(rows * motion.value) {}
};

const OpenPorts* Equations::open_ports(std::size_t rod) const {
  if (pairs_.empty()) return nullptr;
  TouchingRod* side = robot_.rods[rod].model->touching();
  if (!side || !side->may_touch()) return nullptr;
  const std::vector<RodContact>& contacts = side->contacts();
  const bool any = std::any_of(contacts.begin(), contacts.end(), [](const RodContact& contact) {
    return contact.role != ContactRole::kOwn;
  });
  return any ? &side->open_ports() : nullptr;
}

void Equations::find_pairs() {
  const PhaseTimer timer(robot_.clock, Phase::kContact);
  pairs_.clear();
  for (std::size_t r = 0; r < robot_.rods.size(); ++r) {
    TouchingRod* side = robot_.rods[r].model->touching();
    if (!side || !side->may_touch()) continue;
    const std::vector<RodContact>& contacts = side->contacts();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (contacts[i].role != ContactRole::kShared) continue;
      pairs_.emplace_back();
      pairs_.back().rod = r;
      pairs_.back().contact = i;
    }
  }
}

bool Equations::is_tie(const Pair& pair) const {
  TouchingRod& side = *robot_.rods[pair.rod].model->touching();
  return side.contacts()[pair.contact].grip == Grip::kTie;
}

void Equations::evaluate_pairs(ProblemResidual& r) {
  std::size_t ties = 0;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    Pair& pair = pairs_[k];
    const RobotRod& rod = robot_.rods[pair.rod];
    TouchingRod& side = *rod.model->touching();
    const RodContact& contact = side.contacts()[pair.contact];
    RodSide own;
    own.ends = side.contact_ends(pair.contact);
    own.radius = rod.section.half_width;
    const Vec3 x = contact_point(contact.xi, own.ends.h, own.ends.node);
    if (contact.body < 0 && contact.other_rod < 0) {
      const Surface& surface = side.surfaces()[static_cast<std::size_t>(contact.surface)];
      pair.rows = rows_with_world(contact, surface, own.radius, own.ends, side.contact_scale());
    } else if (contact.body >= 0) {
      const auto b = static_cast<std::size_t>(contact.body);
      const Surface& surface = side.surfaces()[static_cast<std::size_t>(contact.surface)];
      pair.rows =
          rows_with_body(contact, surface, moving_body(robot_.bodies[b], rates_, slip_from_[b]),
                         own.radius, own.ends, side.contact_scale());
      pair.arm = x + contact.lever - robot_.bodies[b].p;
      wrench_[b] += wrench_on_body(pair.arm, contact.force);
    } else {
      own.at_end = at_end(side, contact.cell, contact.xi);
      const RobotRod& other_rod = robot_.rods[static_cast<std::size_t>(contact.other_rod)];
      TouchingRod& other_side = *other_rod.model->touching();
      RodSide other;
      other.ends = other_side.contact_ends(static_cast<std::size_t>(contact.partner));
      other.radius = other_rod.section.half_width;
      other.at_end = at_end(other_side, contact.other_cell, contact.other_xi);
      if (contact.grip == Grip::kTie) {
        const auto partner = static_cast<std::size_t>(contact.partner);
        pair.rows = tie_rows(contact.arm, other_side.contacts()[partner].arm, own.ends, other.ends,
                             side.contact_scale());
        if (gaps_captured_) pair.rows.value -= (1 - fraction_) * tie_gap_[ties++];
      } else {
        pair.rows = rows_with_rod(contact, own, other, side.contact_scale());
      }
    }
    ContactRows& found = side.contact_state()[pair.contact];
    found.value = pair.rows.value;
    found.at = pair.rows.at;
    found.slip = pair.rows.slip;
    for (double value : pair.rows.value)
      note(value, {Worst::Kind::kContact, static_cast<int>(k), 0}, r);
  }
}

Vec6 Equations::contact_wrench(int body) const {
  Vec6 sum = Vec6::Zero();
  for (const Pair& pair : pairs_) {
    const RodContact& contact = robot_.rods[pair.rod].model->touching()->contacts()[pair.contact];
    if (contact.body == body) sum += wrench_on_body(pair.arm, contact.force);
  }
  return sum;
}

int Equations::number_pairs(int offset) {
  for (Pair& pair : pairs_) {
    pair.offset = offset;
    offset += 3;
  }
  for (std::size_t r = 0; r < robot_.rods.size(); ++r) {
    Elimination& e = eliminations_[r];
    e.forces.clear();
    e.signs.clear();
    const OpenPorts* ports = open_ports(r);
    if (!ports) continue;
    if (!e.delayed) e.z_F = -solve_columns(condensed_[r].T, ports->T_F);
    const std::vector<RodContact>& contacts = robot_.rods[r].model->touching()->contacts();
    for (std::size_t i : ports->contacts) {
      const RodContact& contact = contacts[i];
      const bool echo = contact.role == ContactRole::kEcho;
      const auto rod = echo ? static_cast<std::size_t>(contact.other_rod) : r;
      const auto entry = echo ? static_cast<std::size_t>(contact.partner) : i;
      const auto found = std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
        return pair.rod == rod && pair.contact == entry;
      });
      e.forces.push_back(found->offset);
      e.signs.push_back(echo ? -1 : 1);
    }
  }
  return offset;
}

// With z = z_A zeta_A + z_B zeta_B + z_F F + z0 where it is eliminated.
void Equations::add_rod_terms(int row, std::size_t r, const RodTerms& terms) {
  const RobotRod& rod = robot_.rods[r];
  const Elimination& e = eliminations_[r];
  const Eigen::Index n = terms.value.size();
  const bool A_moves = rod.base_held && rod.base.body >= 0 && !bodies_held_;
  const bool B_moves = rod.tip_held && rod.tip.body >= 0 && !bodies_held_;
  if (A_moves) J_.block(row, 6 * rod.base.body, n, 6) += terms.by_A;
  MatX by_F = terms.by_F;
  r_.segment(row, n) += terms.value;
  if (e.delayed) {
    J_.block(row, e.offset, n, 6) += terms.by_z;
  } else {
    if (A_moves) J_.block(row, 6 * rod.base.body, n, 6) += terms.by_z * e.z_A;
    if (B_moves) J_.block(row, 6 * rod.tip.body, n, 6) += terms.by_z * e.z_B;
    by_F += terms.by_z * e.z_F;
    r_.segment(row, n) += terms.by_z * e.z0;
  }
  for (std::size_t j = 0; j < e.forces.size(); ++j)
    J_.block(row, e.forces[j], n, 3) +=
        e.signs[j] * by_F.middleCols<3>(3 * static_cast<Eigen::Index>(j));
}

// What the forces do at rods' ends.
void Equations::assemble_open_forces(std::size_t r) {
  const OpenPorts* ports = open_ports(r);
  if (!ports) return;
  const RobotRod& rod = robot_.rods[r];
  const CondensedRod& c = condensed_[r];
  const Elimination& e = eliminations_[r];
  const auto add = [&](int row, const Eigen::Matrix<double, 6, Eigen::Dynamic>& by_F) {
    for (std::size_t j = 0; j < e.forces.size(); ++j)
      J_.block<6, 3>(row, e.forces[j]) +=
          e.signs[j] * by_F.middleCols<3>(3 * static_cast<Eigen::Index>(j));
  };
  if (e.delayed) add(e.offset, ports->T_F);
  if (rod.base_held && rod.base.body >= 0 && !bodies_held_)
    add(6 * rod.base.body, e.delayed ? ports->WA_F : ports->WA_F + c.WA_z * e.z_F);
  if (rod.tip_held && rod.tip.body >= 0 && !bodies_held_)
    add(6 * rod.tip.body, e.delayed ? ports->WB_F : ports->WB_F + c.WB_z * e.z_F);
}

void Equations::assemble_pairs() {
  const auto motion = [&](std::size_t rod, std::size_t contact) -> const OpenPorts::Motion& {
    const OpenPorts& ports = *open_ports(rod);
    const auto at = std::find(ports.contacts.begin(), ports.contacts.end(), contact);
    return ports.motions[static_cast<std::size_t>(at - ports.contacts.begin())];
  };
  for (const Pair& pair : pairs_) {
    const TouchingRod& side = *robot_.rods[pair.rod].model->touching();
    const RodContact& contact = robot_.rods[pair.rod].model->touching()->contacts()[pair.contact];
    const OpenPorts::Motion& own = motion(pair.rod, pair.contact);
    J_.block<3, 3>(pair.offset, pair.offset) += pair.rows.by_force;
    r_.segment<3>(pair.offset) += pair.rows.value;
    add_rod_terms(pair.offset, pair.rod, {pair.rows.by_ends, own});
    if (contact.body < 0 && contact.other_rod < 0) continue;
    if (contact.body < 0) {
      const auto other = static_cast<std::size_t>(contact.other_rod);
      add_rod_terms(pair.offset, other,
                    {pair.rows.by_other, motion(other, static_cast<std::size_t>(contact.partner))});
      continue;
    }
    if (bodies_held_) continue;
    const int b = 6 * contact.body;
    J_.block<3, 6>(pair.offset, b) += pair.rows.by_body;
    // (1), with d(y - p) = dx - dp; its value is in r_ already
    Eigen::Matrix<double, 6, 12> by_ends = Eigen::Matrix<double, 6, 12>::Zero();
    by_ends.topRows<3>() =
        hat(contact.force) * point_by_ends(contact.xi, side.contact_ends(pair.contact));
    add_rod_terms(b, pair.rod, {by_ends, own});
    J_.block<3, 3>(b, b + 3) -= hat(contact.force);
    J_.block<3, 3>(b, pair.offset) -= hat(pair.arm);
    J_.block<3, 3>(b + 3, pair.offset) -= Mat3::Identity();
  }
  for (std::size_t r = 0; r < robot_.rods.size(); ++r)
    assemble_open_forces(r);
}

void Equations::hold_still_bodies() {
  for (std::size_t b = 0; b < flies_.size(); ++b) {
    if (!stands_still(b)) continue;
    const auto at = 6 * static_cast<Eigen::Index>(b);
    J_.middleRows<6>(at).setZero();
    J_.block<6, 6>(at, at).setIdentity();
    r_.segment<6>(at).setZero();
  }
}

// Force that moves a body by the unit of length: rods' stiffness, or its own inertia over the step.
double Equations::force_unit(int body) const {
  if (body < 0) return robot_.scale.force;
  const double inertia =
      robot_.bodies[static_cast<std::size_t>(body)].mass * rates_.c_v * rates_.c_w;
  return std::max(robot_.scale.force, inertia * robot_.scale.length);
}

void Equations::pair_units(VecX& columns) const {
  for (const Pair& pair : pairs_) {
    RobotRod& rod = robot_.rods[pair.rod];
    const int body = rod.model->touching()->contacts()[pair.contact].body;
    const double inertia = rod.section.rhoA * rod.length * rates_.c_v * rates_.c_w;
    columns.segment<3>(pair.offset)
        .setConstant(std::max(force_unit(body), inertia * robot_.scale.length));
  }
}

/// Tells a rod how its shared forces move. @return what they add to its z
Vec6 Equations::distribute_forces(std::size_t r) {
  const Elimination& e = eliminations_[r];
  if (e.forces.empty()) return Vec6::Zero();
  VecX F(3 * static_cast<Eigen::Index>(e.forces.size()));
  for (std::size_t j = 0; j < e.forces.size(); ++j)
    F.segment<3>(3 * static_cast<Eigen::Index>(j)) = e.signs[j] * x_.segment<3>(e.forces[j]);
  robot_.rods[r].model->touching()->set_open_direction(F);
  return e.delayed ? Vec6(Vec6::Zero()) : Vec6(e.z_F * F);
}

std::string Equations::pair_name(const Pair& pair) const {
  const RobotRod& rod = robot_.rods[pair.rod];
  const RodContact& contact = rod.model->touching()->contacts()[pair.contact];
  const Scene& scene = *robot_.scene;
  if (contact.grip == Grip::kTie)
    return "a tie of " + rod.spec->name + " and " +
           robot_.rods[static_cast<std::size_t>(contact.other_rod)].spec->name;
  if (contact.body < 0 && contact.other_rod < 0)
    return "contact " + std::to_string(pair.contact + 1) + " of " + rod.spec->name;
  const std::string other =
      contact.body < 0
          ? robot_.rods[static_cast<std::size_t>(contact.other_rod)].spec->name
          : scene
                .bodies[static_cast<std::size_t>(
                    robot_.bodies[static_cast<std::size_t>(contact.body)].links.front())]
                .name;
  return "contact of " + rod.spec->name + " with " + other;
}

}  // namespace cprsim
