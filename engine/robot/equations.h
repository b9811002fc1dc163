// SPDX-License-Identifier: BSD-3-Clause
// F(x) = 0 at one instant, for the whole robot: who owns which unknown and row, and how rows are
// scaled.
//
//   unknowns                                   rows
//   body b: (phi, dp) of its centre of mass    Newton-Euler (moment, force)
//   joint j: lambda (6), q where unknown       closure (6), effort
//   contact c between what moves: force (3)    engine/robot/contact_pair.h, body_contact.h
//   rod r: its own                             its own; condensed to z (6) with T z + ... = 0 and
//   the wrenches on
//                                              its bodies (engine/rod/rod_model.h)
// In a planar scene each six is three: the turn about the normal and the translations along e1, e2,
// the balances of these, and what a joint holds of them. Bodies and joints are computed in space;
// the rest is dropped before the system is factored.
// Rods are condensed one by one, never assembled: the global system has six unknowns a body, plus
// joints. A rod whose T is singular hands its z up to the global system (a delayed pivot).
#pragma once

#include <Eigen/LU>
#include <string>
#include <vector>

#include "engine/robot/contact_pair.h"
#include "engine/robot/robot.h"
#include "engine/solve/problem.h"

namespace cprsim {

/// All unknowns of the robot by value: to retry, restart, extrapolate.
struct RobotUnknowns {
  std::vector<RodModel::Unknowns> rods;
  std::vector<Pose> bodies;
  std::vector<Vec3> joint_q;
  std::vector<Vec6> joint_lambda;
  std::vector<BodyContact> body_contacts;
};

void visit(RobotUnknowns& u, Archive& archive);

/// Whether one may be set where the other was found: as many of everything.
bool alike(const RobotUnknowns& a, const RobotUnknowns& b);

class Equations final : public Problem {
 public:
  Equations(Robot& robot, double tolerance);
  ~Equations() override;

  /// Sets drives, loads and time coefficients for the solves that follow. `before`: left limits at
  /// jumps.
  void set_instant(double t, bool before, const StageRates& rates);

  /// Quasi-statics: the present state is the equilibrium at t. Joints driven by velocity go on from
  /// here, friction holds on to where it has slipped to.
  void accept_equilibrium(double t);

  /// Quasi-statics with friction: slip counts from the present state.
  void accept_contacts();

  /// Without loads, gravity and effort drives: only assembly.
  void set_loads(bool on) { loads_on_ = on; }

  bool loads_on() const { return loads_on_; }

  /// Bodies stay where they are (rods find their shape between them).
  void hold_bodies(bool hold) { bodies_held_ = hold; }

  RobotUnknowns unknowns() const;
  void set_unknowns(const RobotUnknowns& u);
  /// Weighted sum of past unknowns as the next guess; weights sum to 1.
  void predict(const std::vector<const RobotUnknowns*>& past, const std::vector<double>& weights);

  /// Of all rods, bodies and joints, with what the equations themselves remember.
  void visit(Archive& archive);

  /// @throws StateError for contacts, read from a file, that cannot be this robot's
  void expect_contacts(const RobotUnknowns& unknowns) const;

  /// restart() returns to the unknowns at this call.
  void mark_start() { start_ = unknowns(); }

  ProblemResidual evaluate() override;
  bool find_direction(double mu) override;

  double predicted_merit() const override { return predicted_merit_; }

  void keep() override;
  void move(double alpha) override;

  void mark() override { mark_ = unknowns(); }

  void return_to_mark() override { set_unknowns(mark_); }

  void remember() override { remembered_ = unknowns(); }

  void recall() override { set_unknowns(remembered_); }

  /// How much heavier the limpest rod is than what its bending stiffness bears; 1 and more.
  double limpness() const;

  void set_fraction(double fraction) override;
  void set_relaxation(double drag) override;
  /// The same towards what was last marked.
  void hold_marked(double drag);
  /// Lets rods stretch as easily as they bend. Legs of unequal length that start straight would
  /// otherwise carry axial forces hundreds of times their buckling load after the first Newton
  /// step.
  void set_softness(double softness) override;
  bool wants_soft_start() const override;
  /// Rods longer than the distance of their ends start bowed, out of the symmetry of a straight
  /// column.
  void break_symmetry() override;
  void restart() override;
  /// Rods, between bodies that stay where they are.
  std::vector<std::unique_ptr<Problem>> take_apart() override;
  void put_together() override;
  std::string worst_row() const override;

  double growth() const override { return growth_; }

  long section_evaluations() const override;

  long factorizations() const override { return factorizations_; }

  long work() const override;

  /// Increment of a body in the last direction found.
  Vec6 body_direction(int body) const;

  /// Makes the rods' directions the motion that follows from the given body motions, rods in
  /// equilibrium.
  bool follow_bodies(const std::vector<Vec6>& motions);

  const StageRates& rates() const { return rates_; }

  double time() const { return t_; }

  int unknown_count() const;

  int body_unknowns() const { return body_unknowns_; }

  int constraint_count() const { return size_ - body_unknowns_; }

  /// Wrench of contacts on a body about its centre of mass, at the last evaluation.
  Vec6 contact_wrench(int body) const;

 private:
  struct Worst {
    enum class Kind { kRod, kBody, kJoint, kContact, kBodyContact } kind = Kind::kRod;
    int index = 0, row = 0;
  };

  void prepare_rods();

  /// A contact with rows here: entry `contact` of a rod, what the other side is stands there.
  struct Pair {
    std::size_t rod = 0, contact = 0;
    PairRows rows;
    Vec3 arm = Vec3::Zero();  ///< from the body's centre of mass to the rod's surface
    int offset = -1;          ///< of the force's unknowns
  };

  void note_bodies();

  /// Bodies in flight stand still in statics: nothing holds them.
  bool stands_still(std::size_t body) const { return flies_[body] && !rates_.dynamic(); }

  bool is_tie(const Pair& pair) const;
  void find_pairs();
  void evaluate_pairs(ProblemResidual& r);
  int number_pairs(int offset);
  int number_body_contacts(int offset);
  void evaluate_body_contacts(ProblemResidual& r);
  void assemble_body_contacts();
  void body_contact_units(VecX& columns) const;
  std::string body_contact_name(std::size_t contact) const;
  void assemble_pairs();
  void hold_still_bodies();
  void assemble_open_forces(std::size_t rod);
  void pair_units(VecX& columns) const;
  Vec6 distribute_forces(std::size_t rod);
  const OpenPorts* open_ports(std::size_t rod) const;
  std::string pair_name(const Pair& pair) const;

  double acting() const { return loads_on_ ? fraction_ : 0; }

  PointLoad scaled_load(const LoadSpec& load) const;
  Vec6 body_rows(std::size_t b);
  void evaluate_rods(ProblemResidual& r);
  void evaluate_bodies(ProblemResidual& r);
  void evaluate_joints(ProblemResidual& r);
  void add_rod_wrenches();
  void add_joint_wrenches();
  void drive_joint(const JointDrive& drive);
  void add_body_loads();
  void note(double value, Worst where, ProblemResidual& r);
  void note_rows(const Mat3& axes, const Vec6& rows, Worst where, ProblemResidual& r);

  Pose body_pose(int body) const { return robot_.body_pose(body); }

  int unknowns_of(const Joint& joint) const { return joint.unknowns() - 6 + freedoms_; }

  /// The part of a motion or wrench that the plane leaves; all of it in space (N = 6).
  template <int N>
  Eigen::Matrix<double, N, 1> kept(const Vec6& v) const;
  template <int N>
  Eigen::Matrix<double, N, N> kept(const Mat6& M) const;
  Vec6 in_space(const double* part) const;
  Vec6 left_by_plane(const Vec6& v) const;
  void set_plane();

  bool condense_rods(bool keep_all);
  template <int N>
  bool condense(bool keep_all);
  void assemble();
  template <int N>
  void assemble_parts();
  template <int N>
  void assemble_rod(std::size_t r);
  template <int N>
  void assemble_bodies();
  template <int N>
  void assemble_joints();
  template <int N>
  void distribute_to_rods();
  bool solve_system(double mu);
  bool solve(double mu);
  bool solve_least_motion(const VecX& columns);
  void distribute();
  double force_unit(int body) const;
  VecX column_units() const;
  VecX row_units() const;

  Robot& robot_;
  double tolerance_;
  double t_ = 0;
  bool before_ = false;
  double equilibrium_time_ = 0;  ///< of the last accepted one
  StageRates rates_;
  double fraction_ = 1, drag_ = 0, softness_ = 0;
  bool bodies_held_ = false;
  bool gaps_captured_ = false;
  bool loops_ = false;  ///< joints form closed loops
  bool loads_on_ = true;

  // residual side
  std::vector<Vec6> wrench_;        ///< on each body
  std::vector<Mat6> body_tangent_;  ///< of loads and weight minus inertia
  std::vector<Vec6> joint_gap_;
  std::vector<Vec3> tie_gap_;  ///< of the ties among pairs_, in their order
  std::vector<Pose> marked_;
  std::vector<Pair> pairs_;
  std::vector<BodyContactRows> touches_;  ///< of Robot::body_contacts
  int first_touch_ = 0;                   ///< where the unknowns of their forces begin
  std::vector<char> flies_;               ///< bodies that nothing holds
  std::vector<Pose> slip_from_;           ///< bodies, where slip counts from without rates
  Worst worst_;
  double worst_size_ = 0;

  // linear side
  std::vector<CondensedRod> condensed_;

  struct Elimination {
    bool delayed = false;
    int offset = -1;  ///< of z in the global system when delayed
    Mat6 z_A, z_B;    ///< z = z_A zeta_A + z_B zeta_B + z0; the leading blocks in a plane
    Vec6 z0;
    Eigen::Matrix<double, 6, Eigen::Dynamic> z_F;  ///< of forces of shared contacts
    std::vector<int> forces;                       ///< their unknowns
    std::vector<double> signs;
  };

  struct RodTerms;
  void add_rod_terms(int row, std::size_t rod, const RodTerms& terms);

  std::vector<Elimination> eliminations_;
  int freedoms_ = 6;                      ///< of a body
  Eigen::Matrix<double, 6, 3> in_plane_;  ///< motions about the normal, along e1, along e2
  int body_unknowns_ = 0, size_ = 0;
  std::vector<int> joint_offset_;
  MatX J_;
  VecX r_, x_;
  double predicted_merit_ = 0;
  double growth_ = 0;
  long factorizations_ = 0;
  long work_alone_ = 0;  ///< in eliminating rods by themselves

  // kept
  RobotUnknowns kept_, start_, mark_, remembered_;
};

}  // namespace cprsim
