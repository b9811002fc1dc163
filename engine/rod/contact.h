// SPDX-License-Identifier: BSD-3-Clause
// A rod that touches something: a point of its centreline, a force there, and the three rows that
// determine the force. The point lies in cell k at the fraction xi, on the Hermite curve through
// the cell's ends a = 0, 1 (t = R e_3, h the cell's length):
//   x = sum_a H_a p_a + h G_a t_a                                                        (1)
// What does the same virtual work acts on the ends: the force H_a f and the moment
//   h G_a t_a × f + S_a l × f,   S_0 = 1 - xi, S_1 = xi, l = -r n                        (2)
// For a bent Euler-Bernoulli cell (2) is exact: its ends move as if f acted at xi. A contact at a
// node is xi = 0. With the distance d(x) of the centreline to the solid, n = dd/dx, the slip rate u
// of the rod's surface over the solid's, and P = I - n n^T, the rows are
//   n (d - r) / L + P f / F = 0                                          smooth          (3)
//   n (d - r) / L + P u / U = 0                                          stick           (4)
//   n (d - r) / L + P f / F - mu (n.f) / F  tau / |tau| = 0              slip            (5)
//   tau = P (f / F - kappa u / U),  u = sum_a H_a v_a + h G_a w_a × t_a + S_a w_a × l    (6)
// (5) is Coulomb's law by return mapping (Alart & Curnier, Comput. Methods Appl. Mech. Eng. 92,
// 1991). There is no penalty: the force is an unknown, its rows hold to the solver's tolerance.
// How sticking points share their axial friction is open where the rod cannot stretch; (4) then has
// a a^T (f - f_0) C / L besides: a the tangent, f_0 the force when the step began, C the compliance
// that a cell would have. Nothing creeps, since f_0 follows f.
// What is sunk when a time step begins is given time to come back: for d - r in (3) to (5) read
// d - r - e, e being the depth that is left to it. Put back at once it would be thrown.
// What is not rigid but gives, with the normal force k_p depth + k_d depth rate as in SDF, has in
// (3) to (5) in the place of d - r - e
//   d - r + (n.f + k_d n.u) / k_p                                                          (7)
// A tie holds points beside two rods together, on arms that turn with their sections: of its rod
// l = R arm, of the other l_2 = R_2 arm_2, and the rows are
//   (x + l - x_2 - l_2) / L = 0                                                          (8)
// It is always at a node, and nothing between solves changes it.
// Which points touch, and which of (3) to (5) holds, is decided between solves
// (engine/robot/contacts.h). L, F are the rod's scales, U is L times the rate of the scheme.
#pragma once

#include <vector>

#include "engine/math/archive.h"
#include "engine/model/distance.h"
#include "engine/model/mesh_distance.h"
#include "engine/rod/cell.h"
#include "engine/rod/rod_end.h"

namespace cprsim {

enum class Grip { kSmooth, kStick, kSlip, kTie };

/// Whose unknown the force is: the rod's own, where what it touches stands still and its method
/// can; the robot's, where that moves by unknowns too (engine/robot/contact_pair.h); or what
/// another rod's contact with this one leaves here, the force with its sign changed.
enum class ContactRole { kOwn, kShared, kEcho };

/// A solid that a rod may touch.
struct Surface {
  const ShapeSpec* shape = nullptr;
  Pose X_WC;                           ///< in the world, or on the body that carries it
  const MeshDistance* mesh = nullptr;  ///< if the shape is one
};

/// Of a point x of the world from a surface whose frame is at X_WC there.
Distance distance_to(const Surface& surface, const Pose& X_WC, const Vec3& x);

struct RodContact {
  int surface = -1;  ///< index into the rod's surfaces
  std::size_t cell = 0;
  double xi = 0;
  Grip grip = Grip::kSmooth;
  double friction = 0;        ///< mu
  bool may_rest = false;      ///< while it is said to slip: |tau| < mu (n.f) / F in (5) is stick
  double bound = -1;          ///< of friction, N; below 0: mu times the pressure
  double sunk = 0;            ///< e, not above 0, m
  double give = 0;            ///< 1 / k_p of (7), m/N; 0: rigid
  double lag = 0;             ///< k_d / k_p of (7), s; 0 without rates
  double kappa = 1;           ///< weighs u in (6)
  Vec3 lever = Vec3::Zero();  ///< l, as it was when the point was chosen
  Vec3 axis = Vec3::UnitZ();  ///< a, likewise
  Vec3 arm = Vec3::Zero();    ///< of a tie, section axes
  Vec3 held = Vec3::Zero();   ///< f_0
  Vec3 force = Vec3::Zero();  ///< f: on the rod, world axes

  ContactRole role = ContactRole::kOwn;
  int body = -1;       ///< that carries the surface, if shared with one
  int other_rod = -1;  ///< touched, or whose echo it is: index into Robot::rods
  int partner = -1;    ///< the other rod's entry
  std::size_t other_cell = 0;
  double other_xi = 0;
  Vec3 other_lever = Vec3::Zero();  ///< from the other centreline to its surface

  /// Largest friction under a pressure.
  double most_friction(double pressure) const { return bound < 0 ? friction * pressure : bound; }

  bool at_node() const { return xi == 0; }

  /// Neither an echo nor a tie, but a point that was found to touch and may come and go.
  bool found() const { return role != ContactRole::kEcho && grip != Grip::kTie; }

  /// l at an end whose axes are R.
  Vec3 lever_at(const Mat3& R) const { return grip == Grip::kTie ? Vec3(R * arm) : lever; }

  /// The node at which everything the rows need is known.
  std::size_t closing_node() const { return at_node() ? cell : cell + 1; }
};

/// Motion of a cell's end; v by dp is v_by_p, w by phi is w_by_phi.
struct ContactNode {
  Vec3 p, t, v, w;
  Mat3 R = Mat3::Identity();
  double v_by_p = 0;
  Mat3 w_by_phi = Mat3::Zero();
};

/// Weights of (1) and (2).
struct ContactWeights {
  double H[2], G[2], S[2];

  explicit ContactWeights(double xi);
};

/// The ends of a contact's cell, of length h; at a node only the first.
struct ContactEnds {
  ContactNode node[2];
  double h = 0;
};

struct ContactScale {
  double length = 1, force = 1, rate = 1;  ///< L, F, U
  double axial_compliance = 0;             ///< C
};

/// Contacts as a solve leaves them. @throws StateError for more than a rod can have
void visit(std::vector<RodContact>& contacts, Archive& archive);

struct ContactRows {
  Vec3 value;
  Mat3 by_p[2], by_phi[2], by_force;
  Distance at;  ///< of the centreline
  Vec3 slip;    ///< u
};

/// What observers see of them.
void visit(std::vector<ContactRows>& rows, Archive& archive);

/// (3) to (5) for a gap d - r - e, a normal and a slip rate.
struct GripRows {
  Vec3 value = Vec3::Zero(), by_gap = Vec3::Zero();
  Mat3 by_n = Mat3::Zero(), by_u = Mat3::Zero(), by_force = Mat3::Zero();
};

GripRows grip_rows(const RodContact& contact, double gap, const Vec3& n, const Vec3& u,
                   const ContactScale& scale);

/// What friction, and what the damper of (7), take out, W.
double contact_loss(const RodContact& contact, const ContactRows& rows);

/// u of (6) for a point at xi with the lever l.
Vec3 contact_velocity(double xi, const Vec3& l, const ContactEnds& ends);

/// Derivatives by the ends' (phi, dp) of what has those by x and by u of (6).
void carry_to_ends(double xi, const Vec3& l, const ContactEnds& ends, const Mat3& by_x,
                   const Mat3& by_u, Mat3 by_phi[2], Mat3 by_p[2]);

/// Position (1) in a cell of length h.
Vec3 contact_point(double xi, double h, const ContactNode ends[2]);

/// (3) to (6). At a node only ends[0] is read.
ContactRows contact_rows(const RodContact& contact, const Surface& surface, double radius,
                         const ContactEnds& ends, const ContactScale& scale);

/// Linearised motion of the ends of shared contacts' cells and what their forces F do to the rod,
/// to be read with CondensedRod: T z + ... + T_F F, W_A = ... + WA_F F, W_B = ... + WB_F F. F are
/// the increments of the forces of shared contacts and echoes in their order.
struct OpenPorts {
  /// (phi_0, dp_0, phi_1, dp_1) = by_z z + by_A zeta_A + by_F F + value
  struct Motion {
    Eigen::Matrix<double, 12, 6> by_z, by_A;
    Eigen::Matrix<double, 12, Eigen::Dynamic> by_F;
    Vec12 value;
  };

  Eigen::Matrix<double, 6, Eigen::Dynamic> T_F, WA_F, WB_F;
  std::vector<std::size_t> contacts;  ///< index into TouchingRod::contacts() of each force
  std::vector<Motion> motions;
};

/// What a rod lends to whoever looks for contacts.
class TouchingRod {
 public:
  virtual ~TouchingRod() = default;

  /// Grid nodes as last evaluated; s / L of each.
  virtual const std::vector<NodeState>& contact_nodes() const = 0;
  virtual const std::vector<double>& contact_grid() const = 0;

  /// What it may touch; the surfaces outlive the rod.
  virtual void set_surfaces(const std::vector<Surface>& surfaces, double radius, bool friction) = 0;

  virtual const std::vector<Surface>& surfaces() const = 0;

  /// Whether set_surfaces() was called: nothing below may be asked of it otherwise.
  virtual bool may_touch() const = 0;

  /// Whether forces from what stands still are its own unknowns; otherwise they are the robot's, as
  /// all others.
  virtual bool owns_forces() const { return true; }

  /// Where it touches now, base to tip, one point at a node or in a cell. May be changed between
  /// solves.
  virtual std::vector<RodContact>& contacts() = 0;

  /// Rows at the last evaluation, in the order of contacts().
  virtual std::vector<ContactRows>& contact_state() = 0;

  /// For contacts whose rows are formed elsewhere, at the last evaluation.
  virtual ContactEnds contact_ends(std::size_t contact) const = 0;
  virtual ContactScale contact_scale() const = 0;

  /// As of the last linearisation.
  virtual const OpenPorts& open_ports() const = 0;

  /// Increments of the forces in the order of open_ports(), before RodModel::set_direction().
  virtual void set_open_direction(const VecX& forces) = 0;

  /// Without rates slip counts from here.
  virtual void accept_contacts() = 0;
};

}  // namespace cprsim
