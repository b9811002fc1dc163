// SPDX-License-Identifier: BSD-3-Clause
// A geometrically exact rod whose strains are polynomials along each of its elements
// (Boyer, Lebastard, Candelier, Renda, IEEE Trans. Robotics 37, 2021; seed equations 9-11):
//   xi(s) = xi_rest + B Phi(s) q                                                             (1)
// B holds the strains that the effects leave free, as unit vectors in section axes; the others are
// not there, neither as unknowns nor as equations. Phi are normalised Legendre polynomials
// (engine/math/legendre.h), so that the elastic matrix is diagonal.
//
//   R_s = R u^    by Magnus steps between the element's Gauss points (engine/rod/magnus.h)     (2)
//   p_s = R v,  n_s = k p + b,  m_s = -p_s × n + t   by the integration matrix of these points  (3)
//   ∫ Phi^T B^T (K (xi - xi_rest) + D xi_t - Lambda) ds = 0                                   (4)
// Where sections vary along the rod their compliance stays under the integral of (4), which then is
// the law in the form xi = xi_rest + C (Lambda - D xi_t); a rest curvature that varies is projected
// onto Phi as the strains are. (4) is the law tested with the basis itself; K, D diagonal; Lambda =
// (R^T m, R^T n); k, b, t as in engine/rod/cell.h. Deviations from the source: the wrench comes
// from the strong balance (3) at the quadrature points instead of from the principle of virtual
// work, which needs no second derivatives and differs by the quadrature's error; positions are
// integrated in the world instead of in SE(3), so that they and the forces use one rule.
//
// With tendons Lambda is the total wrench and the rod's part of it is Lambda less theirs
// (engine/section/tendon_law.h), which is asked at the Gauss points.
//
// Unknowns: pose and wrench at the base, and q. Rows: the base's, (4), the tip's. A direction
// solves them at once: elimination leaves d = 6 unknowns z (3 in a plane) and the d rows of
// the tip (engine/rod/rod_model.h), whatever is stiff, free or singular. Elements begin and end at
// point loads, where the strain is not smooth.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/rod/effect_part.h"
#include "engine/rod/end_condition.h"
#include "engine/rod/immersion.h"
#include "engine/rod/nodal_contacts.h"
#include "engine/rod/rod_disks.h"
#include "engine/rod/rod_model.h"
#include "engine/rod/rod_tendons.h"
#include "engine/rod/strain_rule.h"
#include "engine/rod/tendon_border.h"
#include "engine/section/along.h"
#include "engine/section/section.h"

namespace cprsim {

struct StrainOptions {
  int order = 6;     ///< highest degree of the strain polynomials
  int elements = 1;  ///< at least; point loads cut further
  bool extension = false, shear = false;
  bool rotary_inertia = false, damping = false, drag = false;
  bool line_loads = false;          ///< whether anything is spread along it
  std::vector<MagnetSpec> magnets;  ///< of what is spread along it; whose ends are stations
  bool touches = false;             ///< whether it may touch something: at its borders
  std::vector<double> stations;     ///< s / L of point loads
  std::vector<Tendon> tendons;      ///< whose breaks are stations, too
  std::vector<DiskSpec> disks;      ///< whose s are stations, too
  std::shared_ptr<const SectionsAlong> along;  ///< null: sections and rest shape do not vary
};

/// One column of B.
struct StrainMode {
  Vec3 axis;          ///< section axes
  bool turns;         ///< of u, otherwise of v
  double K, damping;  ///< stiffness and damping along it
  bool listed;        ///< free in this scene; the axial one is also while a rod is softened
};

/// A section as the last evaluation found it, world axes; u, v in section axes.
struct StrainPoint {
  Mat3 R;
  Vec3 p, n, m, u, v, tau;
};

class StrainRod final : public RodModel, private TensionedRod, private ContactHost {
 public:
  /// @param X_WBase where the unloaded rod begins; in a plane its axes may be turned about the
  /// tangent. @param plane of a planar scene: e1, e2 and the normal as columns, world.
  StrainRod(std::string name, const EndCondition& base, const EndCondition& tip,
            const std::optional<Mat3>& plane, const Pose& X_WBase, const SectionProperties& section,
            double length, const StrainOptions& options);

  void set_unloaded(const Pose& X_WBase);

  void prepare(const StageRates& rates, const RodForcing& forcing) override;
  RodResidual evaluate(const Port& base, const Port& tip) override;
  bool linearize(const Port& base, const Port& tip, CondensedRod& out) override;
  void set_direction(const Vec6& z, const Vec6& zeta_A) override;
  void keep() override;
  void move(double alpha) override;
  Vec6 wrench_on_base(const Port& base) const override;
  Vec6 wrench_on_tip(const Port& tip) const override;
  void capture_gap(const Port& base, const Port& tip) override;
  void hold_gap(double fraction) override;
  void set_curve(const RodCurve& curve) override;
  void bow(const Port& base, const Port& tip) override;
  void mark_positions() override;
  std::vector<Track*> tracks() override;
  void fill_tracks() override;

  Eigen::Index position_coordinates() const override {
    return 3 * static_cast<Eigen::Index>(points_.size() + nodes_.size());
  }

  void accept_tracks() override;
  void start_tracks() override;
  void start_tracks_moving() override;
  Unknowns unknowns() const override;
  void set_unknowns(const Unknowns& u) override;
  void predict(const std::vector<const Unknowns*>& past,
               const std::vector<double>& weights) override;
  void visit(Archive& archive) override;
  RodSample observe() const override;

  std::vector<TendonSample> tendons() const override {
    return tendons_ ? tendons_->observe() : std::vector<TendonSample>();
  }

  void engage_friction() override {
    if (tendons_) tendons_->engage_friction();
  }

  RodField field() const override;
  RodEnergy energy() const override;
  double magnetic_energy(const MagneticSources& field) const override;
  ThermalEffort thermal_effort() const override;
  std::string row_name(int row) const override;

  TouchingRod* touching() override { return touch_.get(); }

  RodResolution resolution() const override {
    return {Method::kStrain, "legendre", static_cast<int>(elements()), rule_.order};
  }

  int cells() const override { return static_cast<int>(elements()); }

  int segments() const override { return 1; }

  int unknown_count() const override {
    return static_cast<int>(space_.state.cols() + strain_unknowns()) +
           (tendons_ ? static_cast<int>(tendons_->unknowns()) : 0);
  }

  long section_evaluations() const override { return section_evaluations_; }

  double growth_exponent() const override { return growth_; }

  /// Variational equations at the last evaluate(), by x = (state at the base in units of the scale
  /// along MotionSpace::state, then q in units 1 / L or 1): state at the tip, and rows of (4).
  /// For tests.
  const MatX& tip_columns() const { return tip_columns_; }

  const MatX& law_columns() const { return law_columns_; }

 private:
  using Rows3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;
  using Rows12 = Eigen::Matrix<double, 12, Eigen::Dynamic>;

  // section and its law
  void list_modes(const Mat3& R_WBase);
  double compliance(const StrainMode& mode) const;
  double compliance(const StrainMode& mode, std::size_t point) const;
  void list_sections();

  const SectionProperties& section(std::size_t point) const {
    return sections_.empty() ? section_ : sections_[point];
  }

  /// Stiffness and damping along a mode at a point.
  double stiffness(const StrainMode& mode, std::size_t point) const;
  double damping(const StrainMode& mode, std::size_t point) const;

  Vec3 rest_curvature(std::size_t element, const Eigen::Ref<const VecX>& phi) const {
    return forcing_.heat.curvature + (rest_.empty() ? section_.u_rest : Vec3(rest_[element] * phi));
  }

  bool bent_at_rest() const {
    return options_.along ? options_.along->bent_at_rest() : !section_.u_rest.isZero();
  }

  /// Strain along a mode that heat adds.
  static double thermal_strain(const StrainMode& mode, const ThermalStrain& heat) {
    return mode.turns ? mode.axis.dot(heat.curvature) : mode.axis.z() * heat.stretch;
  }

  void add_thermal_strain(double sign, const ThermalStrain& heat, Eigen::Ref<MatX> q) const;

  double unit(const StrainMode& mode) const { return mode.turns ? 1 / scale_.length : 1; }

  Vec3 strain(std::size_t element, const Eigen::Ref<const VecX>& phi, bool turns) const;

  std::size_t elements() const { return grid_.size() - 1; }

  /// Length that a point stands for, m.
  double weight_of(std::size_t point) const;

  double length_of(std::size_t element) const {
    return (grid_[element + 1] - grid_[element]) * forcing_.length;
  }

  /// Of q: the position of a free mode's coefficients among all unknown ones.
  Eigen::Index strain_unknowns() const {
    return static_cast<Eigen::Index>(elements() * free_modes_.size()) * rule_.functions();
  }

  Eigen::Index first_unknown(std::size_t element, std::size_t free_mode) const {
    return static_cast<Eigen::Index>(element * free_modes_.size() + free_mode) * rule_.functions();
  }

  // the sweep
  struct Turn {
    Vec3 Omega;
    Mat3 R_end;
  };

  Turn turn(std::size_t element, const StrainRule::Step& step, const Mat3& R_start) const;
  Mat3 cross_gap(std::size_t element, std::size_t gap, Mat3 R);
  void evaluate_element(std::size_t element, NodeState& state);
  void project_law(std::size_t element);
  void place_tendons();
  const VecX& tendon_gaps();

  Eigen::Index freedoms() const override { return space_.freedoms(); }

  bool linearize_given(const Port& base, const Port& tip, CondensedRod& out,
                       TensionPorts& ports) override {
    return condense(base, tip, out, &ports);
  }

  bool condense(const Port& base, const Port& tip, CondensedRod& out, TensionPorts* tensions);

  OpenPorts* ports_of_forces() override { return force_columns() > 0 ? &touch_->ports() : nullptr; }

  void find_directions(const MatX& cases, MatX& directions) override {
    directions.noalias() = general_ * cases;
  }

  void add_tensions(Eigen::Ref<MatX> columns) const;
  void strain_rates(const Eigen::Ref<const VecX>& direction,
                    std::vector<Vec6>& rates) const override;

  // contact
  const std::vector<NodeState>& grid_nodes() const override { return nodes_; }

  const std::vector<double>& node_grid() const override { return grid_; }

  double rod_length() const override { return forcing_.length; }

  const StageRates& stage_rates() const override { return rates_; }

  Vec3 velocity_history(std::size_t node) const override {
    return track_.x_h.segment<3>(3 * static_cast<Eigen::Index>(points_.size() + node));
  }

  ContactScale scale_of_contacts() const override;

  /// Of the forces of contacts, behind those of x.
  Eigen::Index force_columns() const { return touch_ ? touch_->columns() : 0; }

  void vary_contacts(std::size_t node, Rows12& y);
  VecX direction_with_forces() const;

  bool finds_tensions() const { return tendons_ && tendons_->unknowns() > 0; }

  Vec3 own_wrench(const StrainMode& mode, std::size_t point) const;
  void evaluate_rotary_inertia(std::size_t point);
  Vec3 fluid_force(std::size_t point);
  void apply_load(std::size_t node, NodeState& state) const;
  void update_point_inputs();
  Eigen::RowVectorXd weighted_by_damping(const StrainMode& mode, std::size_t element,
                                         const Eigen::RowVectorXd& q) const;
  void add_row(RodResidual& r, double value, int row) const;

  void add_strain_energy(RodEnergy& energy) const;
  void add_varying_strain_energy(RodEnergy& energy) const;

  // its linearisation
  void vary_element(std::size_t element, Rows12& y);
  void vary_gap(std::size_t element, std::size_t gap, Rows3& phi) const;
  void vary_load(std::size_t node, Rows12& y) const;
  void vary_law(std::size_t element);
  void vary_tendons(std::size_t element);
  void sweep_columns();
  VecX state_units() const;

  std::string name_;
  EndCondition base_, tip_;
  MotionSpace space_;
  SectionProperties section_;                ///< of the base, if they vary
  std::vector<SectionProperties> sections_;  ///< of the points; empty: the same everywhere
  StrainOptions options_;
  StrainRule rule_;
  std::vector<double> grid_;  ///< borders of elements, s / L
  std::vector<Eigen::Matrix<double, 3, Eigen::Dynamic>>
      rest_;  ///< per element, 3 × functions: the rest curvature, where it varies
  std::vector<StrainMode> modes_;
  std::vector<std::size_t> free_modes_;  ///< now: of modes_
  std::vector<std::size_t> load_at_;     ///< border of forcing_.loads[i]

  // coefficients of the current solve
  StageRates rates_;
  RodForcing forcing_;
  RodScale scale_;
  double noise_ = 1;  ///< row scales grow by this where round-off exceeds the tolerance
  double growth_ = 0;
  std::vector<double> k_;  ///< N/m² at the points, of (3)
  bool inertia_ = false;   ///< whether any is not 0
  std::vector<Vec3> b_;    ///< N/m at the points
  Immersion fluid_;
  std::vector<MatX> q_0_;  ///< per element, modes × functions: what damping adds to q in (4)

  // unknowns and what the last evaluation found
  NodeState start_{};    ///< at the base, before any load there
  std::vector<MatX> q_;  ///< per element, modes × functions
  std::vector<StrainPoint> points_;
  std::vector<NodeState> nodes_;  ///< element borders, after any load there
  std::vector<Turn> turns_;       ///< of every Magnus step
  VecX law_residual_;             ///< (4)
  VecX tip_gap_, base_gap_, tip_gap_start_, base_gap_start_;
  std::vector<Vec3> marked_;
  bool evaluated_ = false;

  /// Rotary inertia at a point, as engine/section/rotary.h reads and fills it.
  struct Rotary {
    double R[9], R_start[9], theta_h[3], omega_h[3];
    double theta[3], theta_t[3], omega[3], omega_t[3];
    double torque[3], torque_phi[9];
  };

  std::vector<Rotary> rotary_;  ///< empty without the effect
  bool turning_ = false;        ///< rotary inertia acts now

  EffectPart<RodTendons> tendons_;  ///< sections: points
  TendonBorder border_;
  VecX tension_direction_;
  EffectPart<RodDisks> disks_;  ///< null: none

  /// What a sweep writes along one element, kept so that it need not ask for memory.
  struct Scratch {
    std::vector<Vec3> n_s, m_s;
    Rows3 turn;
    std::vector<Rows3> tau, n, m, m_rates, fluid;
    Eigen::RowVectorXd wrench;
  } scratch_;

  // linearisation: columns of x
  MatX tip_columns_, law_columns_;
  std::vector<Rows3> point_turns_, point_moves_, node_moves_;
  MatX general_;                   ///< x = general_ [z; zeta_A; 1; F], F the forces of contacts
  std::vector<Rows3> node_turns_;  ///< of a rod that touches or carries disks

  // direction and remembered unknowns
  VecX direction_;
  NodeState kept_start_{};
  std::vector<MatX> kept_q_;

  Track track_;  ///< positions of points and borders, q if damped
  Track rotation_track_{Track::Kind::kRotation};
  EffectPart<NodalContacts> touch_;  ///< of a rod that may touch something
  long section_evaluations_ = 0;
};

}  // namespace cprsim
