// SPDX-License-Identifier: BSD-3-Clause
// Unknowns by value, and how they move along a direction.
#include "engine/math/so3.h"
#include "engine/robot/equations.h"

namespace cprsim {

bool alike(const RobotUnknowns& a, const RobotUnknowns& b) {
  const auto alike_rods = [](const RodModel::Unknowns& u, const RodModel::Unknowns& v) {
    return u.values.size() == v.values.size() && u.starts.size() == v.starts.size() &&
           u.nodes.size() == v.nodes.size();
  };
  return a.bodies.size() == b.bodies.size() && a.joint_q.size() == b.joint_q.size() &&
         std::equal(a.rods.begin(), a.rods.end(), b.rods.begin(), b.rods.end(), alike_rods);
}

RobotUnknowns Equations::unknowns() const {
  RobotUnknowns u;
  for (const RobotRod& rod : robot_.rods)
    u.rods.push_back(rod.model->unknowns());
  for (const RigidBody& body : robot_.bodies)
    u.bodies.push_back(body.pose());
  for (const Joint& joint : robot_.joints) {
    u.joint_q.push_back(joint.q);
    u.joint_lambda.push_back(joint.lambda);
  }
  u.body_contacts = robot_.body_contacts;
  return u;
}

void Equations::set_unknowns(const RobotUnknowns& u) {
  for (std::size_t i = 0; i < u.rods.size(); ++i)
    robot_.rods[i].model->set_unknowns(u.rods[i]);
  for (std::size_t i = 0; i < u.bodies.size(); ++i) {
    robot_.bodies[i].R = u.bodies[i].R;
    robot_.bodies[i].p = u.bodies[i].p;
  }
  for (std::size_t i = 0; i < u.joint_q.size(); ++i) {
    robot_.joints[i].set_unknown_q(u.joint_q[i]);
    robot_.joints[i].lambda = u.joint_lambda[i];
  }
  robot_.body_contacts = u.body_contacts;
}

void Equations::predict(const std::vector<const RobotUnknowns*>& past,
                        const std::vector<double>& weights) {
  std::vector<const RodModel::Unknowns*> rod_past(past.size());
  for (std::size_t r = 0; r < robot_.rods.size(); ++r) {
    for (std::size_t i = 0; i < past.size(); ++i)
      rod_past[i] = &past[i]->rods[r];
    robot_.rods[r].model->predict(rod_past, weights);
  }
  for (std::size_t b = 0; b < robot_.bodies.size(); ++b) {
    const Mat3& R0 = past[0]->bodies[b].R;
    Vec3 p = Vec3::Zero(), turn = Vec3::Zero();
    for (std::size_t i = 0; i < past.size(); ++i) {
      p += weights[i] * past[i]->bodies[b].p;
      turn += weights[i] * log_so3(R0.transpose() * past[i]->bodies[b].R);
    }
    Vec6 motion;
    motion << R0 * turn, p - past[0]->bodies[b].p;
    motion = left_by_plane(motion);
    robot_.bodies[b].p = past[0]->bodies[b].p + motion.tail<3>();
    robot_.bodies[b].R = orthonormalized(exp_so3(motion.head<3>()) * R0);
  }
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    Joint& joint = robot_.joints[j];
    Vec3 q = Vec3::Zero();
    joint.lambda.setZero();
    for (std::size_t i = 0; i < past.size(); ++i) {
      q += weights[i] * past[i]->joint_q[j];
      joint.lambda += weights[i] * past[i]->joint_lambda[j];
    }
    joint.lambda = left_by_plane(joint.lambda);
    joint.set_unknown_q(q);
  }
  robot_.body_contacts = past.back()->body_contacts;
}

void Equations::keep() {
  kept_.bodies.clear();
  kept_.joint_q.clear();
  kept_.joint_lambda.clear();
  for (const RigidBody& body : robot_.bodies)
    kept_.bodies.push_back(body.pose());
  for (const Joint& joint : robot_.joints) {
    kept_.joint_q.push_back(joint.q);
    kept_.joint_lambda.push_back(joint.lambda);
  }
  kept_.body_contacts = robot_.body_contacts;
  for (RobotRod& rod : robot_.rods)
    rod.model->keep();
}

void Equations::move(double alpha) {
  for (std::size_t b = 0; b < robot_.bodies.size() && !bodies_held_; ++b) {
    const Vec6 d = alpha * body_direction(static_cast<int>(b));
    robot_.bodies[b].R = orthonormalized(exp_so3(d.head<3>()) * kept_.bodies[b].R);
    robot_.bodies[b].p = kept_.bodies[b].p + d.tail<3>();
  }
  for (std::size_t j = 0; j < robot_.joints.size() && !bodies_held_; ++j) {
    Joint& joint = robot_.joints[j];
    const Eigen::Index at = joint_offset_[j];
    joint.lambda = kept_.joint_lambda[j] + alpha * in_space(&x_[at]);
    for (std::size_t k = 0; k < joint.freedoms.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const int unknown = joint.freedoms[k].unknown;
      if (unknown >= 0) joint.q[i] = kept_.joint_q[j][i] + alpha * x_[at + freedoms_ + unknown];
    }
  }
  for (std::size_t k = 0; k < robot_.body_contacts.size(); ++k)
    robot_.body_contacts[k].law.force =
        kept_.body_contacts[k].law.force +
        alpha * x_.segment<3>(first_touch_ + 3 * static_cast<Eigen::Index>(k));
  for (RobotRod& rod : robot_.rods)
    rod.model->move(alpha);
}

Vec6 Equations::body_direction(int body) const {
  if (body < 0 || bodies_held_) return Vec6::Zero();
  return in_space(&x_[freedoms_ * body]);
}

}  // namespace cprsim
