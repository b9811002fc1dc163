// SPDX-License-Identifier: BSD-3-Clause
// Where bodies touch each other and what stands still, and how: between solves, as
// engine/robot/contacts.h does for rods. Bodies here are those of the Newton system, held by rods
// and joints or flying among rods; links of one model touch only if one flies. What flies stands
// still in statics and touches nothing there.
//
// Points: the corners of boxes and meshes, the ends of capsules, spheres as balls, eight points of
// a rim; and, where they are lower than these, the lowest points of rims, edges, axes of capsules
// and ellipsoids. Each pair of colliders is looked at both ways.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/robot/robot.h"
#include "engine/run/snapshot.h"

namespace cprsim {

class BodyContacts {
 public:
  using MeshOf = std::function<const MeshDistance*(const ShapeSpec&)>;

  /// Gives the robot its probes. Without the effect, or bodies that may touch: none.
  BodyContacts(Robot& robot, const MeshOf& mesh_of);

  bool any() const { return !groups_.empty(); }

  // As RodContacts.
  bool revise(int round);
  bool ease(int steps);
  bool hold();

  bool touching() const { return !robot_.body_contacts.empty(); }

  void begin_step(bool lagged);
  void begin_stage(double left, double since);
  void refresh();
  bool changed() const;
  bool leapt() const;
  std::string overlap() const;
  void add_to(ContactSample& sample) const;
  void visit(Archive& archive);

 private:
  /// The probes of one collider against another: far apart all at once.
  struct Group {
    std::size_t first = 0, last = 0;  ///< probes
    Vec3 centre = Vec3::Zero();       ///< of a ball around the collider, in its body
    double radius = 0;
    Vec3 other_centre = Vec3::Zero();  ///< likewise; of a plane: none
    double other_radius = 0;
  };

  /// The lowest point of a probe, in its body, and how far it is from touching.
  struct Foot {
    Vec3 at = Vec3::Zero();
    double gap = 0;
    Vec3 normal = Vec3::UnitZ();
  };

  struct Change {
    double urgency = 0;
    int existing = -1;
    bool drop = false;
    BodyContact contact;
  };

  void add_group(std::size_t link, const ColliderSpec& collider, std::size_t other_link,
                 const ColliderSpec& other, const MeshOf& mesh_of);

  Pose pose(int body) const { return robot_.body_pose(body); }

  bool acts(const BodyProbe& probe) const;
  bool far(const Group& group) const;
  Foot foot(const BodyProbe& probe) const;
  Foot lowest_on_edge(const BodyProbe& probe) const;
  double distance(const BodyProbe& probe, const Vec3& at, Vec3* normal) const;

  Pose begun_pose(int body) const {
    return body < 0 ? Pose{} : begun_[static_cast<std::size_t>(body)];
  }

  Distance begun(const BodyProbe& probe, const Vec3& at) const;
  double sunk(const BodyContact& contact, const BodyContact* before) const;
  const BodyContact* before(const BodyContact& contact) const;
  double bounce(const BodyProbe& probe, const Foot& foot) const;
  void set_terms(BodyContact& contact) const;
  bool follow(BodyContact& contact, const ContactRows& rows) const;
  void review(std::vector<Change>& changes) const;
  void search(std::vector<Change>& changes) const;
  void apply(const std::vector<Change>& changes);
  BodyContact new_contact(std::size_t probe, const Foot& foot) const;

  Robot& robot_;
  bool friction_ = false, lagged_ = false, rates_ = false;
  int eased_ = 0;
  double left_ = 0;
  std::vector<char> flies_;  ///< of Robot::bodies
  std::vector<Group> groups_;
  std::vector<Pose> begun_;     ///< of bodies, where the step began
  std::vector<Vec6> velocity_;  ///< of bodies then: angular, of the centre of mass
  double since_ = 0;            ///< time since then, s
  std::vector<BodyContact> before_;
};

/// Probes of a collider, in the axes of its link, without what they are held against.
std::vector<BodyProbe> probes_of(const ColliderSpec& collider, const std::vector<MeshSpec>& meshes);

/// A ball around a collider: centre in its link's axes, radius; infinite for a plane.
std::pair<Vec3, double> ball_around(const ColliderSpec& collider,
                                    const std::vector<MeshSpec>& meshes);

/// Least extent of a solid; infinite for a plane.
double thickness_of(const ShapeSpec& shape, const std::vector<MeshSpec>& meshes);

}  // namespace cprsim
