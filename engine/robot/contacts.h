// SPDX-License-Identifier: BSD-3-Clause
// Where rods touch obstacles and each other, and how: the part of contact that is not smooth.
// Between solves of the Newton system it looks where rods have sunk in, drops points that pull, and
// decides between stick and slip (a primal-dual active set method: Hintermüller, Ito, Kunisch, SIAM
// J. Optim. 13, 2002); the forces themselves are unknowns of the rods (engine/rod/contact.h). A
// solve is over when nothing is left to revise.
//
// Points: where a rod touches at a node, or nearest between two nodes, one point a cell. A rod that
// lies on something touches at its nodes, like the quadrature of a line contact.
//
// A step may not carry a rod through anything: no point of a centreline moves, seen from the solid,
// by more than half its distance from it, unless a contact holds it on its side. Planes have no
// other side.
//
// To a rod, another rod is an obstacle like any: the tube around its curved centreline. Of two rods
// the first of the scene looks for the points; its force acts on the other, with its sign changed,
// as an echo among the other's contacts. To itself a rod is an obstacle, too (effect self_contact):
// to the point at arc length s, what lies beyond s + a, a being a few diameters or more than a
// cell, so that each pair of parts is looked at once. A rod that is bent no tighter than twice its
// radius does not come near itself within a.
//
// Ties (engine/robot/ties.h) stand among a rod's contacts, but are nothing that is looked for here.
// Rods that are tied to each other do not touch each other, as links do not that a joint joins.
//
// Bodies touch each other by engine/robot/body_contacts.h, which is part of this.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/robot/body_contacts.h"
#include "engine/robot/robot.h"
#include "engine/run/snapshot.h"

namespace cprsim {

/// Depth that a scene tolerates, over the rod's radius.
constexpr double kContactTolerance = 1e-3;

/// How far a contact may have slid along its rod before it is moved after: of the radius, and as a
/// turn of the normal there.
constexpr double kSlide = 1e-3, kTurn = 1e-5;

class RodContacts {
 public:
  /// Gives the robot's rods what the scene lets them touch. Without the effect: nothing.
  explicit RodContacts(Robot& robot);

  /// Whether anything may touch anything.
  bool any() const { return !rods_.empty() || bodies_.any(); }

  /// After a solve. @param round counts the revisions of this solve: late ones change one point at
  /// a time, so that no cycle goes on. @return whether anything changed and is to be solved again
  bool revise(int round);

  static constexpr int kMostRounds = 100;

  /// For some steps what slips may come to rest within a solve, too: a sequence of sets of sticking
  /// points is gone through by Newton's method itself. @return whether anything slips
  bool ease();

  /// What slips is to stick for the next solve: its rows are as good as linear then. @return
  /// whether anything slipped
  bool hold();

  /// Whether anything touches now.
  bool touching() const;

  /// A step or a static increment begins here. What has sunk is to be put back at once.
  void begin_step();

  /// What has sunk when the step began is put back over the recovery time; so much of the step has
  /// passed where the next solve looks.
  void begin_stage(double since);

  /// From the next step on friction is bounded by what pressed when the step began, and what comes
  /// is smooth: no less dissipative than Coulomb's law, and easier to solve.
  void lag_friction(bool on) { lagged_ = on; }

  /// While friction is bounded: by what presses now. @return whether that is another bound
  bool bound_by_pressure();

  /// After solves with bounded friction: what holds with less than its bound sticks, the rest is
  /// about to slip, by Coulomb's law from here on.
  void grip_what_rests();

  /// What the step asks of contacts, whichever guess they came with.
  void refresh();

  void set_recovery_time(double time) { recovery_ = time; }

  /// Whether points came or went, stuck or slipped since begin_step().
  bool changed() const;

  /// The same, but what gives may come and go: no force jumps to what would stop the rod at once.
  bool struck() const;

  /// Whether something may have passed through an obstacle since begin_step().
  bool leapt() const;

  /// The rod that is inside an obstacle by more than the tolerance, and the obstacle; or nothing.
  std::string overlap();

  ContactSample sample();

  /// What is remembered from step to step, beside what the rods do.
  void visit(Archive& archive);

 private:
  struct Obstacle {
    std::string name;
    Surface surface;  ///< with its pose in the world, or on the body
    double friction = 0;
    double give = 0, lag = 0;  ///< of RodContact, in motion
    bool plane = false;
    int link = -1;  ///< index into Scene::bodies, if one
    int body = -1;  ///< index into Robot::bodies, if on one
    int rod = -1;   ///< index into rods_, if one
    bool itself = false;

    bool fixed() const { return body < 0 && rod < 0; }
  };

  /// What a scan found in a cell: the least distance of the centreline from an obstacle.
  struct Near {
    double distance = 0;
    Vec3 normal = Vec3::Zero();  ///< zero: far away, the distance is a lower bound
    std::size_t foot = 0;        ///< cell of the other rod; the number of its cells: somewhere
  };

  struct Scan {
    long number = 0;  ///< how many there were before
    std::vector<Vec3> nodes;
    std::vector<Near> near;                 ///< cells × obstacles
    std::vector<Pose> bodies;               ///< of each obstacle on one
    std::vector<std::vector<Vec3>> others;  ///< nodes of each obstacle that is a rod
    double clearance = 0;                   ///< nothing is nearer, m
  };

  /// A contact that was moved to where its rod was nearest, positions in cells: it had been off by
  /// `by`.
  struct Slide {
    int surface = -1;
    double from = 0, by = 0, to = 0;
  };

  /// The nearest point of a rod's centreline; infinitely far where there is none.
  struct Foot {
    std::size_t cell = 0;
    double xi = 0;
    Distance at;  ///< from the rod's surface
  };

  struct Rod {
    RobotRod* rod = nullptr;
    std::size_t index = 0;  ///< in Robot::rods
    TouchingRod* side = nullptr;
    double radius = 0;
    bool touches_others = false, touches_itself = false;
    double apart = 0;  ///< a, m
    std::vector<Obstacle> obstacles;
    Scan scan, start;
    std::vector<NodeState> begun;  ///< nodes when the step began
    std::vector<RodContact> before;
    std::vector<Slide> slides;  ///< of the present solve
    /// Of the present solve: contacts, positions in cells, from which what is nearest goes back and
    /// forth, and that therefore stay.
    std::vector<std::pair<int, double>> valleys;
  };

  /// A change that revise() would like to make.
  struct Change {
    double urgency = 0;  ///< violation, dimensionless
    std::size_t rod = 0;
    int existing = -1;  ///< contact to change, or -1 for a new one
    bool drop = false;
    RodContact contact;
  };

  static bool changed(const Rod& rod, bool soft_too);

  static bool touches(const Rod& rod);

  static const Near& near(const Scan& scan, const Rod& rod, std::size_t cell,
                          std::size_t obstacle) {
    return scan.near[cell * rod.obstacles.size() + obstacle];
  }

  void add_colliders(Rod& rod);
  const MeshDistance* mesh_of(const ShapeSpec& shape);
  void add_other_rods();
  void add_rods_themselves();
  void give_surfaces(Rod& rod);
  Foot foot(const Rod& other, const std::vector<NodeState>& nodes, const Vec3& x,
            double from) const;
  Foot foot(const Rod& rod, const Obstacle& obstacle, std::size_t cell, double xi) const;
  double beyond(const Rod& rod, const Obstacle& obstacle, std::size_t cell, double xi) const;
  double passed(const Rod& rod, const Scan& since, std::size_t obstacle, std::size_t cell) const;
  void set_terms(const Rod& rod, RodContact& contact) const;
  bool place_foot(const Rod& rod, RodContact& contact) const;
  double sunk(const Rod& rod, const RodContact& contact) const;

  void soften(const SurfaceSpec& a, const SurfaceSpec& b, Obstacle& obstacle) const;
  bool comes_nearer(const Rod& rod, const RodContact& contact, double d) const;
  double begun_distance(const Rod& rod, const RodContact& contact) const;
  ContactPair pair_of(const Rod& rod, const Obstacle& obstacle) const;
  PairDistance measure(const ContactPair& pair) const;

  double length(const Rod& rod, std::size_t cell) const;
  Vec3 point(const Rod& rod, std::size_t cell, double xi) const;
  Vec3 point(const Rod& rod, const std::vector<NodeState>& nodes, std::size_t cell,
             double xi) const;
  Distance distance(const Rod& rod, std::size_t obstacle, std::size_t cell, double xi) const;
  double lowest(const Rod& rod, std::size_t obstacle, std::size_t cell, double& xi) const;
  Vec3 tangent(const Rod& rod, std::size_t cell, double xi) const;
  double sagitta(const Rod& rod, std::size_t obstacle, std::size_t cell, double xi) const;
  bool flat(const Rod& rod, std::size_t obstacle, std::size_t cell, double xi) const;
  double moved(const Rod& rod, const Scan& since) const;
  bool far_away(const Rod& rod) const;
  void scan(Rod& rod) const;
  bool held(const Rod& rod, std::size_t node) const;
  bool follow(Rod& rod, RodContact& contact, const ContactRows& rows, bool slides) const;
  bool slide(Rod& rod, RodContact& contact) const;
  bool brackets(Rod& rod, const RodContact& contact, double by) const;
  void leap(Rod& rod, const RodContact& contact, double by, std::size_t& cell, double& xi) const;
  bool pulls_most(const Rod& rod, std::size_t contact) const;
  void review(std::size_t rod, std::vector<Change>& changes) const;
  void search(std::size_t rod, std::vector<Change>& changes, bool late) const;
  RodContact new_contact(const Rod& rod, std::size_t obstacle, std::size_t cell, double xi) const;
  void apply(const std::vector<Change>& changes);

  Robot& robot_;
  std::vector<std::unique_ptr<MeshDistance>>
      meshes_;  ///< of the scene's, those that something may touch
  BodyContacts bodies_;
  std::vector<int> index_;  ///< Robot::rods → rods_
  bool friction_ = false, lagged_ = false;
  bool rates_ = false;   ///< in a step of a dynamic run
  int eased_ = 0;        ///< steps for which ease() still holds
  double recovery_ = 0;  ///< time in which depth falls to 1 / e, s
  double left_ = 0;      ///< share of the depth at the step's begin that is left to it now
  std::vector<Rod> rods_;
};

}  // namespace cprsim
