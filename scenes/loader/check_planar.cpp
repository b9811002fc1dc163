// SPDX-License-Identifier: BSD-3-Clause
// A scene with <planar> may hold nothing that would leave the plane: the planar kernel could not
// answer for it. Planes at different heights along the normal are fine; a rod stays in one.
#include <algorithm>
#include <cmath>

#include "engine/model/planar.h"
#include "engine/model/start_pose.h"
#include "scenes/loader/reading.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

constexpr const char* kCode = "E511";

class PlanarCheck {
 public:
  PlanarCheck(Reading& r, const Vec3& normal) : r_(r), scene_(r.scene), normal_(normal) {}

  void run(const Node& world) {
    gravity(world);
    current(world);
    for (const JointSpec& joint : scene_.joints)
      check(joint);
    for (std::size_t k = 0; k < scene_.rods.size(); ++k)
      check(scene_.rods[k]);
    for (const LoadSpec& load : scene_.loads)
      check(load);
    for (std::size_t k = 0; k < scene_.tendons.size(); ++k)
      check(scene_.tendons[k]);
    for (const MagneticFieldSpec& field : scene_.magnetic_fields)
      check(field);
    velocities();
  }

 private:
  void complain(const Place& place, int caret, const std::string& message,
                const std::string& suggestion = "leave <planar> out: the spatial model takes it") {
    r_.report.at(Severity::kError, kCode, place, caret, message).suggestion = suggestion;
  }

  /// Whether a vector of any length has a part that matters along the normal, or across it.
  bool leaves(const Vec3& v) const {
    return std::abs(v.dot(normal_)) > kPlanarAngle * std::max(v.norm(), 1e-300);
  }

  bool turns(const Vec3& v) const {
    return v.cross(normal_).norm() > kPlanarAngle * std::max(v.norm(), 1e-300);
  }

  Pose in_world(const FrameRef& frame) const { return start_pose(scene_, frame); }

  void gravity(const Node& world) {
    if (!scene_.effects.has(Effect::kGravity) || !leaves(scene_.gravity)) return;
    const Node* node = world.child("gravity");
    const std::string message = "gravity, " + words(scene_.gravity) + " m/s2, leaves the plane";
    if (node)
      r_.report.error(kCode, *node, message, "give a <gravity> in the plane");
    else
      r_.report
          .at(Severity::kError, kCode,
              scene_.effects.asked_at[static_cast<std::size_t>(Effect::kGravity)], 7, message)
          .suggestion = "give a <gravity> in the plane";
  }

  void current(const Node& world) {
    const Node* wind = world.child("wind");
    if (wind && scene_.effects.has(Effect::kDrag) && leaves(scene_.wind))
      r_.report.error(kCode, *wind, "the current, " + words(scene_.wind) + " m/s, leaves the plane",
                      "leave <planar> out: the spatial model takes it");
  }

  static std::string words(const Vec3& v) {
    return format_number(v.x()) + " " + format_number(v.y()) + " " + format_number(v.z());
  }

  void check(const JointSpec& joint) {
    if (joint.kind == JointKind::kFixed || joint.kind == JointKind::kBall) return;
    if (joint.kind == JointKind::kUniversal || joint.kind == JointKind::kScrew ||
        joint.kind == JointKind::kCylindrical)
      complain(joint.place, 5, "joint '" + joint.name + "' is of a type that moves in space");
    const Vec3 axis = in_world({joint.parent, joint.X_PJ}).R * joint.axis;
    const bool slides = joint.kind == JointKind::kPrismatic;
    if (slides ? leaves(axis) : turns(axis))
      complain(joint.place, 5,
               "the axis of joint '" + joint.name + "', " + words(axis) + " in the world, " +
                   (slides ? "does not lie in the plane" : "is not along the plane's normal"));
  }

  /// The same bending and shear stiffness about every axis across the tangent.
  static bool alike_all_around(const RodSpec& rod) {
    const auto is_round = [](const SectionSpec& s) {
      return s.shape == SectionShape::kCircle || s.shape == SectionShape::kAnnulus ||
             s.size.x() == s.size.y();
    };
    const bool round =
        is_round(rod.section) && std::all_of(rod.sections.begin(), rod.sections.end(), is_round);
    const StiffnessSpec& k = rod.stiffness;
    return (round || k.bending_x) && k.bending_x == k.bending_y && (round || k.shear_x) &&
           k.shear_x == k.shear_y;
  }

  bool end(const RodSpec& rod, const RodEndSpec& spec, const char* name) {
    const int caret = static_cast<int>(std::string_view(name).size());
    const std::string whose = std::string(name) + " of rod '" + rod.name + "'";
    const Mat3 R = in_world(spec.at).R;
    if (leaves(R.col(2))) {
      complain(spec.place, caret,
               "the tangent at the " + whose + ", " + words(R.col(2)) + ", leaves the plane");
      return false;
    }
    if (!planar_hold(spec, R.transpose() * normal_)) {
      complain(spec.place, caret,
               "the joint at the " + whose +
                   " turns neither about the plane's normal nor about an axis in it",
               "turn its frame or its axis, or use joint=\"ball\"");
      return false;
    }
    return true;
  }

  void check(const RodSpec& rod) {
    check_rest(rod);
    if (scene_.effects.has(Effect::kMagnetic) && !rod.lacks("magnetic")) check_magnets(rod);
    const bool tip_held = rod.tip.joint != EndJoint::kFree;
    if (!end(rod, rod.base, "base") || (tip_held && !end(rod, rod.tip, "tip"))) return;
    const Pose base = in_world(rod.base.at), tip = tip_held ? in_world(rod.tip.at) : base;
    const double apart = (tip.p - base.p).dot(normal_);
    if (std::abs(apart) > kPlanarAngle * std::max(rod.length, 1e-9))
      complain(rod.tip.place, 3,
               "the ends of rod '" + rod.name + "' are " + format_number(std::abs(apart)) +
                   " m apart along the plane's normal");
    const bool base_spin = holds_spin(rod.base), tip_spin = tip_held && holds_spin(rod.tip);
    const Vec3 at_base = base.R.transpose() * normal_, at_tip = tip.R.transpose() * normal_;
    if (base_spin && tip_spin && (at_base - at_tip).norm() > kPlanarAngle)
      complain(rod.tip.place, 3,
               "the tip's frame is turned about the tangent against the base's: rod '" + rod.name +
                   "' would be twisted",
               "turn the tip's frame, or give it spin=\"free\"");
    const Vec3& section = tip_spin && !base_spin ? at_tip : at_base;
    const bool principal = std::min(std::abs(section.x()), std::abs(section.y())) < kPlanarAngle;
    if (!principal && !alike_all_around(rod))
      complain(rod.place, 10,
               "no principal axis of the section of rod '" + rod.name +
                   "' lies along the plane's normal: it would bend out of the plane",
               "turn the frames of its ends about the tangent");
  }

  /// What bends a rod without a load.
  void check_rest(const RodSpec& rod) {
    const Mat3 R = axes_of(rod);
    bool bends = turns(R * rod.rest_curvature);
    for (const RestSample& sample : rod.rest_samples)
      bends = bends || turns(R * sample.curvature);
    if (bends) complain(rod.place, 10, "rod '" + rod.name + "' is bent at rest, out of the plane");
    if (!scene_.effects.has(Effect::kThermal) || !rod.temperature || rod.lacks("thermal")) return;
    const Vec2& gradient = rod.temperature->gradient;
    if (turns(R * Vec3(gradient.y(), -gradient.x(), 0)))
      complain(rod.place, 10,
               "rod '" + rod.name + "' is warmer on one side, which bends it out of the plane");
  }

  /// Section axes where the rod begins, up to a turn in the plane.
  Mat3 axes_of(const RodSpec& rod) const {
    const bool by_tip =
        rod.tip.joint != EndJoint::kFree && holds_spin(rod.tip) && !holds_spin(rod.base);
    return in_world(by_tip ? rod.tip.at : rod.base.at).R;
  }

  void check_magnets(const RodSpec& rod) {
    if (rod.magnets.empty()) return;
    for (const MagnetSpec& magnet : rod.magnets)
      if (leaves(axes_of(rod) * magnet.moment))
        complain(rod.place, 10, "the magnetisation of rod '" + rod.name + "' leaves the plane");
    const double height = in_world(rod.base.at).p.dot(normal_);
    for (const MagneticFieldSpec& field : scene_.magnetic_fields)
      if (field.dipole && std::abs(field.position.dot(normal_) - height) >
                              kPlanarAngle * std::max(rod.length, 1e-9))
        complain(field.place, 22,
                 "the dipole is not in the plane of rod '" + rod.name + "', which it would leave");
  }

  void check(const MagneticFieldSpec& field) {
    const Vec3& v = field.dipole ? field.moment : field.uniform;
    if (scene_.effects.has(Effect::kMagnetic) && leaves(v))
      complain(field.place, 22, "the magnetic field's " + words(v) + " leaves the plane");
  }

  void check(const LoadSpec& load) {
    check_law(load);
    Mat3 R = load.R_expressed;
    if (load.follower && load.rod < 0) R = in_world(load.at).R * R;
    if (load.follower && load.rod >= 0) R = axes_of(scene_.rods[at(load.rod)]) * R;
    const Vec3 F = R * load.force, T = R * load.torque;
    if (leaves(F))
      complain(load.place, 11, "the force " + words(F) + " N leaves the plane");
    else if (turns(T))
      complain(load.place, 11, "the torque " + words(T) + " N m is not about the plane's normal");
  }

  void check(const TendonSpec& tendon) {
    const RodSpec& rod = scene_.rods[at(tendon.rod)];
    const std::string name = "tendon '" + tendon.name + "'";
    for (const double s : {0., 0.25, 0.5, 0.75, 1.}) {
      const Vec2 r = tendon_offset(tendon, s, s).r;
      if (!leaves(axes_of(rod) * Vec3(r.x(), r.y(), 0))) continue;
      complain(tendon.place, 14, name + " runs beside the plane that its rod stays in");
      break;
    }
  }

  void check_law(const LoadSpec& load) {
    if (load.law < 0) return;
    const double* x = load.law_values.data();
    for (const LawValue& value : kPlaceLaws[at(load.law)].values) {
      if (value.kind == LawValue::kDirection && leaves(Vec3(x[0], x[1], x[2])))
        complain(load.place, 11, "the direction of a load along a rod leaves the plane");
      x += value.size();
    }
  }

  void velocities() {
    for (const BodySpec& body : scene_.bodies)
      if (body.velocity_given && (leaves(body.linear_velocity) || turns(body.angular_velocity)))
        complain(body.place, 4, "the initial velocity of " + body.name + " leaves the plane");
  }

  Reading& r_;
  const Scene& scene_;
  Vec3 normal_;
};

}  // namespace

void check_planar(Reading& r, const Node& world) {
  // what could not be read has its own error, and would give more here
  if (r.scene.planar_normal && !r.report.failed())
    PlanarCheck(r, *r.scene.planar_normal).run(world);
  if (!r.scene.planar_normal || r.scene.ties.empty() || r.report.failed()) return;
  r.scene.planar_normal.reset();
  r.report.at(Severity::kNote, "W592", r.scene.ties.front().place, 10,
              "rods that are tied are solved in space: <planar> makes nothing cheaper here, and "
              "what is not symmetric about the plane may be pushed out of it");
}

}  // namespace cprsim
