// SPDX-License-Identifier: BSD-3-Clause
// Setting up, coefficients of a solve, and the residual sweep; equations in engine/rod/cell.h.
#include "engine/rod/shooting.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/math/so3.h"
#include "engine/rod/arc_grid.h"
#include "engine/rod/shooting_open.h"

namespace cprsim {
double growth_exponent(const SectionProperties& section, const Vec3& K_bt, const Vec3& K_se,
                       double length, double k, double N) {
  const double EI = std::min(K_bt.x(), K_bt.y());
  double gamma = length * std::pow(k / EI, 0.25) / std::sqrt(2.0);
  gamma = std::max(gamma, length * std::sqrt(N / EI));
  for (int i = 0; i < 3; ++i)
    if (K_se[i] > 0) gamma = std::max(gamma, length * std::sqrt(k / K_se[i]));
  if (section.rhoA > 0)
    gamma = std::max(gamma, length * std::sqrt(k / section.rhoA * section.rhoJ.z() / K_bt.z()));
  return gamma;
}

ShootingRod::ShootingRod(std::string name, const RodEnd& base, const RodEnd& tip,
                         const SectionProperties& section, double length,
                         const ShootingOptions& options)
    : name_(std::move(name)),
      base_(base),
      tip_(tip),
      section_(section),
      options_(options),
      table_(&arc_tableau(options.integrator)),
      grid_(arc_grid(options.cells, options.stations, options.along.get())),
      fluid_(options.drag || options.line_loads
                 ? (grid_.size() - 1) * static_cast<std::size_t>(table_->stages)
                 : 0) {
  cells_ = static_cast<int>(grid_.size()) - 1;
  extensible_ = options.extension || options.shear;
  const auto n = static_cast<std::size_t>(cells_ * table_->stages);
  stages_.assign(n, CellStage{});
  nodes_.assign(grid_.size(), NodeState{});
  starts_.assign(1, NodeState{});
  segment_first_ = {0, static_cast<std::size_t>(cells_)};
  load_at_ = nodes_at(grid_, options_.stations);
  const auto points = static_cast<Eigen::Index>(n + grid_.size());
  const auto strains = static_cast<Eigen::Index>(options_.damping ? n * (extensible_ ? 2 : 1) : 0);
  track_.resize(3 * (points + strains));
  if (options_.rotary_inertia) rotation_track_.resize(3 * static_cast<Eigen::Index>(n));
  reference_rotations_.assign(9 * n, 0);
  forcing_.length = length;
  if (options_.line_loads) {
    std::vector<double> inside;
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t cell = j / static_cast<std::size_t>(table_->stages);
      inside.push_back(0.5 * (grid_[cell] + grid_[cell + 1]));
    }
    fluid_.place(std::move(inside), options_.magnets);
  }
  if (options_.along) list_sections();
  if (!options_.tendons.empty()) place_tendons();
  if (!options_.disks.empty())
    disks_ = std::make_unique<RodDisks>(options_.disks, grid_, n, options_.rotary_inertia);
  set_unloaded(Pose{});
}

void ShootingRod::list_sections() {
  const auto S = static_cast<std::size_t>(table_->stages);
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const double from = grid_[j / S], to = grid_[j / S + 1];
    sections_.push_back(
        options_.along->at(from + (to - from) * table_->c[j % S], 0.5 * (from + to)));
  }
  varying_.resize(stages_.size());
}

// With constant u: R = R_0 exp(s u^), p = p_0 + R_0 (integral of exp) z, the integral being
// s J_l(s u) (engine/math/so3.h).
void ShootingRod::set_unloaded(const Pose& X_WBase) {
  NodeState state{};
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(state.R) = X_WBase.R;
  Eigen::Map<Vec3>(state.p) = X_WBase.p;
  starts_.assign(1, state);
  segment_first_ = {0, static_cast<std::size_t>(cells_)};
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    CellStage& stage = stages_[j];
    // Omega = s u stays parallel to u, so that its rate w is u itself
    Eigen::Map<Vec3>(stage.w) = section(j).u_rest;
    std::fill_n(stage.v, 2, 0.0);
    stage.v[2] = 1;
  }
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    nodes_[k] = state;
    if (options_.along) {
      const Pose X = X_WBase * options_.along->unloaded(grid_[k], forcing_.length);
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(nodes_[k].R) = X.R;
      Eigen::Map<Vec3>(nodes_[k].p) = X.p;
      continue;
    }
    const double s = grid_[k] * forcing_.length;
    const Vec3 turn = s * section_.u_rest;
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(nodes_[k].R) =
        X_WBase.R * exp_so3(turn);
    Eigen::Map<Vec3>(nodes_[k].p) += X_WBase.R * (s * right_jacobian(-turn).col(2));
  }
  evaluated_ = false;
}

Vec3 ShootingRod::compliance_bt(const SectionProperties& section) const {
  Vec3 K = section.K_bt;
  if (options_.damping) K += rates_.c_v * section.B_bt;
  return K.cwiseInverse();
}

// Rigid modes are zeros: shear and extension each only if the scene lists them.
Vec3 ShootingRod::compliance_se(const SectionProperties& section) const {
  Vec3 C = Vec3::Zero();
  const Vec3 B = options_.damping ? section.B_se : Vec3(Vec3::Zero());
  if (options_.shear) {
    C.x() = 1 / (section.K_se.x() + rates_.c_v * B.x());
    C.y() = 1 / (section.K_se.y() + rates_.c_v * B.y());
  }
  if (options_.extension) C.z() = 1 / (section.K_se.z() + rates_.c_v * B.z());
  C.z() += forcing_.axial_softness * forcing_.length * forcing_.length /
           section_.K_bt.head<2>().maxCoeff();
  return C;
}

CellSection ShootingRod::coefficients(const SectionProperties& section) const {
  CellSection c;
  Eigen::Map<Vec3>(c.C_bt) = compliance_bt(section);
  Eigen::Map<Vec3>(c.C_se) = compliance_se(section);
  c.k = section.rhoA * rates_.c_v * rates_.c_w + forcing_.relaxation;
  Eigen::Map<Vec3>(c.rhoJ) = section.rhoJ;
  return c;
}

void ShootingRod::prepare(const StageRates& rates, const RodForcing& forcing) {
  rates_ = rates;
  forcing_ = forcing;
  assert(forcing_.loads.size() == load_at_.size());
  const double L = forcing_.length;
  model_.table = table_;
  static_cast<CellSection&>(model_) = coefficients(section_);
  for (std::size_t j = 0; j < sections_.size(); ++j)
    varying_[j] = coefficients(sections_[j]);
  alike_.assign(static_cast<std::size_t>(table_->stages), model_);
  model_.sections = alike_.data();
  model_.rotary = options_.rotary_inertia && rates.dynamic();
  model_.c_v = rates.c_v;
  model_.c_w = rates.c_w;
  model_.body_rates = rates.body_rates;
  fluid_.prepare(section_, sections_, rates, forcing_, track_);
  model_.loaded = fluid_.loaded();
  model_.field = fluid_.field();
  if (tendons_) tendons_->set(forcing.tendons, forcing.length);
  law_ = law_of(rates.dynamic(), fluid_.acts());
  kernel_ = &cell_kernel(table_->stages, law_);

  const double EI = std::max(section_.K_bt.x(), section_.K_bt.y());
  scale_ = {L, EI / (L * L), EI / L};
  // positions carry round-off eps L; inertia turns it into forces eps k L²
  constexpr double kRoundOff = 50 * std::numeric_limits<double>::epsilon();
  double k = model_.k + fluid_.stiffness();
  if (disks_) {
    disks_->prepare(rates, forcing_, track_);
    k += disks_->stiffness() / L;
  }
  noise_ = std::max(1.0, kRoundOff * k * std::pow(L, 4) / (EI * forcing_.tolerance));
  update_stage_inputs();
  choose_segments();
}

CellLaw ShootingRod::law_of(bool moving, bool surrounded) const {
  const bool stretches = extensible_ || forcing_.axial_softness > 0;
  if (tendons_) return surrounded ? CellLaw::kTendonsFluid : CellLaw::kTendons;
  if (surrounded) return stretches ? CellLaw::kExtensibleFluid : CellLaw::kKirchhoffFluid;
  const bool pulled_back = forcing_.relaxation > 0;
  const bool unloaded = !moving && !pulled_back && forcing_.gravity.isZero(0);
  if (unloaded && has_unloaded_kernel(table_->stages))
    return stretches ? CellLaw::kUnloadedExtensible : CellLaw::kUnloaded;
  const bool inertia = (moving && section_.rhoA > 0) || pulled_back;
  const CellLaw law = !stretches ? CellLaw::kKirchhoff
                      : inertia  ? CellLaw::kExtensible
                                 : CellLaw::kExtensibleStatic;
  const bool general = (moving && options_.rotary_inertia) || !varying_.empty();
  return general ? generalized(law) : law;
}

const char* ShootingRod::section_law(bool moving) const {
  return law_name(law_of(moving, fluid_.acts() || (moving && options_.drag)));
}

void ShootingRod::update_stage_inputs() {
  // m = K (u - u_rest) + B u_t with u_t = c_v u + x_h: u = C (K u_rest - B x_h) + C m. Damping
  // acts on the rate alone, and the rest curvature has none.
  const auto n = static_cast<Eigen::Index>(stage_count());
  const auto strains = 3 * (n + static_cast<Eigen::Index>(nodes_.size()));
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    CellStage& stage = stages_[j];
    const SectionProperties& own = section(j);
    const CellSection& at = coefficients_at(j);
    const Vec3 C_bt = Eigen::Map<const Vec3>(at.C_bt), C_se = Eigen::Map<const Vec3>(at.C_se);
    const Vec3 K_rest = own.K_bt.cwiseProduct(own.u_rest + forcing_.heat.curvature);
    const auto i = 3 * static_cast<Eigen::Index>(j);
    Vec3 b = -own.weighing_mass() * forcing_.gravity;
    Vec3 u0 = C_bt.cwiseProduct(K_rest), v0(0, 0, 1);
    if (rates_.dynamic()) {
      b += own.rhoA * (rates_.c_w * track_.x_h.segment<3>(i) + track_.v_h.segment<3>(i));
      if (options_.damping) {
        u0 -= C_bt.cwiseProduct(own.B_bt.cwiseProduct(track_.x_h.segment<3>(strains + i)));
        // v0 = C (K z - B v_h): with C = 1/(K + c_v B) this is z - C B (c_v z + v_h)
        if (extensible_)
          v0 -= C_se.cwiseProduct(own.B_se.cwiseProduct(
              rates_.c_v * Vec3(0, 0, 1) + track_.x_h.segment<3>(strains + 3 * n + i)));
      }
      if (model_.rotary) {
        std::copy_n(&reference_rotations_[9 * j], 9, stage.R_start);
        Eigen::Map<Vec3>(stage.theta_h) = rotation_track_.x_h.segment<3>(i);
        Eigen::Map<Vec3>(stage.omega_h) = rotation_track_.v_h.segment<3>(i);
      }
    }
    if (forcing_.heat.stretch != 0) {
      // C K of the stretch that heat adds
      const double B = options_.damping ? own.B_se.z() : 0;
      v0.z() += (1 - rates_.c_v * C_se.z() * B) * forcing_.heat.stretch;
    }
    if (forcing_.relaxation > 0) b -= forcing_.relaxation * marked_[j];
    Eigen::Map<Vec3>(stage.b) = b;
    Eigen::Map<Vec3>(stage.u0) = u0;
    Eigen::Map<Vec3>(stage.v0) = v0;
  }
}

// Segments from the growth exponent; cells are shared out evenly. Starts move to the nodes last
// reached.
void ShootingRod::choose_segments() {
  double N = force_of(starts_.front()).norm();
  if (evaluated_)
    for (const NodeState& node : nodes_)
      N = std::max(N, force_of(node).norm());
  const auto growth = [&](const SectionProperties& own, const CellSection& at) {
    const Vec3 K_bt =
        at.C_bt[0] > 0 ? Vec3(Eigen::Map<const Vec3>(at.C_bt).cwiseInverse()) : own.K_bt;
    Vec3 K_se = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      if (at.C_se[i] > 0) K_se[i] = 1 / at.C_se[i];
    return cprsim::growth_exponent(own, K_bt, K_se, forcing_.length, at.k + fluid_.stiffness(), N);
  };
  growth_ = growth(section_, model_);
  for (std::size_t j = 0; j < sections_.size(); ++j)
    growth_ = std::max(growth_, growth(sections_[j], varying_[j]));
  if (disks_)
    growth_ = std::max(growth_, disks_->growth_exponent(section_.K_bt.head<2>().minCoeff(),
                                                        forcing_.length, model_.k));
  const double layer = forcing_.length / std::max(1.0, growth_);
  const double EI = scale_.moment * scale_.length;
  port_scale_ = {layer, EI / (layer * layer), EI / layer};
  const int wanted = wanted_segments(growth_, cells_, segments());
  // before the first evaluation there are no states to start segments from
  if (wanted == segments() || !evaluated_) return;
  const NodeState base = starts_.front();
  segment_first_ = segment_starts(wanted, cells_);
  starts_.assign(static_cast<std::size_t>(wanted), base);
  for (std::size_t g = 1; g < starts_.size(); ++g)
    starts_[g] = nodes_[segment_first_[g]];
}

void ShootingRod::apply_load(std::size_t node, NodeState& state) const {
  for (std::size_t i = 0; i < load_at_.size(); ++i) {
    if (load_at_[i] != node) continue;
    const PointLoad& load = forcing_.loads[i];
    const Mat3 R = load.follower ? Mat3(rotation_of(state)) : Mat3(Mat3::Identity());
    Eigen::Map<Vec3>(state.n) -= R * load.force;
    Eigen::Map<Vec3>(state.m) -= R * load.torque;
  }
  if (disks_) disks_->pass(node, state);
}

RodResidual& ShootingRod::add_row(RodResidual& r, double value, int row) const {
  r.sum_squares += value * value;
  const double size = std::abs(value);
  if (!std::isfinite(value)) r.finite = false;
  if (size > r.largest || !std::isfinite(value)) {
    r.largest = std::isfinite(value) ? size : std::numeric_limits<double>::infinity();
    r.worst_row = row;
  }
  return r;
}

RodResidual ShootingRod::evaluate(const Port& base, const Port& tip) {
  const auto S = static_cast<std::size_t>(table_->stages);
  RodResidual r;
  int row = 0;
  auto add = [&](const Vec6& values) {
    for (int i = 0; i < 6; ++i)
      add_row(r, values[i], row++);
  };
  RodScale loose = scale_;
  loose.force *= noise_;
  loose.moment *= noise_;
  add(base_.value(starts_.front(), base, loose) - base_gap_);

  NodeState state = starts_.front();
  apply_load(0, state);
  if (touch_) close_contacts(0, state);
  nodes_[0] = state;
  for (std::size_t g = 0; g + 1 < segment_first_.size(); ++g) {
    if (g > 0) {
      // continuity between what the last segment reached and where this one starts
      const NodeState& start = starts_[g];
      Vec6 pose, wrench;
      pose << log_so3(rotation_of(state) * rotation_of(start).transpose()),
          (position_of(state) - position_of(start)) / scale_.length;
      wrench << (force_of(state) - force_of(start)) / loose.force,
          (moment_of(state) - moment_of(start)) / loose.moment;
      add(pose);
      add(wrench);
      state = start;
    }
    for (std::size_t c = segment_first_[g]; c < segment_first_[g + 1]; ++c) {
      enter_cell(c);
      NodeState end;
      if (touch_) open_contacts(c, state);
      kernel_->evaluate(model_, &stages_[c * S], state, end);
      apply_load(c + 1, end);
      if (touch_) close_contacts(c + 1, end);
      nodes_[c + 1] = state = end;
    }
  }
  section_evaluations_ += static_cast<long>(stages_.size());
  for (const CellStage& stage : stages_) {
    for (double u : stage.residual_u)
      add_row(r, u * scale_.length / noise_, row++);
    if (lifts_stretch(law_))
      for (double v : stage.residual_v)
        add_row(r, v / noise_, row++);
  }
  add(tip_.value(state, tip, loose) - tip_gap_);
  if (touch_) contact_residual(r, row);
  if (finds_tensions())
    for (double gap : tendon_gaps())
      add_row(r, gap, row++);
  evaluated_ = r.finite;
  return r;
}

std::vector<Track*> ShootingRod::tracks() {
  std::vector<Track*> all{&track_};
  if (tendons_) all.push_back(tendons_->track());
  if (options_.rotary_inertia) all.push_back(&rotation_track_);
  if (touch_ && touch_->motion.friction()) all.push_back(touch_->motion.turns());
  if (disks_ && disks_->turns()) all.push_back(disks_->turns());
  return all;
}

std::string ShootingRod::row_name(int row) const {
  if (row < 6) return std::string("base of ") + name_ + ", " + base_.row_name(row);
  row -= 6;
  const int joins = 12 * (segments() - 1);
  if (row < joins) return "join " + std::to_string(row / 12 + 1) + " between segments of " + name_;
  row -= joins;
  const int law = static_cast<int>(stages_.size()) * (lifts_stretch(law_) ? 6 : 3);
  if (row < law) {
    const int stage = row / (lifts_stretch(law_) ? 6 : 3);
    const int cell = stage / table_->stages;
    return "strain law of " + name_ + " in cell " + std::to_string(cell + 1) + " of " +
           std::to_string(cells_);
  }
  row -= law;
  if (row < 6) return std::string("tip of ") + name_ + ", " + tip_.row_name(row);
  if (row >= 6 + 3 * static_cast<int>(contact_count())) return "tendons of " + name_;
  return "contact " + std::to_string((row - 6) / 3 + 1) + " of " + name_;
}

int ShootingRod::unknown_count() const {
  return 12 * segments() + 3 * static_cast<int>(contact_count()) +
         (tendons_ ? static_cast<int>(tendons_->unknowns()) : 0) +
         static_cast<int>(stages_.size()) * (lifts_stretch(law_) ? 6 : 3);
}

}  // namespace cprsim
