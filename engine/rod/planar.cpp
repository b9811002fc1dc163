// SPDX-License-Identifier: BSD-3-Clause
// Setting up, coefficients of a solve, and the residual sweep; equations in
// engine/rod/planar_cell.h.
#include "engine/rod/planar.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/rod/arc_grid.h"

namespace cprsim {
namespace {

/// Section axes in plane axes, turned so that the tangent points along e1: what is left is a turn
/// about the tangent.
Mat3 section_offset(const Mat3& R_PS) {
  const double angle = std::atan2(R_PS(1, 2), R_PS(0, 2)), c = std::cos(angle), s = std::sin(angle);
  const Vec3 x = R_PS.col(0);
  Vec3 turned(0, c * x.y() - s * x.x(), x.z());
  turned.normalize();
  Mat3 offset;
  offset.col(0) = turned;
  offset.col(1) = Vec3::UnitX().cross(turned);
  offset.col(2) = Vec3::UnitX();
  return offset;
}

void add_row(RodResidual& r, double value, int row) {
  r.sum_squares += value * value;
  const double size = std::abs(value);
  const bool finite = std::isfinite(value);
  if (!finite) r.finite = false;
  if (size > r.largest || !finite) {
    r.largest = finite ? size : std::numeric_limits<double>::infinity();
    r.worst_row = row;
  }
}

}  // namespace

PlanarRod::PlanarRod(std::string name, PlanarHold base, PlanarHold tip, const Mat3& plane,
                     const Pose& X_WBase, const Mat3& R_WSection, const SectionProperties& section,
                     double length, const ShootingOptions& options)
    : name_(std::move(name)),
      base_(base),
      tip_(tip),
      plane_(plane),
      offset_(section_offset(plane.transpose() * R_WSection)),
      height_(plane.col(2).dot(X_WBase.p)),
      section_(section),
      options_(options),
      table_(&arc_tableau(options.integrator)),
      grid_(arc_grid(options.cells, options.stations, options.along.get())) {
  K_b_ = about_normal(section.K_bt);
  cells_ = static_cast<int>(grid_.size()) - 1;
  extensible_ = options.extension || options.shear;
  const auto n = static_cast<std::size_t>(cells_ * table_->stages);
  stages_.assign(n, PlanarStage{});
  list_sections();
  nodes_.assign(grid_.size(), PlanarNode{});
  load_at_ = nodes_at(grid_, options_.stations);
  const auto stages = static_cast<Eigen::Index>(n);
  angles_ = 2 * static_cast<Eigen::Index>(n + grid_.size());
  strains_ = angles_ + (options.rotary_inertia ? stages : 0);
  disk_angles_ = strains_ + (options.damping ? stages * (extensible_ ? 3 : 1) : 0);
  place_disks();
  track_.resize(disk_angles_ +
                (options.rotary_inertia ? static_cast<Eigen::Index>(disks_.size()) : 0));
  if (options.drag || options.line_loads) place_surroundings();
  forcing_.length = length;
  if (!options.tendons.empty()) place_tendons();
  const Vec3 tangent = plane_.transpose() * X_WBase.R.col(2);
  set_unloaded(std::atan2(tangent.y(), tangent.x()), plane_.leftCols<2>().transpose() * X_WBase.p);
}

void PlanarRod::place_surroundings() {
  around_ = std::make_unique<PlanarImmersion>(stages_.size(), plane_, offset_, height_);
  if (!options_.line_loads) return;
  std::vector<double> inside;
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const std::size_t cell = j / static_cast<std::size_t>(table_->stages);
    inside.push_back(0.5 * (grid_[cell] + grid_[cell + 1]));
  }
  around_->in_space().place(std::move(inside), options_.magnets);
}

void PlanarRod::enter(std::size_t cell) {
  model_.h = (grid_[cell + 1] - grid_[cell]) * forcing_.length;
  model_.first = cell * static_cast<std::size_t>(table_->stages);
  model_.sections = &coefficients_[model_.first];
  if (tendons_) model_.pulls = tendons_->at(model_.first);
  if (!around_) return;
  model_.around = around_->at(model_.first);
}

void PlanarRod::place_disks() {
  for (const DiskSpec& spec : options_.disks) {
    Disk disk;
    disk.node = nodes_at(grid_, {spec.s})[0];
    disk.mass = spec.mass;
    if (options_.rotary_inertia) disk.inertia = about_normal(disk_inertia(spec));
    disks_.push_back(disk);
  }
}

void PlanarRod::pass_disks(std::size_t node, PlanarNode& state) const {
  for (const Disk& disk : disks_) {
    if (disk.node != node) continue;
    for (int i = 0; i < 2; ++i)
      state.n[i] += disk.k * state.p[i] + disk.force[i];
    state.m += disk.k_J * state.theta + disk.moment;
  }
}

void PlanarRod::prepare(const StageRates& rates, const RodForcing& forcing) {
  rates_ = rates;
  forcing_ = forcing;
  assert(forcing_.loads.size() == load_at_.size());
  const double L = forcing_.length;
  model_.table = table_;
  set_coefficients(own_of(section_), model_);
  for (std::size_t j = 0; j < own_.size(); ++j)
    set_coefficients(own_[j], coefficients_[j]);
  const bool stretches = extensible_ || forcing.axial_softness > 0;
  law_ = !stretches      ? CellLaw::kKirchhoff
         : model_.k == 0 ? CellLaw::kExtensibleStatic
                         : CellLaw::kExtensible;
  double k = model_.k;
  if (around_) {
    around_->prepare(section_, rates, forcing_, track_, sections_);
    model_.immersion = around_.get();
    const Immersion& fluid = around_->in_space();
    if (fluid.acts()) law_ = stretches ? CellLaw::kExtensibleFluid : CellLaw::kKirchhoffFluid;
    k += fluid.stiffness();
  }
  if (tendons_) {
    law_ = immersed(law_) ? CellLaw::kTendonsFluid : CellLaw::kTendons;
    tendons_->in_space().set(forcing.tendons, L);
    model_.tendons = tendons_.get();
  }
  kernel_ = planar_kernel(table_->stages, law_);
  scale_ = {L, K_b_ / (L * L), K_b_ / L};
  // positions carry round-off eps L; inertia turns it into forces eps k L²
  constexpr double kRoundOff = 50 * std::numeric_limits<double>::epsilon();
  for (const Disk& disk : disks_)
    k += disk.mass * rates.c_v * rates.c_w / L;
  noise_ = std::max(1.0, kRoundOff * k * std::pow(L, 4) / (K_b_ * forcing_.tolerance));
  update_stage_inputs();
  choose_segments();
}

void PlanarRod::update_stage_inputs() {
  const auto n = static_cast<Eigen::Index>(stages_.size());
  const Vec2 gravity = plane_.leftCols<2>().transpose() * forcing_.gravity;
  const bool dynamic = rates_.dynamic();
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    PlanarStage& stage = stages_[j];
    const Own& own = own_[j];
    const PlanarSection& at = coefficients_[j];
    const auto i = static_cast<Eigen::Index>(j);
    Vec2 b = -own.weighing * gravity;
    stage.kappa0 = at.C_b * own.K_b * (own.kappa_rest + heat_curvature());
    stage.v0[0] = 1;
    stage.v0[1] = stage.b_J = 0;
    if (dynamic) {
      b += own.rhoA * (rates_.c_w * track_.x_h.segment<2>(2 * i) + track_.v_h.segment<2>(2 * i));
      if (options_.rotary_inertia)
        stage.b_J = own.rhoI * (rates_.c_w * track_.x_h[angles_ + i] + track_.v_h[angles_ + i]);
      if (options_.damping) {
        stage.kappa0 -= at.C_b * own.B_b * track_.x_h[strains_ + i];
        // v0 = C (K z - B v_h): with C = 1/(K + c_v B) this is z - C B (c_v z + v_h)
        if (extensible_) {
          const Eigen::Index of = strains_ + n + 2 * i;
          stage.v0[0] -= at.C_v[0] * own.B_v.x() * (rates_.c_v + track_.x_h[of]);
          stage.v0[1] -= at.C_v[1] * own.B_v.y() * track_.x_h[of + 1];
        }
      }
    }
    if (forcing_.heat.stretch != 0) {
      // C K of the stretch that heat adds
      stage.v0[0] += (1 - rates_.c_v * at.C_v[0] * own.B_v.x()) * forcing_.heat.stretch;
    }
    if (forcing_.relaxation > 0) b -= forcing_.relaxation * marked_[j];
    stage.b[0] = b.x();
    stage.b[1] = b.y();
  }
  for (std::size_t d = 0; d < disks_.size(); ++d) {
    Disk& disk = disks_[d];
    disk.k = disk.mass * rates_.c_v * rates_.c_w;
    disk.k_J = disk.inertia * rates_.c_v * rates_.c_w;
    disk.force = -disk.mass * plane_.leftCols<2>().transpose() * forcing_.gravity;
    disk.moment = 0;
    if (!dynamic) continue;
    const Eigen::Index i = 2 * (n + static_cast<Eigen::Index>(disk.node)),
                       angle = disk_angles_ + static_cast<Eigen::Index>(d);
    disk.force += disk.mass * (rates_.c_w * track_.x_h.segment<2>(i) + track_.v_h.segment<2>(i));
    if (options_.rotary_inertia)
      disk.moment = disk.inertia * (rates_.c_w * track_.x_h[angle] + track_.v_h[angle]);
  }
}

// Segments from the growth exponent; cells are shared out evenly. Starts move to the nodes last
// reached.
void PlanarRod::choose_segments() {
  double N = std::hypot(starts_.front().n[0], starts_.front().n[1]);
  if (evaluated_)
    for (const PlanarNode& node : nodes_)
      N = std::max(N, std::hypot(node.n[0], node.n[1]));
  const double around = around_ ? around_->in_space().stiffness() : 0;
  const auto growth = [&](const SectionProperties& own, const PlanarSection& at) {
    constexpr double kNoTorsion = std::numeric_limits<double>::infinity();
    const auto stiffness = [](double C) { return C > 0 ? 1 / C : 0; };
    return cprsim::growth_exponent(own, Vec3(1 / at.C_b, 1 / at.C_b, kNoTorsion),
                                   Vec3(stiffness(at.C_v[1]), 0, stiffness(at.C_v[0])),
                                   forcing_.length, at.k + around, N);
  };
  growth_ = growth(section_, model_);
  for (std::size_t j = 0; j < sections_.size(); ++j)
    growth_ = std::max(growth_, growth(sections_[j], coefficients_[j]));
  if (!disks_.empty()) {
    double k = model_.k;
    for (const Disk& disk : disks_)
      k += disk.k / forcing_.length;
    growth_ =
        std::max(growth_, forcing_.length * std::pow(k * model_.C_b, 0.25) / std::numbers::sqrt2);
  }
  const double layer = forcing_.length / std::max(1.0, growth_);
  port_scale_ = {layer, K_b_ / (layer * layer), K_b_ / layer};
  const int wanted = wanted_segments(growth_, cells_, segments());
  // before the first evaluation there are no states to start segments from
  if (wanted == segments() || !evaluated_) return;
  const PlanarNode base = starts_.front();
  segment_first_ = segment_starts(wanted, cells_);
  starts_.assign(static_cast<std::size_t>(wanted), base);
  for (std::size_t g = 1; g < starts_.size(); ++g)
    starts_[g] = nodes_[segment_first_[g]];
}

void PlanarRod::apply_load(std::size_t node, PlanarNode& state) const {
  for (std::size_t i = 0; i < load_at_.size(); ++i) {
    if (load_at_[i] != node) continue;
    const PointLoad& load = forcing_.loads[i];
    Vec3 F, T;
    if (load.follower) {
      const Vec3 f = offset_ * load.force;
      F = {state.c * f.x() - state.s * f.y(), state.s * f.x() + state.c * f.y(), 0};
      T = offset_ * load.torque;
    } else {
      F = plane_.transpose() * load.force;
      T = plane_.transpose() * load.torque;
    }
    state.n[0] -= F.x();
    state.n[1] -= F.y();
    state.m -= T.z();
  }
  pass_disks(node, state);
}

PlanarRod::Place PlanarRod::place(const Port& port) const {
  const Vec2 t = plane_.leftCols<2>().transpose() * port.R.col(2);
  const double norm = t.norm();
  return {t.x() / norm, t.y() / norm, plane_.leftCols<2>().transpose() * port.p,
          plane_.leftCols<2>().transpose() * port.arm};
}

// Position and angle, or moment, or force and moment: what should vanish at an end.
Vec3 PlanarRod::end_value(PlanarHold hold, const PlanarNode& end, const Place& at,
                          double noise) const {
  const double m = end.m / (noise * scale_.moment);
  if (hold == PlanarHold::kFree)
    return {end.n[0] / (noise * scale_.force), end.n[1] / (noise * scale_.force), m};
  const double angle = hold == PlanarHold::kFixed
                           ? std::atan2(end.s * at.c - end.c * at.s, end.c * at.c + end.s * at.s)
                           : m;
  return {(end.p[0] - at.p.x()) / scale_.length, (end.p[1] - at.p.y()) / scale_.length, angle};
}

RodResidual PlanarRod::evaluate(const Port& base, const Port& tip) {
  const auto S = static_cast<std::size_t>(table_->stages);
  RodResidual r;
  int row = 0;
  auto add = [&](double value) { add_row(r, value, row++); };
  auto add_end = [&](const Vec3& values) {
    for (int i = 0; i < 3; ++i)
      add(values[i]);
  };
  const double force = scale_.force * noise_, moment = scale_.moment * noise_;
  add_end(end_value(base_, starts_.front(), place(base), noise_) - base_gap_);
  PlanarNode state = starts_.front();
  apply_load(0, state);
  nodes_[0] = state;
  for (std::size_t g = 0; g + 1 < segment_first_.size(); ++g) {
    if (g > 0) {
      // continuity between what the last segment reached and where this one starts
      const PlanarNode& start = starts_[g];
      add(state.theta - start.theta);
      for (int i = 0; i < 2; ++i)
        add((state.p[i] - start.p[i]) / scale_.length);
      for (int i = 0; i < 2; ++i)
        add((state.n[i] - start.n[i]) / force);
      add((state.m - start.m) / moment);
      state = start;
    }
    for (std::size_t c = segment_first_[g]; c < segment_first_[g + 1]; ++c) {
      enter(c);
      kernel_.evaluate(model_, &stages_[c * S], state, state);
      apply_load(c + 1, state);
      nodes_[c + 1] = state;
    }
  }
  section_evaluations_ += static_cast<long>(stages_.size());
  for (const PlanarStage& stage : stages_) {
    add(stage.residual_kappa * scale_.length / noise_);
    if (lifts_stretch(law_))
      for (double v : stage.residual_v)
        add(v / noise_);
  }
  add_end(end_value(tip_, state, place(tip), noise_) - tip_gap_);
  if (finds_tensions())
    for (double gap : tendons_->in_space().gaps())
      add(gap);
  evaluated_ = r.finite;
  return r;
}

std::string PlanarRod::row_name(int row) const {
  static const char* const kRows[][3] = {{"force 1", "force 2", "moment"},
                                         {"position 1", "position 2", "moment"},
                                         {"position 1", "position 2", "angle"}};
  if (row < 3) return "base of " + name_ + ", " + kRows[static_cast<int>(base_)][row];
  row -= 3;
  const int joins = 6 * (segments() - 1);
  if (row < joins) return "join " + std::to_string(row / 6 + 1) + " between segments of " + name_;
  row -= joins;
  const int each = lifts_stretch(law_) ? 3 : 1;
  const int law = static_cast<int>(stages_.size()) * each;
  if (row < law) {
    const int cell = row / each / table_->stages;
    return "strain law of " + name_ + " in cell " + std::to_string(cell + 1) + " of " +
           std::to_string(cells_);
  }
  if (row >= law + 3) return "tendons of " + name_;
  return "tip of " + name_ + ", " + kRows[static_cast<int>(tip_)][row - law];
}

int PlanarRod::unknown_count() const {
  return 6 * segments() + static_cast<int>(stages_.size()) * (lifts_stretch(law_) ? 3 : 1) +
         static_cast<int>(tendon_unknowns());
}

}  // namespace cprsim
