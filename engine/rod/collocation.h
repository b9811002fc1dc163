// SPDX-License-Identifier: BSD-3-Clause
// Isogeometric collocation of a rod: its fields q, p, n, m are B-splines (engine/math/bspline.h),
// the balance (engine/rod/collocation_point.h) holds in strong form at points.
//
// A spline of degree p with N control points has a derivative of degree p - 1 with N - 1 of them;
// that many points, the Greville abscissae of the derivative's space, the two ends among them,
// carry the 13 rows each. They say what every derivative is, and 13 rows at the ends the rest: so
// each field is as many times differentiated as it has rows, whatever the compliances, and an
// inextensible rod is no special case. (With the two laws at N points and the two balances at
// N - 2, as published, a zero of C_se leaves axial force open and position twice determined.) The
// order is p for even p, p + 1 for odd p: interpolation by splines of even degree has an error
// that integrates to zero.
//
// Where a point load acts n, m jump: a knot of multiplicity p + 1 there, with q, p joined by rows.
// A rod that may touch something has such knots between all elements: contacts act there. A tied
// one has them where it is tied. In a plane one turn, two translations and forces and one moment
// are left: 7 rows a point for 13.
//
// Control points are eliminated from the base to the last one (engine/math/banded_elimination.h),
// where six unknowns that the base leaves free are the z of the two-port.
//
// Increments of a control point turn its quaternion and scale it: a turn of the whole rod by any
// angle is one exact step for all rotations. A length drive feeds the rod as in
// engine/rod/shooting.h.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/banded_elimination.h"
#include "engine/math/bspline.h"
#include "engine/rod/collocation_point.h"
#include "engine/rod/effect_part.h"
#include "engine/rod/end_wrench.h"
#include "engine/rod/immersion.h"
#include "engine/rod/nodal_contacts.h"
#include "engine/rod/rod_disks.h"
#include "engine/rod/rod_model.h"
#include "engine/rod/rod_tendons.h"
#include "engine/rod/tendon_border.h"
#include "engine/section/along.h"
#include "engine/section/section.h"

namespace cprsim {

constexpr int kLeastDegree = 2, kDefaultDegree = 7;

struct CollocationOptions {
  int degree = kDefaultDegree, elements = 4;  ///< elements: at least; all point loads are at knots
  bool extension = false, shear = false;      ///< effects that change the law
  bool rotary_inertia = false, damping = false, drag = false;
  bool line_loads = false;          ///< whether anything is spread along it
  std::vector<MagnetSpec> magnets;  ///< of what is spread along it; whose ends are stations
  bool touches = false;             ///< whether it may touch something
  bool tied = false;                ///< at stations
  std::vector<double> stations;     ///< s of point loads
  std::vector<Tendon> tendons;      ///< whose breaks are stations, too
  std::vector<DiskSpec> disks;      ///< whose s are stations, too
  std::shared_ptr<const SectionsAlong> along;  ///< null: sections and rest shape do not vary
  /// NURBS: of the degree + elements functions on equal elements; empty: all 1.
  std::vector<double> weights;
};

class CollocationRod final : public RodModel, private TensionedRod, private ContactHost {
 public:
  /// @param plane of a planar scene: e1, e2 and the normal as columns, world. @param X_WBase where
  /// the unloaded rod begins; in a plane its axes may be turned about the tangent.
  CollocationRod(std::string name, const EndCondition& base, const EndCondition& tip,
                 const std::optional<Mat3>& plane, const Pose& X_WBase,
                 const SectionProperties& section, double length,
                 const CollocationOptions& options);

  /// The unloaded shape from the base frame: a straight line, or the helix of a constant rest
  /// curvature.
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
    const char* rule = options_.weights.empty() ? "B-splines" : "NURBS";
    return {Method::kCollocation, rule, elements_, options_.degree};
  }

  int cells() const override { return elements_; }

  int segments() const override { return static_cast<int>(pieces_.size()); }

  int unknown_count() const override {
    return columns() + (tendons_ ? static_cast<int>(tendons_->unknowns()) : 0);
  }

  long section_evaluations() const override { return section_evaluations_; }

  double growth_exponent() const override { return growth_; }

 private:
  /// A place where splines are evaluated; functions count through all pieces, slopes are by s.
  struct Site {
    double s = 0;
    BasisValues basis;
  };

  /// Between point loads: one spline space.
  struct Piece {
    BsplineSpace space;
    int first_control = 0, first_point = 0, points = 0;
  };

  void place_sites(const std::vector<double>& grid);
  void weigh(BsplineSpace& space) const;
  void place_tendons();
  const VecX& tendon_gaps();

  Eigen::Index freedoms() const override { return space_.freedoms(); }

  void describe_tendons(const Site& at, RodField& field) const;

  bool linearize_given(const Port& base, const Port& tip, CondensedRod& out,
                       TensionPorts& ports) override {
    return condense(base, tip, out, &ports);
  }

  bool condense(const Port& base, const Port& tip, CondensedRod& out, TensionPorts* tensions);

  OpenPorts* ports_of_forces() override { return force_columns() > 0 ? &touch_->ports() : nullptr; }

  void find_directions(const MatX& cases, MatX& directions) override;
  void strain_rates(const Eigen::Ref<const VecX>& direction,
                    std::vector<Vec6>& rates) const override;
  void assemble_tensions();

  // contact, at the ends of the pieces
  const std::vector<NodeState>& grid_nodes() const override { return touch_nodes_; }

  const std::vector<double>& node_grid() const override { return touch_grid_; }

  double rod_length() const override { return forcing_.length; }

  const StageRates& stage_rates() const override { return rates_; }

  Vec3 velocity_history(std::size_t node) const override {
    return track_.x_h.segment<3>(3 * static_cast<Eigen::Index>(points_.size() + node));
  }

  ContactScale scale_of_contacts() const override;

  /// Of unknowns of tendons: dense columns behind those of forces.
  int tension_columns() const {
    return finds_tensions() ? static_cast<int>(tendons_->unknowns()) : 0;
  }

  /// Dense columns.
  int given() const { return affine() + 1 + force_columns() + tension_columns(); }

  /// Of the forces of contacts: dense columns behind the affine one.
  int force_columns() const { return touch_ ? static_cast<int>(touch_->columns()) : 0; }

  std::size_t control_at(std::size_t node) const {
    return node < pieces_.size() ? static_cast<std::size_t>(pieces_[node].first_control)
                                 : control_.size() - 1;
  }

  void update_touch_nodes();
  void assemble_contacts(const ConditionRows& base_rows);
  NodalContacts::ByForces contact_loads(std::size_t node) const;
  void describe_contacts(TensionPorts* tensions);

  bool finds_tensions() const { return tendons_ && tendons_->unknowns() > 0; }

  TendonSection* tendons_at(std::size_t point) const {
    return tendons_ ? &tendons_->at(point) : nullptr;
  }

  Site site(std::size_t piece, double s) const;
  Vec13 value(const Site& at) const;
  Vec13 derivative(const Site& at) const;
  NodeState state_of(const Vec13& y) const;
  NodeState base_state() const;
  NodeState tip_state() const;
  Vec6 load_at(std::size_t station, const Mat3& R) const;
  Mat6 load_by_motion(std::size_t station, const Mat3& R) const;
  void place_disks();
  void meet_disks();
  const Vec13& end_of_piece(std::size_t station) const;
  void set_shape(const Pose& X_WBase, const std::function<Vec3(double)>& turn);
  void set_turned(const Pose& X_WBase, const std::function<Vec4(double)>& turned);
  void set_rotated(const Pose& X_WBase, const std::function<Mat3(double)>& rotation);
  Vec3 compliance_bt(const SectionProperties& section) const;
  Vec3 compliance_se(const SectionProperties& section) const;
  void set_coefficients(const SectionProperties& section, PointModel& model) const;
  void list_sections();
  void place_lines();

  const SectionProperties& section(std::size_t point) const {
    return sections_.empty() ? section_ : sections_[point];
  }

  Vec3 rest_curvature(double s) const {
    return options_.along ? options_.along->rest_curvature(s) : section_.u_rest;
  }

  const PointModel& model(std::size_t point) const {
    return models_.empty() ? model_ : models_[point];
  }

  void update_point_inputs();
  void choose_units();
  Vec13 join_rows(std::size_t piece) const;
  Vec13 point_scale(std::size_t point) const;
  Vec13 join_scale() const;
  void assemble(const Port& base);
  void assemble_base(const Port& base);
  void assemble_points(std::size_t piece, int row);
  void assemble_join(std::size_t piece, int row);
  void put(int row, int control, const Mat13& by_fields);
  void find_band();
  void choose_space(const std::optional<Mat3>& plane, const Mat3& R_WBase);
  Vec13 increment_units() const;
  MatX base_columns(const NodeState& start) const;
  Vec13 left_by_plane(const Vec13& by_fields, const Vec4& q) const;

  /// Of a point, null where no fluid acts.
  FluidSection* fluid_at(std::size_t point) { return fluid_.acts() ? fluid_.at(point) : nullptr; }

  Eigen::Index strain_track() const { return position_coordinates(); }

  /// Unknowns of a control point, and rows of a point.
  int width() const { return static_cast<int>(rows_.rows()); }

  int columns() const { return width() * static_cast<int>(control_.size()); }

  /// Among the dense columns of the system: after the base body's motion, if that is unknown.
  int affine() const { return base_moves_ ? width() / 2 : 0; }

  std::string name_;
  EndCondition base_, tip_;
  MotionSpace space_;
  MatX rows_;             ///< width × 13: of the 13 rows of a point, those that are not met anyway
  MatX increments_;       ///< 13 × width: those of a control point's increments that are free
  int planar_axis_ = -1;  ///< of the section: along the plane's normal
  SectionProperties section_;                ///< of the base, if they vary
  std::vector<SectionProperties> sections_;  ///< of the points; empty: the same everywhere
  CollocationOptions options_;
  bool extensible_ = false;
  int elements_ = 0;

  // the grid
  std::vector<Piece> pieces_;
  std::vector<Site> sites_;      ///< of the points
  std::vector<double> weights_;  ///< of the points, as fractions of the length; their sum is 1
  std::vector<Site> nodes_;      ///< where the rod is observed, s ascending from 0 to 1
  std::vector<std::size_t> station_of_;  ///< of forcing_.loads[i]: 0 base, 1.. joins, last the tip

  // coefficients of the current solve
  PointModel model_;
  std::vector<PointModel> models_;  ///< of the points, where sections vary
  StageRates rates_;
  RodForcing forcing_;
  Immersion fluid_{0};
  RodScale scale_;    ///< L, EI/L², EI/L
  RodScale unit_;     ///< the same with the boundary layer's length, for pivoting
  double noise_ = 1;  ///< rows of forces grow by this where round-off exceeds the tolerance
  double growth_ = 0;

  // unknowns and what the last evaluation found
  std::vector<Vec13> control_;
  std::vector<CollocationPoint> points_;
  VecX tip_gap_, base_gap_;              ///< left open now
  VecX tip_gap_start_, base_gap_start_;  ///< as captured
  std::vector<Vec3> marked_;

  // linearisation, direction, remembered unknowns
  std::vector<Vec13> residual_;  ///< of points and joins, in the order of their rows
  BandedElimination system_;
  int lower_ = 0, upper_ = 0;  ///< band
  bool base_moves_ = false;
  MatX last_;  ///< the last control point's (phi, dp, dn, dm) = last_ [z; zeta_A; 1; F], in units
  std::vector<Vec13> direction_, kept_;

  Track track_;
  Track rotation_track_{Track::Kind::kRotation};
  std::vector<Mat3> reference_rotations_;  ///< of the points, at the start of the step

  EffectPart<NodalContacts> touch_;  ///< of a rod that may touch something
  std::vector<NodeState> touch_nodes_;
  std::vector<double> touch_grid_;

  long section_evaluations_ = 0;

  EffectPart<RodTendons> tendons_;  ///< sections: points
  TendonBorder border_;
  VecX tension_direction_;
  EffectPart<RodDisks> disks_;  ///< null: none
};

}  // namespace cprsim
