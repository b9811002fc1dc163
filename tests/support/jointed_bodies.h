// SPDX-License-Identifier: BSD-3-Clause
// Rigid bodies on joints, without rods, built in code.
#pragma once

#include "tests/support/robots.h"

namespace cprsim {

/// A body with its centre of mass at its link's origin.
BodySpec lump(const std::string& name, const Pose& X_WB, double mass,
              const Vec3& principal_inertia);

/// A joint at a place in the world, its axes those of the world, between two bodies of the scene.
JointSpec joint_at(const Scene& scene, JointKind kind, const Vec3& place, int parent, int child,
                   const Vec3& axis = Vec3::UnitZ());

void move_for(Scene& scene, double duration, double tolerance);

DriveSpec& drive(Scene& scene, int joint, DriveQuantity quantity, double value, int freedom = 0);

}  // namespace cprsim
