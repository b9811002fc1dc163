// SPDX-License-Identifier: BSD-3-Clause
// From a scene to a robot: weld what fixed joints hold together, sort links into ground, Newton
// bodies and free ones, place rods, joints, drives and loads on them.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "engine/math/so3.h"
#include "engine/model/flight.h"
#include "engine/model/planar.h"
#include "engine/robot/break_rod.h"
#include "engine/robot/robot.h"
#include "engine/robot/ties.h"

namespace cprsim {
namespace {

/// Links welded together by fixed joints; the ground is element n.
class Welds {
 public:
  explicit Welds(const Scene& scene) : parent_(scene.bodies.size() + 1) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      if (scene.bodies[i].is_static) join(i, ground());
    for (const JointSpec& joint : scene.joints)
      if (joint.kind == JointKind::kFixed) join(element(joint.parent), element(joint.child));
  }

  std::size_t ground() const { return parent_.size() - 1; }

  std::size_t element(int body) const {
    return body == kWorld ? ground() : static_cast<std::size_t>(body);
  }

  std::size_t group(std::size_t i) const {
    while (parent_[i] != i)
      i = parent_[i];
    return i;
  }

  bool grounded(std::size_t i) const { return group(i) == group(ground()); }

 private:
  void join(std::size_t a, std::size_t b) { parent_[group(a)] = group(b); }

  std::vector<std::size_t> parent_;
};

// A group of links is part of the Newton system if a joint or a rod holds any of it, or if it flies
// among rods: links welded
// to each other and to nothing else are one body of it, not several free ones.
std::vector<char> held_groups(const Scene& scene, const Welds& welds) {
  std::vector<char> held(scene.bodies.size() + 1, 0);
  auto hold = [&](int body) { held[welds.group(welds.element(body))] = 1; };
  for (const JointSpec& joint : scene.joints) {
    hold(joint.parent);
    hold(joint.child);
  }
  for (const RodSpec& rod : scene.rods) {
    if (rod.base.joint != EndJoint::kFree) hold(rod.base.at.body);
    if (rod.tip.joint != EndJoint::kFree) hold(rod.tip.at.body);
  }
  const std::vector<char> among_rods = bodies_among_rods(scene);
  for (std::size_t i = 0; i < among_rods.size(); ++i)
    if (among_rods[i]) hold(static_cast<int>(i));
  return held;
}

void add_bodies(Robot& robot, const Welds& welds, const std::vector<char>& held) {
  const Scene& scene = *robot.scene;
  std::vector<int> body_of_group(scene.bodies.size() + 1, LinkPlace::kGround);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const std::size_t group = welds.group(i);
    LinkPlace place;
    place.X = scene.bodies[i].X_WB;
    if (!welds.grounded(i)) {
      if (!held[group]) {
        place.body = LinkPlace::kFree;
      } else {
        if (body_of_group[group] == LinkPlace::kGround) {
          body_of_group[group] = static_cast<int>(robot.bodies.size());
          robot.bodies.emplace_back();
        }
        place.body = body_of_group[group];
        robot.bodies[static_cast<std::size_t>(place.body)].links.push_back(static_cast<int>(i));
      }
    }
    robot.links.push_back(place);
  }
}

// Mass, centre of mass and inertia of welded links.
void compose(Robot& robot, RigidBody& body) {
  const Scene& scene = *robot.scene;
  auto spec = [&](int i) -> const BodySpec& { return scene.bodies[static_cast<std::size_t>(i)]; };
  body.R = spec(body.links.front()).X_WB.R;
  Vec3 first_moment = Vec3::Zero(), gravity_moment = Vec3::Zero();
  for (int i : body.links) {
    const BodySpec& link = spec(i);
    const Vec3 com = link.X_WB * link.com;
    body.mass += link.mass;
    first_moment += link.mass * com;
    if (!link.gravity) continue;
    body.gravity_mass += link.mass;
    gravity_moment += link.mass * com;
  }
  body.p = body.mass > 0 ? Vec3(first_moment / body.mass) : spec(body.links.front()).X_WB.p;
  if (body.gravity_mass > 0)
    body.gravity_arm = body.R.transpose() * (gravity_moment / body.gravity_mass - body.p);
  for (int i : body.links) {
    const BodySpec& link = spec(i);
    const Mat3 R = body.R.transpose() * link.X_WB.R;
    const Vec3 r = body.R.transpose() * (link.X_WB * link.com - body.p);
    body.inertia += R * link.inertia * R.transpose() - link.mass * hat(r) * hat(r);
    robot.links[static_cast<std::size_t>(i)].X = body.pose().inverse() * link.X_WB;
  }
}

Attachment attach(const Robot& robot, const FrameRef& frame) {
  if (frame.body == kWorld) return {LinkPlace::kGround, frame.X_BF};
  const LinkPlace& link = robot.links[static_cast<std::size_t>(frame.body)];
  return {link.body, link.X * frame.X_BF};
}

void add_joints(Robot& robot) {
  for (const JointSpec& spec : robot.scene->joints) {
    if (spec.kind == JointKind::kFixed) {
      robot.joint_of_spec.push_back(-1);
      continue;
    }
    const Attachment parent = attach(robot, {spec.parent, spec.X_PJ}),
                     child = attach(robot, {spec.child, spec.X_CJ});
    robot.joint_of_spec.push_back(static_cast<int>(robot.joints.size()));
    robot.joints.emplace_back(spec, parent.body, child.body, parent.X, child.X);
  }
}

RodPlan plan_of(const Robot& robot, const RobotRod& rod) {
  const Scene& scene = *robot.scene;
  const auto has = [&](Effect e) {
    return scene.effects.has(e) && !rod.spec->lacks(effect_name(e));
  };
  RodPlan plan;
  plan.spec = rod.spec;
  plan.X_WBase = robot.pose_of(rod.base);
  plan.X_WTip = robot.pose_of(rod.tip);
  plan.plane = robot.plane;
  plan.section = rod.section;
  if (SectionsAlong::varies(*rod.spec)) {
    plan.along = std::make_shared<SectionsAlong>(*rod.spec, has(Effect::kDrag));
    plan.section = plan.along->at(0, 0);
  }
  plan.length = rod.length;
  if (rod.tip_held && rod.base_held && rod.gravity)
    plan.limpness = robot.gravity.norm() * std::abs(plan.section.weighing_mass()) *
                    std::pow(rod.length, 3) / plan.section.K_bt.head<2>().minCoeff();
  plan.extension = has(Effect::kExtension);
  plan.shear = has(Effect::kShear);
  plan.rotary_inertia = has(Effect::kRotaryInertia);
  plan.damping = has(Effect::kDamping) && rod.spec->damping.has_value();
  plan.drag = rod.section.fluid.resists();
  plan.touches = !plan.plane && (has(Effect::kContact) || has(Effect::kSelfContact));
  plan.magnetic = rod.magnetic;
  plan.tied = rod.tied;
  plan.line_loads = !rod.line_loads.empty() || rod.magnetic;
  for (const LoadSpec* load : rod.loads)
    plan.stations.push_back(load->rod_s);
  plan.stations.insert(plan.stations.end(), rod.breaks.begin(), rod.breaks.end());
  for (const RobotTendon& tendon : rod.tendons)
    plan.tendons.emplace_back(*tendon.spec, has(Effect::kTendonFriction));
  plan.solver = &scene.solver;
  return plan;
}

void add_rods(Robot& robot, const RodMaker& make) {
  const Scene& scene = *robot.scene;
  for (std::size_t i = 0; i < scene.rods.size(); ++i) {
    const RodSpec& spec = scene.rods[i];
    RobotRod rod;
    rod.spec = &spec;
    rod.section = section_properties(spec);
    if (scene.effects.has(Effect::kDrag) && spec.drag && !spec.lacks("drag"))
      rod.section.fluid = fluid_properties(*spec.drag, rod.section.area);
    rod.base_held = spec.base.joint != EndJoint::kFree;
    rod.tip_held = spec.tip.joint != EndJoint::kFree;
    rod.base = attach(robot, spec.base.at);
    if (rod.tip_held) rod.tip = attach(robot, spec.tip.at);
    rod.length = spec.length;
    for (const DriveSpec& drive : scene.drives)
      if (drive.rod == static_cast<int>(i)) rod.length_drive = &drive.profile;
    for (const LoadSpec& load : scene.loads)
      if (load.rod == static_cast<int>(i)) (load.to ? rod.line_loads : rod.loads).push_back(&load);
    const auto has = [&](Effect e) { return scene.effects.has(e) && !spec.lacks(effect_name(e)); };
    rod.magnetic = has(Effect::kMagnetic) && !spec.magnets.empty();
    rod.heated = has(Effect::kThermal) && spec.temperature && spec.material;
    break_rod(scene, i, rod);
    rod.gravity = spec.gravity && !spec.lacks("gravity");
    if (rod.length_drive) rod.length = rod.length_drive->evaluate(0, true).value;
    const RodPlan plan = plan_of(robot, rod);
    rod.choice = choose_method(plan);
    rod.model = make(rod.choice.method, plan);
    if (!spec.start.empty()) {
      const bool twisted = holds_spin(spec.base) && holds_spin(spec.tip);
      rod.model->set_curve(
          RodCurve(spec.start, rod.length, plan.X_WBase.R, twisted ? &plan.X_WTip.R : nullptr));
    }
    robot.rods.push_back(std::move(rod));
  }
  tie_rods(robot);
}

void add_actions(Robot& robot) {
  const Scene& scene = *robot.scene;
  for (const DriveSpec& drive : scene.drives) {
    if (drive.joint < 0) continue;
    const int index = robot.joint_of_spec[static_cast<std::size_t>(drive.joint)];
    if (index < 0) continue;
    Joint& joint = robot.joints[static_cast<std::size_t>(index)];
    if (drive.freedom < 0 || drive.freedom >= static_cast<int>(joint.freedoms.size()))
      throw std::invalid_argument("joint '" + joint.spec->name + "' has no axis " +
                                  std::to_string(drive.freedom + 1) + " to drive");
    Joint::Freedom& freedom = joint.freedoms[static_cast<std::size_t>(drive.freedom)];
    if (drive.quantity == DriveQuantity::kPosition) freedom.motion = Joint::Motion::kPosition;
    if (drive.quantity == DriveQuantity::kVelocity) freedom.motion = Joint::Motion::kVelocity;
    joint.count_unknowns();
    robot.joint_drives.push_back({index, drive.freedom, &drive});
  }
  for (const LoadSpec& load : scene.loads)
    if (load.rod < 0) {
      const Attachment at = attach(robot, load.at);
      if (at.body >= 0) robot.body_loads.push_back({&load, at});
    }
}

/// The bodies that hang on `child` by joints other than `through`; empty if the ground or `parent`
/// is among them.
std::vector<int> carried_by(const Robot& robot, std::size_t through) {
  std::vector<int> found{robot.joints[through].child};
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const Joint& joint = robot.joints[j];
      if (j == through || (joint.parent != found[i] && joint.child != found[i])) continue;
      const int other = joint.parent == found[i] ? joint.child : joint.parent;
      if (other < 0 || other == robot.joints[through].parent) return {};
      if (std::find(found.begin(), found.end(), other) == found.end()) found.push_back(other);
    }
  return found;
}

// A driven joint need not stand at 0 when the scene begins: what it carries is moved to where the
// drive wants it. Closed rigid loops are left to the solver.
void place_driven_bodies(Robot& robot) {
  for (const JointDrive& drive : robot.joint_drives)
    if (drive.spec->quantity == DriveQuantity::kPosition)
      robot.joints[static_cast<std::size_t>(drive.joint)].q[drive.freedom] =
          drive.spec->profile.evaluate(0, true).value;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const Joint& joint = robot.joints[j];
    if (joint.q.isZero(0) || joint.child < 0) continue;
    const Pose moved = joint.displacement(robot.body_pose(joint.parent));
    for (int b : carried_by(robot, j)) {
      RigidBody& body = robot.bodies[static_cast<std::size_t>(b)];
      const Pose X = moved * body.pose();
      body.R = orthonormalized(X.R);
      body.p = X.p;
    }
  }
  for (RigidBody& body : robot.bodies)
    body.start_tracks(Vec3::Zero(), Vec3::Zero());
}

RobotScale choose_scale(const Robot& robot) {
  RobotScale scale;
  double length = 0, force = 0, weight = 0;
  for (const RobotRod& rod : robot.rods) {
    length = std::max(length, rod.length);
    force = std::max(force, rod.section.K_bt.head<2>().maxCoeff() / (rod.length * rod.length));
  }
  for (const RigidBody& body : robot.bodies)
    weight += body.mass * 9.81;
  if (length == 0) length = 0.1;
  scale.length = length;
  scale.force = force > 0 ? force : std::max(weight, 1e-6);
  return scale;
}

}  // namespace

Robot::Robot() = default;
Robot::Robot(Robot&&) noexcept = default;
Robot& Robot::operator=(Robot&&) noexcept = default;
Robot::~Robot() = default;

Robot build_robot(const Scene& scene, const RodMaker& make_rods) {
  Robot robot;
  robot.scene = &scene;
  if (scene.effects.has(Effect::kGravity)) robot.gravity = scene.gravity;
  if (scene.planar_normal) robot.plane = plane_axes(*scene.planar_normal);
  const Welds welds(scene);
  add_bodies(robot, welds, held_groups(scene, welds));
  for (RigidBody& body : robot.bodies)
    compose(robot, body);
  add_joints(robot);
  add_actions(robot);
  place_driven_bodies(robot);
  add_rods(robot, make_rods ? make_rods : RodMaker(make_rod));
  robot.scale = choose_scale(robot);
  for (Joint& joint : robot.joints)
    joint.set_scale(robot.scale.length, robot.scale.moment(), robot.scale.force);
  return robot;
}

Pose Robot::pose_of(const Attachment& a) const {
  return a.body < 0 ? a.X : bodies[static_cast<std::size_t>(a.body)].pose() * a.X;
}

Port Robot::port(const Attachment& a) const {
  const Pose X = pose_of(a);
  Port port;
  port.R = X.R;
  port.p = X.p;
  port.moves = a.body >= 0;
  if (port.moves) port.arm = X.p - bodies[static_cast<std::size_t>(a.body)].p;
  return port;
}

Pose Robot::link_pose(std::size_t link) const {
  const LinkPlace& place = links[link];
  return place.body < 0 ? place.X : bodies[static_cast<std::size_t>(place.body)].pose() * place.X;
}

bool Robot::has_joint_loops() const {
  // each joint joins two groups that were apart, or closes a loop; the ground is the last element
  std::vector<std::size_t> group(bodies.size() + 1);
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto of = [&](int body) {
    return group[body < 0 ? bodies.size() : static_cast<std::size_t>(body)];
  };
  for (const Joint& joint : joints) {
    const std::size_t a = of(joint.parent), b = of(joint.child);
    if (a == b) return true;
    std::replace(group.begin(), group.end(), a, b);
  }
  return false;
}

void Robot::start_joints(const std::vector<Vec6>& motions) {
  for (Joint& joint : joints) {
    const Pose P = body_pose(joint.parent), C = body_pose(joint.child);
    const auto velocity_at = [&](int body, const Pose& X) {
      Vec6 v = body < 0 ? Vec6(Vec6::Zero()) : motions[static_cast<std::size_t>(body)];
      v.tail<3>() += v.head<3>().cross(joint.place(C) - X.p);
      return v;
    };
    joint.start_tracks(P, C, velocity_at(joint.child, C) - velocity_at(joint.parent, P));
  }
}

std::vector<Track*> Robot::tracks() {
  std::vector<Track*> all;
  for (RigidBody& body : bodies) {
    all.push_back(&body.position);
    all.push_back(&body.rotation);
  }
  for (Joint& joint : joints) {
    all.push_back(&joint.track);
    if (joint.is_ball()) all.push_back(&joint.spin);
  }
  for (RobotRod& rod : rods)
    for (Track* track : rod.model->tracks())
      all.push_back(track);
  return all;
}

}  // namespace cprsim
