// SPDX-License-Identifier: BSD-3-Clause
// Time schemes as algebra. Whatever the scheme, during one implicit solve
//   x_t = c_v x + x_h          v_t = c_w v + v_h (1)
// with v = x_t for positions and strains, and v = J_r(x) x_t (body angular velocity) for rotation
// vectors x measured from the start of the step. Statics is c_v = c_w = 0. A scheme is the rule
// that fills x_h, v_h.
//
// Tables: backward Euler; BDF2 and BDF-alpha (Till, Aloi, Rucker, IJRR 2019, eq. 12), here with
// variable step: the derivative of the parabola through the last three values, taken at t_n + alpha
// h, equals (1 + alpha) x_t,n - alpha x_t,n-1; Lie-group generalised-alpha (Brüls & Cardona, J.
// Comput. Nonlinear Dyn. 2010); diagonally implicit Runge-Kutta: TR-BDF2, ESDIRK3(2)4L[2]SA and
// ESDIRK4(3)6L[2]SA (Kennedy & Carpenter, NASA/TM- 2016-219173), and as the starter after a jump
// the stiffly accurate SDIRK3 with the same diagonal as ESDIRK3(2) (Alexander, SINUM 14, 1977),
// which needs no derivative at the start.
//
// Radau IIA of order 5 (Hairer & Wanner, Solving ODEs II, table IV.5.6) has a full table A. Its
// three stages are found one after another, again and again, with the lower factor L of Crout's A =
// L U in the place of A (van der Houwen & de Swart, SIAM J. Sci. Comput. 18, 1997): in round k
//   x_i = x_0 + h sum_j A_ij k_j^(k-1) + h sum_(j <= i) L_ij (k_j^(k) - k_j^(k-1))        (2)
// until nothing changes. Every solve is of the form (1), and what is found is Radau's own.
#pragma once

#include <vector>

#include "engine/math/archive.h"
#include "engine/math/types.h"
#include "engine/model/solver_spec.h"

namespace cprsim {

/// Coefficients of (1) for the current solve.
struct StageRates {
  double c_v = 0, c_w = 0;
  bool body_rates = true;  ///< rotations: v = J_r(x) x_t (false for generalised-alpha: v = x_t)

  bool dynamic() const { return c_v != 0; }

  void visit(Archive& archive) {
    archive(c_v);
    archive(c_w);
    archive(body_rates);
  }
};

/// A diagonally implicit Runge-Kutta table, stiffly accurate (b = last row of a).
struct DirkTable {
  int stages = 0;
  int order = 0, embedded_order = 0;
  bool explicit_first = false;
  double diagonal = 0;
  double a[6][6] = {};
  double c[6] = {};
  double b_error[6] = {};  ///< b - b_embedded
  const char* name = "";
};

const DirkTable& tr_bdf2();
const DirkTable& esdirk32();
const DirkTable& esdirk43();
const DirkTable& sdirk3();

/// A of Radau IIA, order 5, and its lower Crout factor.
struct RadauTable {
  double a[3][3] = {}, lower[3][3] = {};
  double c[3] = {};
};

const RadauTable& radau5();

/// A bundle of coordinates that a scheme integrates: values and what past steps left behind. The
/// owner of the coordinates fills x after each solve (and v for rotations), the Stepper the rest.
struct Track {
  enum class Kind { kLinear, kRotation };

  explicit Track(Kind kind_of = Kind::kLinear) : kind(kind_of) {}

  Kind kind;
  VecX x, x_t, v, a;      ///< at the current stage
  VecX x_h, v_h;          ///< affine parts of (1) for the current solve
  VecX x0, x_t0, v0, a0;  ///< at the start of the step
  VecX x1, v1;            ///< one step earlier (linear: values; rotation: vector from x0's frame)
  VecX A0, A;             ///< generalised-alpha's auxiliary acceleration
  std::vector<VecX> k_x, k_v;  ///< stage derivatives

  void resize(Eigen::Index n);
  /// Sets the state at the start of the first step.
  void set_start(const VecX& x_start, const VecX& v_start);
  /// Without what begin_step() and the stages compute anew.
  void visit(Archive& archive);
};

struct SchemeChoice {
  SchemeKind kind = SchemeKind::kEsdirk32;
  double alpha = -0.4;   ///< bdf_alpha
  double rho_inf = 0.8;  ///< generalized_alpha
};

/// Drives all tracks of a robot through one step after another.
class Stepper {
 public:
  explicit Stepper(const SchemeChoice& choice) : choice_(choice) {}

  /// Forgets derivatives: the next step uses the starter. Called at start and at every jump.
  void reset() { fresh_ = true; }

  /// Steps that follow are backward Euler's, until told otherwise: its velocities follow from
  /// positions alone, so that an impact cannot add energy.
  void cushion(bool on) { cushioned_ = on; }

  /// Prepares a step. @return the number of implicit solves it takes; of Radau, the most.
  int begin_step(double h, const std::vector<Track*>& tracks);

  /// Time of solve i within the step, as a fraction of h.
  double stage_time(int i) const;

  /// Fills x_h, v_h of all tracks for solve i; gives the coefficients.
  StageRates begin_stage(int i, const std::vector<Track*>& tracks);

  /// After x (and for rotations v) is known: x_t, v, a of the stage.
  void finish_stage(int i, const std::vector<Track*>& tracks);

  /// Of a scheme whose stages are found in rounds: how many solves a round has; otherwise 0.
  int round() const { return rounds() ? 3 : 0; }

  /// After a round: by how much it changed the stage derivatives of a track, times h in x and h² in
  /// v.
  double change(const Track& track, Eigen::Index coordinates) const;

  /// Estimated local error of the step in x (and h times that in v) of a track; 0 without an
  /// embedded formula.
  VecX position_error(const Track& track) const;
  VecX velocity_error(const Track& track) const;

  bool has_error_estimate() const { return table_ != nullptr; }

  int error_order() const { return table_ ? table_->embedded_order + 1 : 3; }

  /// Integral over the step, per h, of a quantity known at its start and at every solve: with the
  /// table's weights, or by the trapezoid.
  double integrate(const std::vector<double>& values) const;

  void accept(const std::vector<Track*>& tracks);

  /// The scheme that the current step really uses ("sdirk3" for a starter).
  const char* step_name() const;

  void visit(Archive& archive);

 private:
  struct Multistep {
    double c0 = 0, c1 = 0, c2 = 0, d1 = 0;
  };

  Multistep multistep_coefficients() const;
  void begin_dirk_stage(int i, Track& t) const;
  void begin_radau_stage(int i, Track& t) const;

  bool rounds() const { return kind() == SchemeKind::kRadau5; }

  SchemeKind kind() const { return cushioned_ ? SchemeKind::kBackwardEuler : choice_.kind; }

  SchemeChoice choice_;
  const DirkTable* table_ =
      nullptr;  ///< table of the current step, null for multistep and generalised-alpha
  bool fresh_ = true;
  bool cushioned_ = false;
  double h_ = 0, h_last_ = 0;
  StageRates rates_;
};

const char* to_string(SchemeKind kind);

}  // namespace cprsim
