// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/contact_motion.h"

#include <algorithm>

#include "engine/math/so3.h"

namespace cprsim {

void ContactMotion::start(bool friction, std::size_t nodes) {
  friction_ = friction;
  turns_.resize(friction ? 3 * static_cast<Eigen::Index>(nodes) : 0);
}

void ContactMotion::accept(const std::vector<NodeState>& nodes) {
  accepted_ = nodes;
  references_.clear();
  for (const NodeState& node : nodes)
    references_.emplace_back(rotation_of(node));
}

ContactMotion::Turn ContactMotion::turn_of(std::size_t node, const Mat3& R,
                                           const StageRates& rates) const {
  Turn turn;
  turn.theta = log_so3(references_[node].transpose() * R);
  turn.theta_t =
      rates.c_v * turn.theta + turns_.x_h.segment<3>(3 * static_cast<Eigen::Index>(node));
  return turn;
}

ContactNode ContactMotion::at(std::size_t node, const NodeState& state, const StageRates& rates,
                              const Vec3& velocity_history) const {
  ContactNode out;
  out.p = position_of(state);
  const Mat3 R = rotation_of(state);
  out.R = R;
  out.t = R.col(2);
  out.v.setZero();
  out.w.setZero();
  if (!friction_) return out;
  if (!rates.dynamic()) {
    out.v = out.p - position_of(accepted_[node]);
    out.v_by_p = 1;
    out.w = log_so3(R * rotation_of(accepted_[node]).transpose());
    out.w_by_phi = right_jacobian_inverse(-out.w);
    return out;
  }
  out.v = rates.c_v * out.p + velocity_history;
  out.v_by_p = rates.c_v;
  const auto [theta, theta_t] = turn_of(node, R, rates);
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

void ContactMotion::fill_turns(const std::vector<NodeState>& nodes, const StageRates& rates) {
  if (!friction_) return;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto i = 3 * static_cast<Eigen::Index>(k);
    const auto [theta, theta_t] = turn_of(k, rotation_of(nodes[k]), rates);
    turns_.x.segment<3>(i) = theta;
    turns_.v.segment<3>(i) = rates.body_rates ? Vec3(right_jacobian(theta) * theta_t) : theta_t;
  }
}

void ContactMotion::start_turns() {
  if (friction_) turns_.set_start(VecX::Zero(turns_.x.size()), VecX::Zero(turns_.x.size()));
}

void ContactMotion::visit(Archive& archive) {
  archive.doubles(accepted_);
  if (archive.reading()) accept(std::vector<NodeState>(accepted_));
}

double friction_power(const std::vector<RodContact>& contacts,
                      const std::vector<ContactRows>& rows) {
  double power = 0;
  for (std::size_t i = 0; i < std::min(rows.size(), contacts.size()); ++i)
    if (contacts[i].role != ContactRole::kEcho) power += contact_loss(contacts[i], rows[i]);
  return power;
}

}  // namespace cprsim
