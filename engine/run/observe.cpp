// SPDX-License-Identifier: BSD-3-Clause
#include "engine/run/observe.h"

#include <stdexcept>
#include <utility>

#include "engine/model/scene.h"
#include "engine/run/pair_value.h"

namespace cprsim {

namespace {

[[noreturn]] void no_such_quantity(const Channel& channel) {
  throw std::invalid_argument("channel '" + channel.name + "' has no value");
}

/// x y z w, w >= 0.
Vec4 quaternion_of(const Mat3& R) {
  const Vec4 q = Quat(R).normalized().coeffs();
  return q.w() < 0 ? Vec4(-q) : q;
}

/// A pose and how it moves, of whatever a channel names.
BodySample motion_of(const FrameRef& frame, const Snapshot& snapshot) {
  if (frame.body == kWorld) return {frame.X_BF, Vec3::Zero(), Vec3::Zero()};
  const BodySample& body = snapshot.bodies.at(static_cast<std::size_t>(frame.body));
  const Vec3 arm = body.X_WB.R * frame.X_BF.p;
  return {body.X_WB * frame.X_BF, body.linear_velocity + body.angular_velocity.cross(arm),
          body.angular_velocity};
}

double value_of(const Channel& channel, const BodySample& body) {
  switch (channel.quantity) {
    case Quantity::kPosition:
      return body.X_WB.p[channel.component];
    case Quantity::kOrientation:
      return quaternion_of(body.X_WB.R)[channel.component];
    case Quantity::kLinearVelocity:
      return body.linear_velocity[channel.component];
    case Quantity::kAngularVelocity:
      return body.angular_velocity[channel.component];
    default:
      no_such_quantity(channel);
  }
}

double value_of(const Channel& channel, const JointSample& joint) {
  switch (channel.quantity) {
    case Quantity::kJointPosition:
      return joint.position[channel.component];
    case Quantity::kJointVelocity:
      return joint.velocity[channel.component];
    case Quantity::kJointEffort:
      return joint.effort[channel.component];
    case Quantity::kJointLimit:
      return joint.limit[channel.component];
    default:
      no_such_quantity(channel);
  }
}

double value_of(const Channel& channel, const RodSample& rod) {
  if (channel.quantity == Quantity::kLength) return rod.length;
  const RodPoint point = point_at(rod, channel.s);
  switch (channel.quantity) {
    case Quantity::kPosition:
      return point.position[channel.component];
    case Quantity::kOrientation:
      return quaternion_of(point.rotation)[channel.component];
    case Quantity::kLinearVelocity:
      return point.velocity[channel.component];
    case Quantity::kForce:
      return point.force[channel.component];
    case Quantity::kMoment:
      return point.moment[channel.component];
    case Quantity::kCurvature:
      return point.curvature[channel.component];
    case Quantity::kShearStretch:
      return point.shear_stretch[channel.component];
    default:
      no_such_quantity(channel);
  }
}

double value_of(const Channel& channel, const EnergySample& energy) {
  switch (channel.quantity) {
    case Quantity::kEnergyKinetic:
      return energy.kinetic;
    case Quantity::kEnergyElastic:
      return energy.elastic;
    case Quantity::kEnergyGravity:
      return energy.gravity;
    case Quantity::kEnergyMagnetic:
      return energy.magnetic;
    case Quantity::kEnergyDissipated:
      return energy.dissipated;
    case Quantity::kEnergyWork:
      return energy.work;
    case Quantity::kEnergyTotal:
      return energy.total;
    case Quantity::kEnergyBalance:
      return energy.balance;
    default:
      no_such_quantity(channel);
  }
}

double value_of(const Channel& channel, const SolverSample& solver) {
  switch (channel.quantity) {
    case Quantity::kSolverIterations:
      return solver.iterations;
    case Quantity::kSolverResidual:
      return solver.residual;
    case Quantity::kSolverStep:
      return solver.step;
    case Quantity::kSolverWallTime:
      return solver.wall_time;
    default:
      no_such_quantity(channel);
  }
}

double value_of(const Channel& channel, const ContactSample& contact) {
  switch (channel.quantity) {
    case Quantity::kContactCount:
      return contact.count;
    case Quantity::kContactPenetration:
      return contact.penetration;
    case Quantity::kContactForce:
      return contact.force;
    case Quantity::kContactFriction:
      return contact.friction;
    case Quantity::kContactSlip:
      return contact.slip;
    default:
      no_such_quantity(channel);
  }
}

/// The whole quaternion of which an orientation channel is one component.
Vec4 quaternion_of(const Channel& channel, const Scene& scene, const Snapshot& snapshot) {
  Vec4 q;
  Channel one = channel;
  for (one.component = 0; one.component < 4; ++one.component) {
    q[one.component] = evaluate(one, scene, snapshot);
  }
  return q;
}

}  // namespace

double evaluate(const Channel& channel, const Scene& scene, const Snapshot& snapshot) {
  const auto index = static_cast<std::size_t>(channel.index);
  switch (channel.entity) {
    case ChannelEntity::kBody:
      return value_of(channel, snapshot.bodies.at(index));
    case ChannelEntity::kFrame:
      return value_of(channel, motion_of(scene.frames.at(index).at, snapshot));
    case ChannelEntity::kJoint:
      return value_of(channel, snapshot.joints.at(index));
    case ChannelEntity::kRodPoint:
    case ChannelEntity::kRod:
      return value_of(channel, snapshot.rods.at(index));
    case ChannelEntity::kTendon: {
      const TendonSample& tendon = snapshot.tendons.at(index);
      if (channel.quantity == Quantity::kEndTension) return tendon.end_tension;
      return channel.quantity == Quantity::kTension ? tendon.tension : tendon.displacement;
    }
    case ChannelEntity::kEnergy:
      return value_of(channel, snapshot.energy);
    case ChannelEntity::kSolver:
      return value_of(channel, snapshot.solver);
    case ChannelEntity::kContact:
      return value_of(channel, snapshot.contact);
    case ChannelEntity::kContactPair:
      return pair_value(channel, snapshot.contact);
  }
  no_such_quantity(channel);
}

ChannelReader::ChannelReader(const Scene& scene, std::vector<Channel> channels)
    : scene_(&scene),
      channels_(std::move(channels)),
      last_quaternions_(channels_.size(), Vec4::Zero()),
      values_(channels_.size(), 0) {}

const std::vector<double>& ChannelReader::read(const Snapshot& snapshot) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channel& channel = channels_[i];
    if (channel.quantity != Quantity::kOrientation) {
      values_[i] = evaluate(channel, *scene_, snapshot);
      continue;
    }
    // q and -q are the same attitude: take the one nearer to the last
    Vec4 q = quaternion_of(channel, *scene_, snapshot);
    if (q.dot(last_quaternions_[i]) < 0) q = -q;
    last_quaternions_[i] = q;
    values_[i] = q[channel.component];
  }
  return values_;
}

}  // namespace cprsim
