// SPDX-License-Identifier: BSD-3-Clause
// Where rods touch obstacles, and how: the part of contact that is not smooth. Between solves of
// the Newton system it looks where rods have sunk in, drops points that pull, and decides between
// stick and slip (a primal-dual active set method: Hintermüller, Ito, Kunisch, SIAM J. Optim. 13,
// 2002); the forces themselves are unknowns of the rods (engine/rod/contact.h). A solve is over
// when nothing is left to revise.
//
// Points: where a rod touches at a node, or nearest between two nodes, one point a cell. A rod that
// lies on something touches at its nodes, like the quadrature of a line contact.
//
// A step may not carry a rod through anything: no point of a centreline moves by more than half its
// distance from the solid, unless a contact holds it on its side. Planes have no other side.
#pragma once

#include <string>
#include <vector>

#include "engine/robot/robot.h"
#include "engine/run/snapshot.h"

namespace cprsim {

/// Depth that a scene tolerates, over the rod's radius.
constexpr double kContactTolerance = 1e-3;

class RodContacts {
 public:
  /// Gives the robot's rods what the scene lets them touch. Without the effect: nothing.
  explicit RodContacts(Robot& robot);

  /// Whether any rod may touch anything.
  bool any() const { return !rods_.empty(); }

  /// After a solve. @param round counts the revisions of this solve: late ones change one point at
  /// a time, so that no cycle goes on. @return whether anything changed and is to be solved again
  bool revise(int round);

  static constexpr int kMostRounds = 100;

  /// Whether any rod touches something now.
  bool touching() const;

  /// A step or a static increment begins here.
  void begin_step();

  /// Whether points came or went, stuck or slipped since begin_step().
  bool changed() const;

  /// Whether something may have passed through an obstacle since begin_step().
  bool leapt() const;

  /// The rod that is inside an obstacle by more than the tolerance, and the obstacle; or nothing.
  std::string overlap();

  ContactSample sample();

 private:
  struct Obstacle {
    std::string name;
    Surface surface;
    double friction = 0;
    bool plane = false;
  };

  /// What a scan found in a cell: the least distance of the centreline from anything.
  struct Near {
    double distance = 0;
    Vec3 normal = Vec3::Zero();
    bool solid = false;  ///< of a body with another side
  };

  struct Scan {
    std::vector<Vec3> nodes;
    std::vector<Near> cells;
    double clearance = 0;  ///< nothing is nearer, m
  };

  struct Rod {
    RobotRod* rod = nullptr;
    TouchingRod* side = nullptr;
    double radius = 0;
    std::vector<Obstacle> obstacles;
    Scan scan, start;
    std::vector<RodContact> before;
  };

  /// A change that revise() would like to make.
  struct Change {
    double urgency = 0;  ///< violation, dimensionless
    std::size_t rod = 0;
    int existing = -1;  ///< contact to change, or -1 for a new one
    bool drop = false;
    RodContact contact;
  };

  static bool touches(const Rod& rod) { return !rod.side->contacts().empty(); }

  double length(const Rod& rod, std::size_t cell) const;
  Vec3 point(const Rod& rod, std::size_t cell, double xi) const;
  Distance distance(const Rod& rod, std::size_t obstacle, std::size_t cell, double xi) const;
  double lowest(const Rod& rod, std::size_t obstacle, std::size_t cell, double& xi) const;
  Vec3 tangent(const Rod& rod, std::size_t cell, double xi) const;
  bool flat(const Rod& rod, std::size_t obstacle, std::size_t cell, double xi) const;
  double moved(const Rod& rod, const Scan& since) const;
  bool far_away(const Rod& rod) const;
  void scan(Rod& rod) const;
  bool held(const Rod& rod, std::size_t node) const;
  bool follow(const Rod& rod, RodContact& contact, const ContactRows& rows) const;
  bool slide(const Rod& rod, RodContact& contact) const;
  bool pulls_most(const Rod& rod, std::size_t contact) const;
  void review(std::size_t rod, std::vector<Change>& changes) const;
  void search(std::size_t rod, std::vector<Change>& changes) const;
  RodContact new_contact(const Rod& rod, std::size_t obstacle, std::size_t cell, double xi) const;
  void apply(const std::vector<Change>& changes);

  Robot& robot_;
  bool friction_ = false;
  std::vector<Rod> rods_;
};

}  // namespace cprsim
