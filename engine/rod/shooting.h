// SPDX-License-Identifier: BSD-3-Clause
// Multiple shooting on a rod. The rod is cut into cells (engine/rod/cell.h), cells into segments.
// Unknowns: pose and wrench at each segment's start, and the strain rates of all stages, which are
// eliminated cell by cell during the sweep. One sweep base → tip gives the residual and the exact
// variational equations.
//
// Elimination across segments never multiplies transition matrices. At each segment's end the six
// columns that still answer for unknowns are orthonormalised and the particular columns made
// orthogonal to them (Godunov, Uspekhi Mat. Nauk 16, 1961; Conte, SIAM Review 8, 1966); the
// unknowns of earlier segments follow from later ones by triangular back-substitution, in which
// growing modes decay. Segments are so many that none amplifies more than e^6.
//
// A contact brings an unknown force and three rows, which determine it and leave six columns again:
// the same recombination, without a segment's start (engine/rod/shooting_contact.cpp).
//
// The grid of cells does not follow the time step: Gauss collocation is symmetric, so growing and
// decaying solutions stay apart on any grid.
//
// A length drive feeds the rod through its base: the grid scales with the length, and inertia and
// damping see the motion at fixed s / L (quasi-static feed: the convective terms of order L_t are
// left out).
#pragma once

#include <memory>

#include "engine/rod/contact_motion.h"
#include "engine/rod/immersion.h"
#include "engine/rod/rod_disks.h"
#include "engine/rod/rod_model.h"
#include "engine/rod/rod_tendons.h"
#include "engine/rod/strains_at_nodes.h"
#include "engine/rod/tendon_border.h"
#include "engine/section/along.h"
#include "engine/section/section.h"

namespace cprsim {

struct ShootingOptions {
  ArcIntegrator integrator = ArcIntegrator::kGauss4;
  int cells = 10;
  bool extension = false, shear = false;  ///< effects that change the law
  bool rotary_inertia = false, damping = false, drag = false;
  bool line_loads = false;          ///< whether anything is spread along it
  std::vector<MagnetSpec> magnets;  ///< of what is spread along it; whose ends are stations
  std::vector<double> stations;     ///< s of point loads: grid nodes are placed there
  std::vector<Tendon> tendons;      ///< whose breaks are stations, too
  std::vector<DiskSpec> disks;      ///< whose s are stations, too
  std::shared_ptr<const SectionsAlong> along;  ///< null: sections and rest shape do not vary
};

/// Largest growth of the arc-length problem over a rod of length L (design section 5): bending, and
/// with k = rho A c_v c_w the inertia coefficient in N/m²; N is the largest internal force.
double growth_exponent(const SectionProperties& section, const Vec3& K_bt, const Vec3& K_se,
                       double length, double k, double N);

class ShootingRod final : public RodModel, public TouchingRod, private TensionedRod {
 public:
  ShootingRod(std::string name, const RodEnd& base, const RodEnd& tip,
              const SectionProperties& section, double length, const ShootingOptions& options);
  ~ShootingRod() override;

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
    return 3 * static_cast<Eigen::Index>(stages_.size() + nodes_.size());
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

  RodResolution resolution() const override {
    return {Method::kShooting, table_->name, cells_, table_->order};
  }

  const char* section_law(bool moving) const override;

  int cells() const override { return cells_; }

  int segments() const override { return static_cast<int>(segment_first_.size()) - 1; }

  int unknown_count() const override;

  long section_evaluations() const override { return section_evaluations_; }

  double growth_exponent() const override { return growth_; }

  TouchingRod* touching() override { return this; }

  const std::vector<NodeState>& contact_nodes() const override { return nodes_; }

  const std::vector<double>& contact_grid() const override { return grid_; }

  void set_surfaces(const std::vector<Surface>& surfaces, double radius, bool friction) override;
  const std::vector<Surface>& surfaces() const override;

  bool may_touch() const override { return touch_ != nullptr; }

  std::vector<RodContact>& contacts() override;
  std::vector<ContactRows>& contact_state() override;
  ContactEnds contact_ends(std::size_t contact) const override;
  ContactScale contact_scale() const override;
  const OpenPorts& open_ports() const override;
  void set_open_direction(const VecX& forces) override;
  void accept_contacts() override;

  /// State at node k (after any load there); base state before it. For tests and observation.
  const NodeState& node(int k) const { return nodes_[static_cast<std::size_t>(k)]; }

  const NodeState& base_state() const { return starts_.front(); }

 private:
  using Columns =
      std::vector<double>;  ///< 12 × columns, row-major, 64-byte aligned blocks not required

  void choose_segments();
  void apply_load(std::size_t node, NodeState& state) const;
  void apply_load_columns(std::size_t node, const NodeState& state, double* Y, int columns) const;
  void start_columns(const Port& base, double* Y) const;
  bool sweep_columns(const Port& base);
  void cut_zones();
  bool cross_boundary(std::size_t zone, double* Y);
  void orthonormalize(std::size_t zone, const Vec12& mismatch, double* Y);
  void close_tip(const Port& tip, const double* Y, CondensedRod& out) const;
  void close_base(const Port& base, CondensedRod& out) const;
  RodResidual& add_row(RodResidual& r, double value, int row) const;
  Vec3 compliance_bt(const SectionProperties& section) const;
  Vec3 compliance_se(const SectionProperties& section) const;
  CellSection coefficients(const SectionProperties& section) const;
  void list_sections();
  /// @param surrounded by a fluid, loads along it or a magnetic field
  CellLaw law_of(bool moving, bool surrounded) const;
  void update_stage_inputs();
  void place_tendons();
  const VecX& tendon_gaps();

  Eigen::Index freedoms() const override { return 6; }

  bool linearize_given(const Port& base, const Port& tip, CondensedRod& out,
                       TensionPorts& ports) override {
    return condense(base, tip, out, &ports);
  }

  bool condense(const Port& base, const Port& tip, CondensedRod& out, TensionPorts* tensions);
  OpenPorts* ports_of_forces() override;
  VecX open_forces() const;
  void find_directions(const MatX& cases, MatX& directions) override;
  void find_direction_in_case(const Eigen::Ref<const VecX>& column);
  void find_direction(const Vec6& z, const Vec6& zeta_A, double share);
  void find_tension_sources();
  void note_turning();
  const double* tension_sources(std::size_t cell, std::size_t block) const;
  void strain_rates(const Eigen::Ref<const VecX>& direction,
                    std::vector<Vec6>& rates) const override;

  // contact
  const NodeState& cell_state(std::size_t cell) const;
  const RodContact* contact_in(std::size_t cell) const;

  double cell_length(std::size_t cell) const {
    return (grid_[cell + 1] - grid_[cell]) * forcing_.length;
  }

  /// Length that a stage stands for, m.
  double weight_of(std::size_t stage) const;
  StrainsAtNodes strains_at_nodes() const;

  /// What of the model is the cell's.
  void enter_cell(std::size_t cell) {
    const std::size_t stage = cell * static_cast<std::size_t>(table_->stages);
    model_.h = cell_length(cell);
    if (fluid_.acts()) model_.fluid = fluid_.at(stage);
    if (tendons_) model_.tendons = &tendons_->at(stage);
    if (!varying_.empty()) model_.sections = &varying_[stage];
  }

  void add_contact_force(const RodContact& contact, int end, NodeState& state) const;
  void open_contacts(std::size_t cell, NodeState& state) const;
  void close_contacts(std::size_t node, NodeState& state) const;
  void contact_residual(RodResidual& r, int& row);
  ContactNode contact_node(const NodeState& state, std::size_t node) const;
  void add_force_columns(const RodContact& contact, int end, const NodeState& state, int column,
                         double* Y) const;

  // what others determine, forces of contacts and unknowns of tendons:
  // engine/rod/shooting_open_contact.cpp
  struct Open;
  struct ContactElimination;

  bool is_open() const;
  void begin_open_columns();
  void keep_open_columns(std::size_t zone);
  void record_open_motion(std::size_t open, int end, std::size_t zone, const double* Y);
  void add_open_force(std::size_t open, int end, const NodeState& state, double* Y);
  void enter_open_forces(std::size_t cell, std::size_t zone, double* Y);
  void close_open_forces(std::size_t node, std::size_t zone, double* Y);
  bool sweep_open_columns(std::size_t cell);
  void meet_open_columns(const RodContact& contact, const ContactRows& rows,
                         const ContactElimination& how, std::size_t zone);
  void orthogonalize_open_columns(std::size_t zone, const Vec3& turn, const Vec12& units,
                                  const Eigen::Matrix<double, 12, 6>& Q);
  void close_open_ports(const Port& base, const Port& tip, TensionPorts* tensions);
  void step_back_open(std::size_t zone, Vec6& z) const;
  void meet_back_open(std::size_t zone, Vec6& z, Vec3& force) const;
  void add_open_directions();
  Mat6x12 base_wrench_by_state(const Port& base) const;
  Mat6x12 tip_wrench_by_state(const Port& tip) const;
  void open_contact_columns(std::size_t cell, double* Y);
  bool meet_contact(std::size_t contact, std::size_t zone, double* Y);

  std::size_t contact_count() const { return touch_ ? touch_->contacts.size() : 0; }

  const SectionProperties& section(std::size_t stage) const {
    return sections_.empty() ? section_ : sections_[stage];
  }

  const CellSection& coefficients_at(std::size_t stage) const {
    return varying_.empty() ? model_ : varying_[stage];
  }

  Vec3 rest_curvature(double s) const {
    return options_.along ? options_.along->rest_curvature(s) : section_.u_rest;
  }

  bool bent_at_rest() const {
    return options_.along ? options_.along->bent_at_rest() : !section_.u_rest.isZero();
  }

  std::size_t stage_count() const { return stages_.size(); }

  std::string name_;
  RodEnd base_, tip_;
  SectionProperties section_;                ///< of the base, if they vary
  std::vector<SectionProperties> sections_;  ///< of the stages; empty: the same everywhere
  ShootingOptions options_;
  const ArcTableau* table_;
  int cells_ = 0;
  bool extensible_ = false;
  std::vector<double> grid_;  ///< node positions s / L, cells_ + 1
  CellLaw law_ = CellLaw::kKirchhoff;
  const CellKernel* kernel_ = nullptr;

  // coefficients of the current solve
  CellModel model_;
  std::vector<CellSection> varying_;  ///< of the stages, where sections vary
  std::vector<CellSection> alike_;    ///< of one cell's stages, where they do not
  StageRates rates_;
  RodForcing forcing_;
  Immersion fluid_;
  RodScale scale_;       ///< L, EI/L², EI/L
  RodScale port_scale_;  ///< the same with the boundary layer's length, for orthonormalisation
  double noise_ = 1;     ///< row scales grow by this where round-off exceeds the tolerance
  double growth_ = 0;

  // unknowns and what the last evaluation found
  std::vector<CellStage> stages_;  ///< cells × stages
  std::vector<NodeState> starts_;  ///< segment starts; [0] is the base, before any load there
  std::vector<NodeState> nodes_;   ///< grid nodes as reached
  std::vector<std::size_t>
      segment_first_;                 ///< first cell of each segment, then the number of cells
  std::vector<std::size_t> load_at_;  ///< node of forcing_.loads[i]
  Vec6 tip_gap_ = Vec6::Zero(), base_gap_ = Vec6::Zero();              ///< left open now
  Vec6 tip_gap_start_ = Vec6::Zero(), base_gap_start_ = Vec6::Zero();  ///< as captured
  std::vector<Vec3> marked_;
  bool evaluated_ = false;

  // linearisation
  int columns_ = kNarrow;
  std::vector<Columns> zone_start_columns_;
  Columns cell_directions_;  ///< lifted × columns per cell

  /// Where the columns are recombined: at a segment's start or where a contact's rows are met.
  /// Zones lie between boundaries.
  struct Boundary {
    std::size_t node = 0;
    int segment = -1, contact = -1;
  };

  std::vector<Boundary> boundaries_;

  std::size_t zone_first(std::size_t zone) const {
    return zone == 0 ? 0 : boundaries_[zone - 1].node;
  }

  std::size_t zone_end(std::size_t zone) const {
    return zone < boundaries_.size() ? boundaries_[zone].node : static_cast<std::size_t>(cells_);
  }

  /// z' = R z + G_A zeta_A + g. Where a contact is met first, z = N z_met + P_A zeta_A + p, and its
  /// force moves by F z_met + F_A zeta_A + f.
  struct Recombination {
    Mat6 R, G_A;
    Vec6 g;
    Mat6 N, P_A;
    Vec6 p;
    Eigen::Matrix<double, 3, 6> F, F_A;
    Vec3 f;
  };

  std::vector<Recombination> recombinations_;
  double transition_ = 0;

  // direction and remembered unknowns
  std::vector<Vec12> start_direction_;
  std::vector<double> lifted_direction_;
  std::vector<NodeState> kept_starts_;
  std::vector<double> kept_lifted_;

  Track track_;
  Track rotation_track_{Track::Kind::kRotation};
  std::vector<double> reference_rotations_;  ///< 9 per stage
  long section_evaluations_ = 0;

  /// Only in a rod that may touch something.
  struct Touch {
    std::vector<Surface> surfaces;
    double radius = 0;
    std::vector<RodContact> contacts;
    std::vector<ContactRows> rows;
    ContactMotion motion;
    Columns opened;  ///< columns at the start of a cell with a contact
    std::vector<Vec3> kept, direction;

    void visit(Archive& archive) {
      cprsim::visit(contacts, archive);
      cprsim::visit(rows, archive);
      motion.visit(archive);
    }
  };

  std::unique_ptr<Touch> touch_;
  std::unique_ptr<RodTendons> tendons_;  ///< sections: stages
  TendonBorder border_;
  VecX tension_direction_;
  std::vector<Mat3> turning_;        ///< J_r(Omega) and its derivative along w, of each stage
  std::unique_ptr<RodDisks> disks_;  ///< null: none
  std::unique_ptr<Open> open_;  ///< of a rod that touches something or whose tendons ask for it

  bool finds_tensions() const { return tendons_ && tendons_->unknowns() > 0; }
};

}  // namespace cprsim
