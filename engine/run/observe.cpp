// SPDX-License-Identifier: BSD-3-Clause
// Between two snapshots, with θ = (t - t_a)/(t_b - t_a) and h = t_b - t_a:
//   (1) positions   p(θ) = H00 p_a + H10 h v_a + H01 p_b + H11 h v_b   (cubic Hermite)
//   (2) rotations   R(θ) = R_a exp(θ log(R_aᵀ R_b))                    (geodesic)
//   (3) the rest    linear
// Along a rod the same with s for t and p_s = L R v, L the length and v the strain (1,
// shear_stretch). A position whose velocity is exactly zero at both ends, as in a quasi-static run,
// goes linearly.
#include "engine/run/observe.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "engine/model/scene.h"
#include "engine/run/pair_value.h"

namespace cprsim {

namespace {

/// Where between two instants (or two points of a rod) to look.
struct Between {
  double theta = 0;     ///< 0 at a, 1 at b
  double interval = 0;  ///< b - a

  double operator()(double a, double b) const { return a + theta * (b - a); }

  Vec3 operator()(const Vec3& a, const Vec3& b) const { return a + theta * (b - a); }

  // (1)
  template <typename T>
  T hermite(const T& a, const T& a_rate, const T& b, const T& b_rate) const {
    const double t = theta, t2 = t * t, t3 = t2 * t;
    return T((2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * interval * a_rate +
             (3 * t2 - 2 * t3) * b + (t3 - t2) * interval * b_rate);
  }

  // (2)
  Mat3 rotation(const Mat3& a, const Mat3& b) const {
    return Quat(a).slerp(theta, Quat(b)).toRotationMatrix();
  }

  Vec3 moved(const Vec3& a, const Vec3& a_rate, const Vec3& b, const Vec3& b_rate) const {
    if (a_rate.isZero(0) && b_rate.isZero(0)) return (*this)(a, b);
    return hermite<Vec3>(a, a_rate, b, b_rate);
  }
};

BodySample body_between(const BodySample& a, const BodySample& b, const Between& at) {
  BodySample body;
  body.X_WB.p = at.moved(a.X_WB.p, a.linear_velocity, b.X_WB.p, b.linear_velocity);
  body.X_WB.R = at.rotation(a.X_WB.R, b.X_WB.R);
  body.linear_velocity = at(a.linear_velocity, b.linear_velocity);
  body.angular_velocity = at(a.angular_velocity, b.angular_velocity);
  return body;
}

JointSample joint_between(const JointSample& a, const JointSample& b, const Between& at) {
  JointSample joint;
  joint.position = at.moved(a.position, a.velocity, b.position, b.velocity);
  joint.velocity = at(a.velocity, b.velocity);
  joint.effort = at(a.effort, b.effort);
  joint.limit = at(a.limit, b.limit);
  return joint;
}

/// All of a rod point but its position and s.
RodPoint section_between(const RodPoint& a, const RodPoint& b, const Between& at) {
  RodPoint point;
  point.rotation = at.rotation(a.rotation, b.rotation);
  point.velocity = at(a.velocity, b.velocity);
  point.force = at(a.force, b.force);
  point.moment = at(a.moment, b.moment);
  point.curvature = at(a.curvature, b.curvature);
  point.shear_stretch = at(a.shear_stretch, b.shear_stretch);
  point.rest_curvature = b.rest_curvature;
  return point;
}

RodSample rod_between(const RodSample& a, const RodSample& b, const Between& at) {
  RodSample rod;
  rod.length = at(a.length, b.length);
  rod.radius = at(a.radius, b.radius);
  rod.points.reserve(b.points.size());
  const bool same_grid = a.points.size() == b.points.size();
  for (std::size_t i = 0; i < b.points.size(); ++i) {
    const RodPoint& end = b.points[i];
    const RodPoint begin = same_grid && a.points[i].s == end.s ? a.points[i] : point_at(a, end.s);
    RodPoint point = section_between(begin, end, at);
    point.s = end.s;
    point.position = at.moved(begin.position, begin.velocity, end.position, end.velocity);
    rod.points.push_back(point);
  }
  return rod;
}

EnergySample energy_between(const EnergySample& a, const EnergySample& b, const Between& at) {
  EnergySample energy;
  energy.kinetic = at(a.kinetic, b.kinetic);
  energy.elastic = at(a.elastic, b.elastic);
  energy.gravity = at(a.gravity, b.gravity);
  energy.magnetic = at(a.magnetic, b.magnetic);
  energy.dissipated = at(a.dissipated, b.dissipated);
  energy.work = at(a.work, b.work);
  energy.total = at(a.total, b.total);
  energy.balance = at(a.balance, b.balance);
  return energy;
}

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

Snapshot interpolate(const Snapshot& a, const Snapshot& b, double t) {
  if (t <= a.time) return a;
  if (t >= b.time) return b;
  const Between at{(t - a.time) / (b.time - a.time), b.time - a.time};
  Snapshot result;
  result.time = t;
  for (std::size_t i = 0; i < b.bodies.size(); ++i) {
    result.bodies.push_back(body_between(a.bodies.at(i), b.bodies[i], at));
  }
  for (std::size_t i = 0; i < b.joints.size(); ++i) {
    result.joints.push_back(joint_between(a.joints.at(i), b.joints[i], at));
  }
  for (std::size_t i = 0; i < b.rods.size(); ++i) {
    result.rods.push_back(rod_between(a.rods.at(i), b.rods[i], at));
  }
  for (std::size_t i = 0; i < b.tendons.size(); ++i) {
    const TendonSample &from = a.tendons.at(i), &to = b.tendons[i];
    result.tendons.push_back({at(from.tension, to.tension), at(from.displacement, to.displacement),
                              at(from.end_tension, to.end_tension)});
  }
  result.energy = energy_between(a.energy, b.energy, at);
  // counts belong to the step that ends at b
  result.solver = b.solver;
  result.contact = b.contact;
  return result;
}

RodPoint point_at(const RodSample& rod, double s) {
  if (rod.points.empty()) throw std::invalid_argument("a rod sample without points");
  if (s <= rod.points.front().s) return rod.points.front();
  if (s >= rod.points.back().s) return rod.points.back();
  const auto above = std::upper_bound(rod.points.begin(), rod.points.end(), s,
                                      [](double v, const RodPoint& point) { return v < point.s; });
  const RodPoint& a = *(above - 1);
  const RodPoint& b = *above;
  if (s == a.s) return a;
  const Between at{(s - a.s) / (b.s - a.s), b.s - a.s};
  RodPoint point = section_between(a, b, at);
  point.s = s;
  point.position = at.hermite<Vec3>(a.position, rod.length * (a.rotation * a.shear_stretch),
                                    b.position, rod.length * (b.rotation * b.shear_stretch));
  return point;
}

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
