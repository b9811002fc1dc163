// SPDX-License-Identifier: BSD-3-Clause
// Contacts of bodies with each other and with what stands still: three unknowns and rows each,
// behind those of rods' contacts (engine/robot/body_contact.h).
#include <algorithm>

#include "engine/math/so3.h"
#include "engine/robot/equations.h"
#include "engine/solve/phase_clock.h"

namespace cprsim {
namespace {

/// Moment and force on a body at p of a force f at y.
Vec6 wrench_at(const Vec3& y, const Vec3& p, const Vec3& f) {
  Vec6 w;
  w << (y - p).cross(f), f;
  return w;
}

}  // namespace

void Equations::evaluate_body_contacts(ProblemResidual& r) {
  const PhaseTimer timer(robot_.clock, Phase::kContact);
  const std::vector<BodyContact>& contacts = robot_.body_contacts;
  touches_.resize(contacts.size());
  robot_.body_contact_rows.resize(contacts.size());
  const auto motion = [&](int body) {
    if (body < 0) return MovingBody{{}, rates_.dynamic(), {}};
    const auto b = static_cast<std::size_t>(body);
    return moving_body(robot_.bodies[b], rates_, slip_from_[b]);
  };
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const BodyProbe& probe = robot_.probes[contacts[k].probe];
    ContactScale scale;
    scale.length = robot_.scale.length;
    scale.force = std::max(force_unit(probe.body), force_unit(probe.other));
    scale.rate = scale.length * (rates_.dynamic() ? rates_.c_v : 1);
    const BodyContactRows& rows = touches_[k] =
        rows_between(probe, contacts[k], motion(probe.body), motion(probe.other), scale);
    const Vec3& f = contacts[k].law.force;
    const auto add = [&](int body, const Vec3& force) {
      if (body < 0) return;
      const auto b = static_cast<std::size_t>(body);
      wrench_[b] += wrench_at(rows.y, robot_.bodies[b].p, force);
    };
    add(probe.body, f);
    add(probe.other, -f);
    ContactRows& seen = robot_.body_contact_rows[k];
    seen.value = rows.value;
    seen.at = rows.at;
    seen.slip = rows.slip;
    for (double value : rows.value)
      note(value, {Worst::Kind::kBodyContact, static_cast<int>(k), 0}, r);
  }
}

int Equations::number_body_contacts(int offset) {
  first_touch_ = offset;
  return offset + 3 * static_cast<int>(robot_.body_contacts.size());
}

void Equations::assemble_body_contacts() {
  for (std::size_t k = 0; k < robot_.body_contacts.size(); ++k) {
    const BodyContact& contact = robot_.body_contacts[k];
    const BodyProbe& probe = robot_.probes[contact.probe];
    const BodyContactRows& rows = touches_[k];
    const Eigen::Index at = first_touch_ + 3 * static_cast<Eigen::Index>(k);
    r_.segment<3>(at) += rows.value;
    J_.block<3, 3>(at, at) += rows.by_force;
    if (bodies_held_) continue;
    const Eigen::Index a = 6 * probe.body, b = 6 * probe.other;
    const Vec3& f = contact.law.force;
    const Vec3 arm = rows.x - robot_.body_pose(probe.body).p;
    if (probe.body >= 0) {
      J_.block<3, 6>(at, a) += rows.by_body;
      // d((y - p) × f) = -f × (phi × arm) + (y - p) × df
      J_.block<3, 3>(a, a) += hat(f) * hat(arm);
      J_.block<3, 3>(a, at) += hat(rows.y - robot_.body_pose(probe.body).p);
      J_.block<3, 3>(a + 3, at) += Mat3::Identity();
    }
    if (probe.other < 0) continue;
    J_.block<3, 6>(at, b) += rows.by_other;
    // -d((y - p) × f) = f × (dy - dp) - (y - p) × df, y moving with the body that has the point
    J_.block<3, 3>(b, b + 3) -= hat(f);
    if (probe.body >= 0) {
      J_.block<3, 3>(b, a) -= hat(f) * hat(arm);
      J_.block<3, 3>(b, a + 3) += hat(f);
    }
    J_.block<3, 3>(b, at) -= hat(rows.y - robot_.body_pose(probe.other).p);
    J_.block<3, 3>(b + 3, at) -= Mat3::Identity();
  }
}

void Equations::body_contact_units(VecX& columns) const {
  for (std::size_t k = 0; k < robot_.body_contacts.size(); ++k) {
    const BodyProbe& probe = robot_.probes[robot_.body_contacts[k].probe];
    columns.segment<3>(first_touch_ + 3 * static_cast<Eigen::Index>(k))
        .setConstant(std::max(force_unit(probe.body), force_unit(probe.other)));
  }
}

std::string Equations::body_contact_name(std::size_t contact) const {
  const BodyProbe& probe = robot_.probes[robot_.body_contacts[contact].probe];
  const auto name = [&](int link) {
    return robot_.scene->bodies[static_cast<std::size_t>(link)].name;
  };
  return "contact of " + name(probe.link) + " with " + name(probe.other_link);
}

}  // namespace cprsim
