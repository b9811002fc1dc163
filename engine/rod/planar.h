// SPDX-License-Identifier: BSD-3-Clause
// Multiple shooting on a rod that stays in a plane (engine/rod/planar_cell.h), with the grid,
// segments, elimination and laws of engine/rod/shooting.h, and three unknowns where that has six.
//
// Its two-port is written in the plane: of CondensedRod only the leading 3 × 3 blocks are set, z
// has three entries, zeta = (phi, dp_1, dp_2) and wrenches are (moment, force_1, force_2), phi and
// moment about the normal. RodModel::wrench_on_base() and wrench_on_tip() give world axes.
#pragma once

#include "engine/model/planar.h"
#include "engine/rod/planar_cell.h"
#include "engine/rod/planar_immersion.h"
#include "engine/rod/planar_tendons.h"
#include "engine/rod/shooting.h"
#include "engine/rod/strains_at_nodes.h"

namespace cprsim {

using Mat6x3 = Eigen::Matrix<double, 6, 3>;

class PlanarRod final : public RodModel, private TensionedRod {
 public:
  /// Straight and unloaded from the base frame.
  /// @param plane axes e1, e2, normal as columns, world. @param R_WSection section axes up to a
  /// turn in the plane: the tangent lies in it, a principal axis along its normal unless both are
  /// alike.
  PlanarRod(std::string name, PlanarHold base, PlanarHold tip, const Mat3& plane,
            const Pose& X_WBase, const Mat3& R_WSection, const SectionProperties& section,
            double length, const ShootingOptions& options);

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
    return 2 * static_cast<Eigen::Index>(stages_.size() + nodes_.size());
  }

  void accept_tracks() override {
    if (tendons_) tendons_->in_space().accept();
  }

  void engage_friction() override {
    if (tendons_) tendons_->in_space().engage_friction();
  }

  std::vector<TendonSample> tendons() const override {
    return tendons_ ? tendons_->in_space().observe() : std::vector<TendonSample>();
  }

  void start_tracks() override;
  void start_tracks_moving() override;
  Unknowns unknowns() const override;
  void set_unknowns(const Unknowns& u) override;
  void predict(const std::vector<const Unknowns*>& past,
               const std::vector<double>& weights) override;
  void visit(Archive& archive) override;
  RodSample observe() const override;
  RodField field() const override;
  RodEnergy energy() const override;
  double magnetic_energy(const MagneticSources& field) const override;
  ThermalEffort thermal_effort() const override;
  std::string row_name(int row) const override;

  RodResolution resolution() const override {
    return {Method::kShooting, table_->name, cells_, table_->order};
  }

  int cells() const override { return cells_; }

  int segments() const override { return static_cast<int>(segment_first_.size()) - 1; }

  int unknown_count() const override;

  long section_evaluations() const override { return section_evaluations_; }

  double growth_exponent() const override { return growth_; }

 private:
  /// A joint frame in the plane; `ref` is p minus the body's reference point.
  struct Place {
    double c, s;
    Vec2 p, arm;
  };

  Place place(const Port& port) const;
  Vec3 end_value(PlanarHold hold, const PlanarNode& end, const Place& at, double noise) const;

  /// What motion in the plane meets of a section.
  struct Own {
    double K_b = 0, B_b = 0;  ///< bending
    Vec2 K_v, B_v;            ///< stretch and shear
    double rhoA = 0, weighing = 0, rhoI = 0;
    double kappa_rest = 0;
  };

  void list_sections();
  Own own_of(const SectionProperties& section) const;
  void set_coefficients(const Own& own, PlanarSection& section) const;
  void set_unloaded(double theta, const Vec2& p);

  /// Of heat, about the normal.
  double heat_curvature() const { return offset_.row(2).dot(forcing_.heat.curvature); }

  void choose_segments();
  void update_stage_inputs();
  void apply_load(std::size_t node, PlanarNode& state) const;
  Vec3 planar_wrench(const PlanarNode& node, const Place& at) const;
  Vec6 to_world(const Vec3& wrench) const;

  // tendons
  void place_tendons();

  Eigen::Index tendon_unknowns() const { return tendons_ ? tendons_->in_space().unknowns() : 0; }

  bool finds_tensions() const { return tendon_unknowns() > 0; }

  Eigen::Index count_values() const;

  Eigen::Index freedoms() const override { return 3; }

  /// The tip's rows, and the wrench on its body, by the state there.
  struct TipRows {
    Eigen::Matrix<double, 3, 6> T = Eigen::Matrix<double, 3, 6>::Zero(), W = T;
  };

  bool linearize_given(const Port& base, const Port& tip, CondensedRod& out,
                       TensionPorts& ports) override {
    return condense(base, tip, out, &ports);
  }

  bool condense(const Port& base, const Port& tip, CondensedRod& out, TensionPorts* tensions);
  void find_directions(const MatX& cases, MatX& directions) override;
  void find_direction_in_case(const Eigen::Ref<const VecX>& column);
  void find_direction(const Vec3& z, const Vec3& zeta_A, double share);
  void strain_rates(const Eigen::Ref<const VecX>& direction,
                    std::vector<Vec6>& rates) const override;
  void begin_pulled_columns();
  bool sweep_pulled_columns(std::size_t cell);
  void add_pulled_direction();
  void close_pulled(const TipRows& rows, const Mat3& by_z_of_base, TensionPorts& ports);
  void describe_tendons(RodField& field) const;

  // linearisation
  void start_columns(const Place& base, double* Y) const;
  void apply_load_columns(std::size_t node, const PlanarNode& state, double* Y, int columns) const;
  double weight_of(std::size_t stage) const;
  StrainsAtNodes strains_at_nodes() const;
  bool sweep_columns(const Place& base);
  void orthonormalize(std::size_t segment, const PlanarNode& reached, double* Y);
  TipRows close_tip(const Place& tip, const double* Y, CondensedRod& out) const;
  Mat3 close_base(const Place& base, CondensedRod& out) const;

  /// Inputs of a cell.
  void enter(std::size_t cell);

  void place_surroundings();
  void place_disks();
  void pass_disks(std::size_t node, PlanarNode& state) const;

  int affine_column() const { return columns_ == kPlanarNarrow ? 3 : 6; }

  /// Of the section's axes: stiffness, damping or inertia that motion in the plane meets.
  double about_normal(const Vec3& diagonal) const;
  double along_section(const Vec3& diagonal) const;

  std::string name_;
  PlanarHold base_, tip_;
  Mat3 plane_;         ///< e1, e2, normal
  Mat3 offset_;        ///< section axes in plane axes at theta = 0
  double height_ = 0;  ///< of the rod's plane along the normal

  double K_b_ = 0;                           ///< of the base
  std::vector<Own> own_;                     ///< of the stages
  SectionProperties section_;                ///< of the base, if they vary
  std::vector<SectionProperties> sections_;  ///< of the stages; empty: the same everywhere
  ShootingOptions options_;
  const ArcTableau* table_;
  int cells_ = 0;
  bool extensible_ = false;
  std::vector<double> grid_;
  CellLaw law_ = CellLaw::kKirchhoff;
  PlanarKernel kernel_{};

  // coefficients of the current solve
  PlanarModel model_;
  std::vector<PlanarSection> coefficients_;  ///< of the stages
  StageRates rates_;
  RodForcing forcing_;
  RodScale scale_, port_scale_;
  double noise_ = 1;
  double growth_ = 0;

  // unknowns and what the last evaluation found
  std::vector<PlanarStage> stages_;
  std::vector<PlanarNode> starts_;  ///< segment starts; [0] is the base, before any load there
  std::vector<PlanarNode> nodes_;   ///< grid nodes as reached
  std::vector<std::size_t> segment_first_;
  std::vector<std::size_t> load_at_;
  Vec3 tip_gap_ = Vec3::Zero(), base_gap_ = Vec3::Zero();
  Vec3 tip_gap_start_ = Vec3::Zero(), base_gap_start_ = Vec3::Zero();
  std::vector<Vec2> marked_;
  bool evaluated_ = false;

  // linearisation
  int columns_ = kPlanarNarrow;
  std::vector<double> start_columns_;    ///< 6 × columns a segment, and once more for the tip
  std::vector<double> cell_directions_;  ///< lifted × columns per cell

  struct Recombination {
    Mat3 R, G_A;
    Vec3 g;
  };

  std::vector<Recombination> recombinations_;
  double transition_ = 0;

  // direction and remembered unknowns
  std::vector<Vec6> start_direction_;
  std::vector<double> lifted_direction_;
  std::vector<PlanarNode> kept_starts_;
  std::vector<double> kept_lifted_;

  /// Stage and node positions, stage angles (rotary inertia), stage curvatures and stretches
  /// (damping). Angles of one axis are integrated like positions.
  Track track_;
  Eigen::Index angles_ = 0, strains_ = 0;  ///< where those begin

  /// A disk of engine/rod/rod_disks.h: n+ = n- + k p + force, m+ = m- + k_J theta + moment.
  struct Disk {
    std::size_t node = 0;
    double mass = 0, inertia = 0;
    double k = 0, k_J = 0;
    Vec2 force = Vec2::Zero();
    double moment = 0;
  };

  std::unique_ptr<PlanarImmersion> around_;  ///< null where nothing lies around it
  std::unique_ptr<PlanarTendons> tendons_;   ///< sections: stages
  TendonBorder border_;
  VecX tension_direction_;

  /// Columns of the tendons' unknowns, as those of engine/rod/shooting_open.h.
  struct PulledColumns {
    static constexpr int kUsed = 6;  ///< of a block
    using Block = Eigen::Matrix<double, 6, kPlanarWide, Eigen::RowMajor>;

    std::vector<Block> blocks;
    std::vector<std::vector<Block>> at_segment;
    std::vector<std::vector<Eigen::Matrix<double, 3, kUsed>>> G;  ///< as Recombination::G_A
    std::vector<double> sources,
        directions;  ///< block by block, cell by cell: lifted × kPlanarWide
    VecX weights;    ///< of the direction

    Vec6 weights_of(std::size_t block) const {
      return weights.segment<kUsed>(kUsed * static_cast<Eigen::Index>(block));
    }
  };

  PulledColumns pulled_;
  std::vector<Disk> disks_;
  Eigen::Index disk_angles_ = 0;  ///< where theirs begin, with rotary inertia
  long section_evaluations_ = 0;
};

}  // namespace cprsim
