// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/nodal_contacts.h"

#include "engine/math/so3.h"

namespace cprsim {
void NodalContacts::set_surfaces(const std::vector<Surface>& surfaces, double radius,
                                 bool friction) {
  given_ = true;
  surfaces_ = surfaces;
  radius_ = radius;
  motion_.start(friction, contact_nodes().size());
  accept_contacts();
}

void NodalContacts::accept_contacts() {
  if (!given_) return;
  motion_.accept(contact_nodes());
  for (RodContact& contact : contacts_)
    contact.held = contact.force;
}

double NodalContacts::cell_length(std::size_t cell) const {
  const std::vector<double>& grid = contact_grid();
  return (grid[cell + 1] - grid[cell]) * host_.rod_length();
}

ContactNode NodalContacts::node(std::size_t k) const {
  const StageRates& rates = host_.stage_rates();
  const bool dynamic = motion_.friction() && rates.dynamic();
  return motion_.at(k, contact_nodes()[k], rates,
                    dynamic ? host_.velocity_history(k) : Vec3(Vec3::Zero()));
}

ContactEnds NodalContacts::contact_ends(std::size_t index) const {
  const RodContact& contact = contacts_[index];
  ContactEnds ends;
  ends.node[0] = node(contact.cell);
  if (contact.at_node()) return ends;
  ends.node[1] = node(contact.cell + 1);
  ends.h = cell_length(contact.cell);
  return ends;
}

/// Calls visit(index, H, h G, S) for the points that act at a node.
template <class Visit>
void NodalContacts::at_node(std::size_t node, Visit visit) const {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const RodContact& contact = contacts_[i];
    if (contact.at_node()) {
      if (contact.cell == node) visit(i, 1.0, 0.0, 1.0);
      continue;
    }
    for (std::size_t end = 0; end < 2; ++end) {
      if (contact.cell + end != node) continue;
      const ContactWeights weights(contact.xi);
      visit(i, weights.H[end], cell_length(contact.cell) * weights.G[end], weights.S[end]);
    }
  }
}

Vec6 NodalContacts::load_at(std::size_t node, const Mat3& R) const {
  Vec6 sum = Vec6::Zero();
  at_node(node, [&](std::size_t i, double H, double hG, double S) {
    const RodContact& contact = contacts_[i];
    sum.head<3>() += H * contact.force;
    sum.tail<3>() += (hG * R.col(2) + S * contact.lever_at(R)).cross(contact.force);
  });
  return sum;
}

// (phi × t) × f = [f] [t] phi
Mat3 NodalContacts::moment_by_turn(std::size_t node, const Mat3& R) const {
  Mat3 sum = Mat3::Zero();
  at_node(node, [&](std::size_t i, double, double hG, double) {
    const RodContact& contact = contacts_[i];
    if (hG != 0) sum += hG * hat(contact.force) * hat(Vec3(R.col(2)));
    if (contact.grip == Grip::kTie) sum += hat(contact.force) * hat(contact.lever_at(R));
  });
  return sum;
}

NodalContacts::ByForces NodalContacts::load_by_forces(std::size_t node, const Mat3& R) const {
  ByForces by = ByForces::Zero(6, columns());
  at_node(node, [&](std::size_t i, double H, double hG, double S) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    by.block<3, 3>(0, at) += H * Mat3::Identity();
    by.block<3, 3>(3, at) += hat(Vec3(hG * R.col(2) + S * contacts_[i].lever_at(R)));
  });
  return by;
}

void NodalContacts::begin_rows() {
  rows_.resize(contacts_.size());
  for (ContactRows& row : rows_)
    row.slip.setZero();
}

void NodalContacts::describe_motions(const std::vector<MatX>& moves, std::vector<MatX>* rest) {
  ports_.contacts.resize(contacts_.size());
  ports_.motions.resize(contacts_.size());
  if (rest) rest->resize(contacts_.size());
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const RodContact& contact = contacts_[i];
    MatX both = MatX::Zero(12, moves[contact.cell].cols());
    both.topRows<6>() = moves[contact.cell];
    if (!contact.at_node()) both.bottomRows<6>() = moves[contact.cell + 1];
    ports_.contacts[i] = i;
    OpenPorts::Motion& motion = ports_.motions[i];
    motion.by_z = both.leftCols<6>();
    motion.by_A = both.middleCols<6>(6);
    motion.value = both.col(12);
    motion.by_F = both.middleCols(13, columns());
    if (rest) (*rest)[i] = both.rightCols(both.cols() - 13 - columns());
  }
}

void NodalContacts::keep() {
  kept_.clear();
  for (const RodContact& contact : contacts_)
    kept_.push_back(contact.force);
}

void NodalContacts::move(double alpha) {
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    contacts_[i].force = kept_[i] + alpha * direction_.segment<3>(3 * static_cast<Eigen::Index>(i));
}

void NodalContacts::visit(Archive& archive) {
  cprsim::visit(contacts_, archive);
  cprsim::visit(rows_, archive);
  motion_.visit(archive);
}

void NodalContacts::fill_turns() {
  motion_.fill_turns(contact_nodes(), host_.stage_rates());
}

double NodalContacts::friction_power() const {
  const bool moves = motion_.friction() && host_.stage_rates().dynamic();
  return moves ? cprsim::friction_power(contacts_, rows_) : 0;
}

}  // namespace cprsim
