// SPDX-License-Identifier: BSD-3-Clause
// The contract every discretisation of a rod fulfils: a rod with unknowns of its own is linearised,
// its unknowns are eliminated stably, and what remains is a mixed two-port, exact at the current
// state:
//
//   T z + T_A zeta_A + T_B zeta_B + t = 0                       six rows on six remaining unknowns
//   z          (1) W_A = WA_z z + WA_A zeta_A + wa      wrench on the base's body, about its
//   reference point                  (2) W_B = WB_z z + WB_A zeta_A + WB_B zeta_B + wb    on the
//   tip's body                                         (3)
//
// zeta = (phi, dp): increment of a body's rotation and reference point, world axes; wrenches
// (moment, force), world axes. Where T is regular z follows at once and (2), (3) become the 12 × 12
// stiffness two-port; where it is not (a straight inextensible rod transmits any axial force) z
// joins the global unknowns, so that nothing is ever divided by a stiffness that does not exist.
// Statics, all time schemes and the whole robot see nothing else of a rod.
#pragma once

#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/solver_spec.h"
#include "engine/rod/contact.h"
#include "engine/rod/field.h"
#include "engine/rod/rod_curve.h"
#include "engine/rod/rod_end.h"
#include "engine/rod/shape.h"
#include "engine/section/magnetic_sources.h"
#include "engine/section/outer_field.h"
#include "engine/section/section.h"
#include "engine/time/scheme.h"

namespace cprsim {

/// A planar rod fills the leading 3 × 3 blocks and threes only, in the plane's axes
/// (engine/rod/planar.h).
struct CondensedRod {
  Mat6 T, T_A, T_B;
  Vec6 t;
  Mat6 WA_z, WA_A;
  Vec6 wa;
  Mat6 WB_z, WB_A, WB_B;
  Vec6 wb;
  double growth = 0;  ///< largest segment transition norm
};

/// A concentrated wrench on the rod, world axes or (follower) section axes.
struct PointLoad {
  double s = 0;  ///< fraction of the length
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  bool follower = false;
};

/// Spread evenly over a part of the rod, per length: world axes or (follower) section axes.
struct LineLoad {
  double from = 0, to = 1;  ///< fractions of the length; nodes of the grid are there
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< N/m, N
  bool follower = false;
  PlacedForce law;  ///< instead of force and torque, where it has a law
};

/// What a tendon's motor prescribes: a tension (N), or how much it has pulled in (m).
struct TendonPull {
  double value = 0;
  bool displaces = false;
};

/// What heat adds to the strains of the rod without stress: to its curvature, section axes, 1/m;
/// to its stretch.
struct ThermalStrain {
  Vec3 curvature = Vec3::Zero();
  double stretch = 0;

  bool none() const { return stretch == 0 && curvature.isZero(0); }

  Vec4 coordinates() const { return {curvature.x(), curvature.y(), curvature.z(), stretch}; }
};

/// First and second derivatives of a rod's elastic energy by ThermalStrain::coordinates(); the
/// second is diagonal.
struct ThermalEffort {
  Vec4 first = Vec4::Zero(), second = Vec4::Zero();

  /// A place that stands for the length `weight`. @param bent, stretched elastic strains there
  void add(double weight, const SectionProperties& section, const Vec3& bent, double stretched,
           bool extension) {
    second.head<3>() += weight * section.K_bt;
    first.head<3>() -= weight * section.K_bt.cwiseProduct(bent);
    if (!extension) return;
    second[3] += weight * section.K_se.z();
    first[3] -= weight * section.K_se.z() * stretched;
  }
};

/// What acts on the rod during one solve.
struct RodForcing {
  double length = 0;
  Vec3 gravity = Vec3::Zero();      ///< m/s²
  Vec3 wind = Vec3::Zero();         ///< m/s; read by a rod that has drag
  std::vector<PointLoad> loads;     ///< in the order and at the s given at construction
  std::vector<LineLoad> lines;      ///< read by a rod that was made for some
  std::vector<TendonPull> tendons;  ///< in the order given at construction
  MagneticSources field;            ///< read by a rod that is magnetised
  ThermalStrain heat;
  double relaxation = 0;  ///< N s/m² over the pseudo time step: drag towards the marked positions
  double axial_softness =
      0;  ///< extra axial compliance in units of L²/EI: see Equations::set_softness
  double tolerance = 1e-9;  ///< of the solve: below round-off, row scales grow instead
};

struct RodResidual {
  double sum_squares = 0;
  double largest = 0;
  int worst_row = 0;
  bool finite = true;
};

class RodTendons;
struct TendonSection;

struct RodEnergy {
  double kinetic = 0, elastic = 0, gravity = 0, magnetic = 0;
  double damping_power = 0;  ///< W, taken out by Kelvin-Voigt damping, drag and friction
  double fluid_power = 0;    ///< W, brought in by a fluid's current and its inertia
  double feed_power = 0;     ///< W, brought in per unit feed rate of the length drive (N)

  /// A rod that grows while its sections stay where they are becomes shorter in its strains: with e
  /// its energy per length and Lambda its own wrench, a unit of feed brings in
  ///   ∫ (e - Lambda·(u; v)) ds / L,    less what its tendons' motors pay out                  (4)
  /// and where nothing but its ends and its weight acts, that is what enters through its base.
  /// @param carried ∫ Lambda·(u; v) ds; kinetic, elastic, gravity and magnetic are the rod's alone
  void set_feed_power(double carried, double length, const RodTendons* tendons);
};

/// Lambda·(u; v) of (4). @param m, n of rod and tendons, world axes @param tendons null: none
double own_work(const Mat3& R, const Vec3& m, const Vec3& n, const Vec3& u, const Vec3& v,
                const TendonSection* tendons);

/// How finely a rod is cut, in the words of its method.
struct RodResolution {
  Method method = Method::kShooting;
  const char* rule = "";  ///< of the pieces: table, polynomials, splines
  int elements = 0;       ///< pieces along the rod
  int order = 0;          ///< of the table, or degree of the functions
};

class RodModel {
 public:
  virtual ~RodModel() = default;

  /// Sets coefficients, histories and loads for the solves that follow.
  virtual void prepare(const StageRates& rates, const RodForcing& forcing) = 0;

  /// Residual at the current unknowns, every row dimensionless. Also updates everything observe()
  /// reads.
  virtual RodResidual evaluate(const Port& base, const Port& tip) = 0;

  /// Linearisation at the point of the last evaluate(). @return false if some local system is
  /// singular.
  virtual bool linearize(const Port& base, const Port& tip, CondensedRod& out) = 0;

  /// Newton direction of the rod's own unknowns for given outer increments, in the axes and of the
  /// size that linearize() gives its two-port.
  virtual void set_direction(const Vec6& z, const Vec6& zeta_A) = 0;
  /// Remembers the unknowns; move() then sets them to the remembered ones plus alpha times the
  /// direction.
  virtual void keep() = 0;
  virtual void move(double alpha) = 0;

  /// Wrench (moment, force) on the bodies at the current state.
  virtual Vec6 wrench_on_base(const Port& base) const = 0;
  virtual Vec6 wrench_on_tip(const Port& tip) const = 0;

  /// Remembers by how much the joints gape at the last evaluate(); hold_gap() then leaves that
  /// fraction of it open.
  virtual void capture_gap(const Port& base, const Port& tip) = 0;
  virtual void hold_gap(double fraction) = 0;
  /// A guess: the shape of a curve, which need not be an equilibrium. mark_positions() then means
  /// the curve's.
  virtual void set_curve(const RodCurve& curve) = 0;
  /// A guess for a rod longer than its chord: a single bow between its ends.
  virtual void bow(const Port& base, const Port& tip) = 0;
  virtual void mark_positions() = 0;  ///< origin of the relaxation drag

  /// Coordinates that the time scheme integrates; fill_tracks() writes the current stage's values.
  virtual std::vector<Track*> tracks() = 0;
  virtual void fill_tracks() = 0;
  virtual Eigen::Index position_coordinates()
      const = 0;                     ///< how many of the first track are positions
  virtual void accept_tracks() = 0;  ///< new reference rotations after an accepted step
  virtual void start_tracks() = 0;   ///< at rest where it now is
  /// Moving along the direction last set, taken as a velocity: the bodies' motion with the rod
  /// following in equilibrium.
  virtual void start_tracks_moving() = 0;

  /// All unknowns as a copyable value, to retry a step or to extrapolate.
  struct Unknowns {
    VecX values;
    std::vector<NodeState> starts;
    std::vector<NodeState> nodes;  ///< as last reached: where segments may be cut differently
    std::vector<RodContact> contacts;
  };

  virtual Unknowns unknowns() const = 0;
  virtual void set_unknowns(const Unknowns& u) = 0;
  /// Sum of weighted past unknowns (weights sum to 1).
  virtual void predict(const std::vector<const Unknowns*>& past,
                       const std::vector<double>& weights) = 0;

  /// Everything that steps leave behind. For reading: after prepare() with the same rates and
  /// length.
  virtual void visit(Archive& archive) = 0;

  virtual RodSample observe() const = 0;

  /// At the last evaluate(), in the order given at construction.
  virtual std::vector<TendonSample> tendons() const { return {}; }

  /// From here on, at the state last accepted, friction of tendons follows what they do.
  virtual void engage_friction() {}

  /// The equilibrium at the last evaluate(), for stability and modes.
  virtual RodField field() const = 0;
  virtual RodEnergy energy() const = 0;

  /// What the rod's energy would be in this field, J.
  virtual double magnetic_energy(const MagneticSources&) const { return 0; }

  virtual ThermalEffort thermal_effort() const { return {}; }

  virtual std::string row_name(int row) const = 0;

  /// The side that touches obstacles; null where the discretisation has none.
  virtual TouchingRod* touching() { return nullptr; }

  virtual RodResolution resolution() const = 0;

  /// The law of its sections, chosen from those that are compiled each on its own; empty where
  /// there is but one.
  virtual const char* section_law(bool /*moving*/) const { return ""; }

  virtual int cells() const = 0;  ///< pieces that are swept one after another
  virtual int segments() const = 0;
  virtual int unknown_count() const = 0;
  virtual long section_evaluations() const = 0;
  virtual double growth_exponent() const = 0;
};

}  // namespace cprsim
