// SPDX-License-Identifier: BSD-3-Clause
// Robots that move in a plane, as spatial scenes; in_plane() gives the same scene with <planar>.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "engine/model/planar.h"
#include "tests/support/robots.h"

namespace cprsim {

/// Axes e1, e2, normal (columns) of the plane that a scene is built in.
using Plane = Mat3;

Plane coordinate_plane();

/// No axis of it along any of the world's.
Plane oblique_plane();

/// The frame at (x, y) of the plane whose z axis, a rod's tangent, is at `angle` to e1 and whose x
/// axis is the normal.
Pose frame_in(const Plane& plane, double x, double y, double angle);

Scene in_plane(Scene scene, const Plane& plane);

BodySpec block(const std::string& name, const Pose& X_WB, double mass, double size);

/// A joint between the world and body `child`, whose frame is its own at q = 0; axis in the world.
JointSpec joint_to_world(const Scene& scene, const std::string& name, JointKind kind, int child,
                         const Vec3& axis);

RodEndSpec end_at(EndJoint joint, int body, const Pose& X_BF, const Vec3& axis);

Profile ramp(double from, double to, double end);

/// A clamped rod of 0.4 m that a force at its tip, two thirds of it across, bends by a radian.
Scene planar_cantilever(const Plane& plane);

/// Crank, driven by `turn` rad within half a second; rod clamped to it and hinged to a slider.
Scene slider_crank(const Plane& plane, double turn);

/// Two rods of 1 m and 1 mm radius (200 GPa) clamped to cranks at (-0.2, 0) and (0.2, 0), joined by
/// a revolute joint; cranks at 120 and 60 degrees.
Scene rfrfr(const Plane& plane, double turn = 0);

/// Bent by a force and let go, with everything that a rod can have.
Scene planar_release(const Plane& plane);

void set_dynamic(Scene& scene, double duration, double step, SchemeKind scheme);

}  // namespace cprsim
