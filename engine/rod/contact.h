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
// Which points touch, and which of (3) to (5) holds, is decided between solves
// (engine/robot/contacts.h). L, F are the rod's scales, U is L times the rate of the scheme.
#pragma once

#include <vector>

#include "engine/model/distance.h"
#include "engine/rod/cell.h"
#include "engine/rod/rod_end.h"

namespace cprsim {

enum class Grip { kSmooth, kStick, kSlip };

/// A solid at rest that a rod may touch.
struct Surface {
  const ShapeSpec* shape = nullptr;
  Pose X_WC;
};

struct RodContact {
  int surface = -1;  ///< index into the rod's surfaces
  std::size_t cell = 0;
  double xi = 0;
  Grip grip = Grip::kSmooth;
  double friction = 0;        ///< mu
  double kappa = 1;           ///< weighs u in (6)
  Vec3 lever = Vec3::Zero();  ///< l, as it was when the point was chosen
  Vec3 axis = Vec3::UnitZ();  ///< a, likewise
  Vec3 held = Vec3::Zero();   ///< f_0
  Vec3 force = Vec3::Zero();  ///< f: on the rod, world axes

  bool at_node() const { return xi == 0; }

  /// The node at which everything the rows need is known.
  std::size_t closing_node() const { return at_node() ? cell : cell + 1; }
};

/// Motion of a cell's end; v by dp is v_by_p, w by phi is w_by_phi.
struct ContactNode {
  Vec3 p, t, v, w;
  double v_by_p = 0;
  Mat3 w_by_phi = Mat3::Zero();
};

/// Weights of (1) and (2).
struct ContactWeights {
  double H[2], G[2], S[2];

  explicit ContactWeights(double xi);
};

struct ContactScale {
  double length = 1, force = 1, rate = 1;  ///< L, F, U
  double axial_compliance = 0;             ///< C
};

struct ContactRows {
  Vec3 value;
  Mat3 by_p[2], by_phi[2], by_force;
  Distance at;  ///< of the centreline
  Vec3 slip;    ///< u
};

/// Position (1) in a cell of length h.
Vec3 contact_point(double xi, double h, const ContactNode ends[2]);

/// (3) to (6). At a node only ends[0] is read.
ContactRows contact_rows(const RodContact& contact, const Surface& surface, double radius, double h,
                         const ContactNode ends[2], const ContactScale& scale);

/// What a rod lends to whoever looks for contacts.
class TouchingRod {
 public:
  virtual ~TouchingRod() = default;

  /// Grid nodes as last evaluated; s / L of each.
  virtual const std::vector<NodeState>& contact_nodes() const = 0;
  virtual const std::vector<double>& contact_grid() const = 0;

  /// What it may touch; the surfaces outlive the rod.
  virtual void set_surfaces(const std::vector<Surface>& surfaces, double radius, bool friction) = 0;

  /// Where it touches now, base to tip, one point at a node or in a cell. May be changed between
  /// solves.
  virtual std::vector<RodContact>& contacts() = 0;

  /// Rows at the last evaluation, in the order of contacts().
  virtual const std::vector<ContactRows>& contact_state() const = 0;

  /// Without rates slip counts from here.
  virtual void accept_contacts() = 0;
};

}  // namespace cprsim
