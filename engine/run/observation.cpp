// SPDX-License-Identifier: BSD-3-Clause
#include "engine/run/observation.h"

namespace cprsim {

std::vector<BodyMotion> link_motions(const Robot& robot, const FreeBodies* free_bodies) {
  std::vector<BodyMotion> motions(robot.links.size());
  for (std::size_t i = 0; i < motions.size(); ++i) {
    BodyMotion& motion = motions[i];
    motion.X_WB = robot.link_pose(i);
    const int index = robot.links[i].body;
    if (index < 0) continue;
    const RigidBody& body = robot.bodies[static_cast<std::size_t>(index)];
    motion.angular_velocity = body.R * body.omega;
    motion.linear_velocity =
        body.velocity() + motion.angular_velocity.cross(motion.X_WB.p - body.p);
  }
  if (free_bodies) free_bodies->read(motions);
  return motions;
}

Snapshot take_snapshot(const Robot& robot, const FreeBodies* free_bodies, double time) {
  Snapshot now;
  now.time = time;
  for (const BodyMotion& motion : link_motions(robot, free_bodies))
    now.bodies.push_back({motion.X_WB, motion.linear_velocity, motion.angular_velocity});
  for (std::size_t i = 0; i < robot.joint_of_spec.size(); ++i) {
    JointSample sample;
    if (const int index = robot.joint_of_spec[i]; index >= 0) {
      const Joint& joint = robot.joints[static_cast<std::size_t>(index)];
      const Joint::Observed seen =
          joint.observe(robot.body_pose(joint.parent), robot.body_pose(joint.child));
      sample = {seen.position, seen.velocity, seen.effort, seen.stop};
    }
    now.joints.push_back(sample);
  }
  for (const RobotRod& rod : robot.rods)
    now.rods.push_back(rod.model->observe());
  now.tendons.resize(robot.scene->tendons.size());
  for (const RobotRod& rod : robot.rods) {
    if (rod.tendons.empty()) continue;
    const std::vector<TendonSample> samples = rod.model->tendons();
    for (std::size_t k = 0; k < samples.size(); ++k)
      now.tendons[static_cast<std::size_t>(rod.tendons[k].index)] = samples[k];
  }
  if (free_bodies) now.contact = free_bodies->contacts();
  return now;
}

}  // namespace cprsim
