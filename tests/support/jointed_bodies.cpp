// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/jointed_bodies.h"

namespace cprsim {

BodySpec lump(const std::string& name, const Pose& X_WB, double mass,
              const Vec3& principal_inertia) {
  BodySpec body;
  body.name = name;
  body.X_WB = X_WB;
  body.mass = mass;
  body.inertia = principal_inertia.asDiagonal();
  return body;
}

JointSpec joint_at(const Scene& scene, JointKind kind, const Vec3& place, int parent, int child,
                   const Vec3& axis) {
  const auto in = [&](int body) {
    const Pose X{Mat3::Identity(), place};
    return body == kWorld ? X : scene.bodies[static_cast<std::size_t>(body)].X_WB.inverse() * X;
  };
  JointSpec joint;
  joint.name = "joint";
  joint.kind = kind;
  joint.parent = parent;
  joint.child = child;
  joint.X_PJ = in(parent);
  joint.X_CJ = in(child);
  joint.axis = axis;
  return joint;
}

void move_for(Scene& scene, double duration, double tolerance) {
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.duration = duration;
  scene.solver.tolerance = tolerance;
}

DriveSpec& drive(Scene& scene, int joint, DriveQuantity quantity, double value, int freedom) {
  DriveSpec spec;
  spec.joint = joint;
  spec.freedom = freedom;
  spec.quantity = quantity;
  ProfileTerm term;
  term.value = value;
  spec.profile.terms.push_back(term);
  scene.drives.push_back(spec);
  return scene.drives.back();
}

}  // namespace cprsim
