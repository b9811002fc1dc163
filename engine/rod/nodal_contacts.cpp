// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/nodal_contacts.h"

#include <algorithm>

#include "engine/math/so3.h"

namespace cprsim {
namespace {

Mat3 axes_of(const NodeState& node) {
  return rotation_of(node);
}

}  // namespace

void NodalContacts::set_surfaces(const std::vector<Surface>& surfaces, double radius,
                                 bool friction) {
  given_ = true;
  surfaces_ = surfaces;
  radius_ = radius;
  friction_ = friction;
  turns_.resize(friction ? 3 * static_cast<Eigen::Index>(contact_nodes().size()) : 0);
  accept_contacts();
}

void NodalContacts::accept_contacts() {
  if (!given_) return;
  accepted_ = contact_nodes();
  references_.clear();
  for (const NodeState& node : accepted_)
    references_.push_back(axes_of(node));
  for (RodContact& contact : contacts_)
    contact.held = contact.force;
}

double NodalContacts::cell_length(std::size_t cell) const {
  const std::vector<double>& grid = contact_grid();
  return (grid[cell + 1] - grid[cell]) * host_.rod_length();
}

// As ShootingRod::contact_node().
ContactNode NodalContacts::node(std::size_t k) const {
  const NodeState& state = contact_nodes()[k];
  const StageRates& rates = host_.stage_rates();
  ContactNode out;
  out.p = position_of(state);
  const Mat3 R = rotation_of(state);
  out.t = R.col(2);
  out.v.setZero();
  out.w.setZero();
  if (!friction_) return out;
  if (!rates.dynamic()) {
    out.v = out.p - position_of(accepted_[k]);
    out.v_by_p = 1;
    out.w = log_so3(R * rotation_of(accepted_[k]).transpose());
    out.w_by_phi = right_jacobian_inverse(-out.w);
    return out;
  }
  out.v = rates.c_v * out.p + host_.velocity_history(k);
  out.v_by_p = rates.c_v;
  // equations of engine/robot/body.cpp
  const Vec3 theta = log_so3(references_[k].transpose() * R);
  const Vec3 theta_t = rates.c_v * theta + turns_.x_h.segment<3>(3 * static_cast<Eigen::Index>(k));
  Mat3 by_theta = rates.c_v * Mat3::Identity();
  Vec3 omega = theta_t;
  if (rates.body_rates) {
    const Mat3 J_r = right_jacobian(theta);
    omega = J_r * theta_t;
    by_theta = rates.c_v * J_r + right_jacobian_derivative(theta, theta_t);
  }
  out.w = R * omega;
  out.w_by_phi = R * by_theta * right_jacobian_inverse(theta) * R.transpose() - hat(out.w);
  return out;
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
    sum.tail<3>() += (hG * R.col(2) + S * contact.lever).cross(contact.force);
  });
  return sum;
}

// (phi × t) × f = [f] [t] phi
Mat3 NodalContacts::moment_by_turn(std::size_t node, const Mat3& R) const {
  Mat3 sum = Mat3::Zero();
  at_node(node, [&](std::size_t i, double, double hG, double) {
    if (hG != 0) sum += hG * hat(contacts_[i].force) * hat(Vec3(R.col(2)));
  });
  return sum;
}

NodalContacts::ByForces NodalContacts::load_by_forces(std::size_t node, const Mat3& R) const {
  ByForces by = ByForces::Zero(6, columns());
  at_node(node, [&](std::size_t i, double H, double hG, double S) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    by.block<3, 3>(0, at) += H * Mat3::Identity();
    by.block<3, 3>(3, at) += hat(Vec3(hG * R.col(2) + S * contacts_[i].lever));
  });
  return by;
}

void NodalContacts::begin_rows() {
  rows_.resize(contacts_.size());
  for (ContactRows& row : rows_)
    row.slip.setZero();
}

void NodalContacts::describe_motions(const std::vector<MatX>& moves) {
  ports_.contacts.resize(contacts_.size());
  ports_.motions.resize(contacts_.size());
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const RodContact& contact = contacts_[i];
    MatX both = MatX::Zero(12, 13 + columns());
    both.topRows<6>() = moves[contact.cell];
    if (!contact.at_node()) both.bottomRows<6>() = moves[contact.cell + 1];
    ports_.contacts[i] = i;
    OpenPorts::Motion& motion = ports_.motions[i];
    motion.by_z = both.leftCols<6>();
    motion.by_A = both.middleCols<6>(6);
    motion.value = both.col(12);
    motion.by_F = both.rightCols(columns());
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

void NodalContacts::fill_turns() {
  if (!friction_) return;
  const StageRates& rates = host_.stage_rates();
  for (std::size_t k = 0; k < references_.size(); ++k) {
    const auto i = 3 * static_cast<Eigen::Index>(k);
    const Vec3 theta = log_so3(references_[k].transpose() * axes_of(contact_nodes()[k]));
    const Vec3 theta_t = rates.c_v * theta + turns_.x_h.segment<3>(i);
    turns_.x.segment<3>(i) = theta;
    turns_.v.segment<3>(i) = rates.body_rates ? Vec3(right_jacobian(theta) * theta_t) : theta_t;
  }
}

void NodalContacts::start_turns() {
  if (!friction_) return;
  turns_.set_start(VecX::Zero(turns_.x.size()), VecX::Zero(turns_.x.size()));
}

double NodalContacts::friction_power() const {
  double power = 0;
  if (!friction_ || !host_.stage_rates().dynamic()) return power;
  for (std::size_t i = 0; i < std::min(rows_.size(), contacts_.size()); ++i)
    if (contacts_[i].role != ContactRole::kEcho) power += contact_loss(contacts_[i], rows_[i]);
  return power;
}

}  // namespace cprsim
