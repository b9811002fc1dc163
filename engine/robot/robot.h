// SPDX-License-Identifier: BSD-3-Clause
// The robot: bodies, joints and rods of the one Newton system, with what drives and loads them.
// Built once from a scene (build_robot); afterwards only states change.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/robot/body.h"
#include "engine/robot/body_contact.h"
#include "engine/robot/joint.h"
#include "engine/rod/fineness.h"
#include "engine/rod/rod_maker.h"
#include "engine/section/section.h"

namespace cprsim {

/// Where a link of the scene went.
struct LinkPlace {
  static constexpr int kGround = -1;  ///< never moves
  static constexpr int kFree = -2;    ///< held by no rod and no joint: integrated elsewhere
  int body = kGround;                 ///< index into Robot::bodies, kGround or kFree
  Pose X;  ///< link frame in the body (origin: its centre of mass) or in the world
};

/// A frame on a body of the Newton system or on the ground.
struct Attachment {
  int body = LinkPlace::kGround;
  Pose X;
};

struct RobotTendon {
  int index = -1;  ///< into Scene::tendons
  const TendonSpec* spec = nullptr;
  const DriveSpec* drive = nullptr;
};

struct RobotRod {
  const RodSpec* spec = nullptr;
  SectionProperties section;
  MethodChoice choice;
  std::unique_ptr<RodModel> model;
  Attachment base, tip;
  bool base_held = true, tip_held = false;
  double length = 0;
  const Profile* length_drive = nullptr;
  std::vector<const LoadSpec*> loads;       ///< at points
  std::vector<const LoadSpec*> line_loads;  ///< spread along it
  std::vector<RobotTendon> tendons;
  std::vector<double> breaks;  ///< s / L of breaks of tendons and line loads: no load acts there
  bool tied = false;           ///< to another rod
  bool gravity = true;
  bool magnetic = false, heated = false;  ///< by the effects and what the rod has
  RodForcing forcing;                     ///< at the current instant

  /// Makes s a break, once.
  void break_at(double s);
};

struct BodyLoad {
  const LoadSpec* spec = nullptr;
  Attachment at;
};

struct JointDrive {
  int joint = -1;   ///< index into Robot::joints
  int freedom = 0;  ///< of that joint
  const DriveSpec* spec = nullptr;
};

/// Numbers that make the global rows dimensionless.
struct RobotScale {
  double length = 1, force = 1;

  double moment() const { return force * length; }
};

class PhaseClock;

struct Robot {
  // Compiled once, in build.cpp: dozens of files make one.
  Robot();
  Robot(Robot&&) noexcept;
  Robot& operator=(Robot&&) noexcept;
  ~Robot();

  const Scene* scene = nullptr;
  std::vector<LinkPlace> links;  ///< as Scene::bodies
  std::vector<RigidBody> bodies;
  std::vector<Joint> joints;
  std::vector<int> joint_of_spec;  ///< Scene::joints → joints, -1 where welded
  std::vector<RobotRod> rods;
  std::vector<BodyLoad> body_loads;
  std::vector<JointDrive> joint_drives;
  Vec3 gravity = Vec3::Zero();                 ///< 0 unless the effect is on
  bool rods_meet = false;                      ///< bodies that move, or each other
  std::vector<BodyProbe> probes;               ///< of bodies that may touch
  std::vector<BodyContact> body_contacts;      ///< where they do
  std::vector<ContactRows> body_contact_rows;  ///< of these, at the last evaluation
  RobotScale scale;
  std::optional<Mat3> plane;    ///< of a planar scene: e1, e2 and the normal as columns, world
  PhaseClock* clock = nullptr;  ///< measures where time goes, if somebody asked; not owned

  Pose pose_of(const Attachment& a) const;

  /// Of a Newton body; identity for the ground.
  Pose body_pose(int body) const {
    return body < 0 ? Pose{} : bodies[static_cast<std::size_t>(body)].pose();
  }

  Port port(const Attachment& a) const;
  Pose link_pose(std::size_t link) const;

  /// Whether joints alone, without rods, join bodies and ground into a closed loop.
  bool has_joint_loops() const;

  /// Joints begin to move as their bodies do: (omega, velocity of the centre of mass), world axes.
  void start_joints(const std::vector<Vec6>& motions);

  /// Everything a time scheme integrates.
  std::vector<Track*> tracks();
};

/// A load at time t: world axes, or those of its section or frame if it follows. `before`: left
/// limit at a jump.
PointLoad load_at(const LoadSpec& load, double t, bool before);

/// The same of a load that is spread along a rod.
LineLoad line_load_at(const LoadSpec& load, double t, bool before);

/// What a tendon's motor prescribes at time t; a tendon without one is slack.
TendonPull pull_at(const RobotTendon& tendon, double t, bool before);

/// Field of one source at time t; all of them, times `share`.
MagneticSources sources_at(const MagneticFieldSpec& field, double t, bool before);
MagneticSources sources_at(const Scene& scene, double t, bool before, double share);

/// What heat does at time t to the strains of a rod that has a temperature.
ThermalStrain thermal_strain_at(const RodSpec& rod, double t, bool before);

/// Into the rod's forcing, times `share`; breaks of tendons are stations without a load.
void pull_tendons(RobotRod& rod, double t, bool before, double share);

/// @param make_rods makes the rods; empty: make_rod().
/// @throws std::invalid_argument for what this version cannot do.
Robot build_robot(const Scene& scene, const RodMaker& make_rods = {});

}  // namespace cprsim
