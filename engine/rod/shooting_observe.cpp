// SPDX-License-Identifier: BSD-3-Clause
// What a shooting rod shows to time schemes, predictors and observers.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "engine/math/so3.h"
#include "engine/rod/arc_grid.h"
#include "engine/rod/shooting.h"

namespace cprsim {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Eigen::Map<const Vec3> vec(const double* p) {
  return Eigen::Map<const Vec3>(p);
}

}  // namespace

void ShootingRod::capture_gap(const Port& base, const Port& tip) {
  // a free end has no joint that could gape
  if (base_.held()) base_gap_start_ = base_.value(starts_.front(), base, scale_);
  if (tip_.held()) tip_gap_start_ = tip_.value(nodes_.back(), tip, scale_);
}

void ShootingRod::hold_gap(double fraction) {
  base_gap_ = fraction * base_gap_start_;
  tip_gap_ = fraction * tip_gap_start_;
}

// The buckled clamped column, theta(s) = A sin(2 pi s / L) about the weaker axis, has the chord L
// J_0(A), and J_0(A) = 1 - A²/4 + ...; where the base's joint can turn, the chord is laid towards
// the tip.
void ShootingRod::bow(const Port& base, const Port& tip) {
  const Vec3 chord = tip.p - base.p;
  const double ratio = chord.norm() / forcing_.length;
  if (ratio > 0.999) return;
  Mat3 R = base.R;
  const Vec3 unloaded = options_.along
                            ? Vec3(R * options_.along->unloaded(1, forcing_.length).p)
                            : Vec3(R * right_jacobian(-forcing_.length * section_.u_rest).col(2));
  if (!base_.fixed() && ratio > 1e-6) R = rotation_between(unloaded, chord) * R;
  set_unloaded({R, base.p});
  if (bent_at_rest()) return;  // a bent rod knows where to go
  const double A = std::min(2.2, 2 * std::sqrt(1 - ratio)), k = 2 * std::numbers::pi;
  const int axis = section_.K_bt.x() <= section_.K_bt.y() ? 0 : 1;
  const auto S = static_cast<std::size_t>(table_->stages);
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const std::size_t cell = j / S;
    const double s = grid_[cell] + (grid_[cell + 1] - grid_[cell]) * table_->c[j % S];
    stages_[j].w[axis] = A * k / forcing_.length * std::cos(k * s);
  }
}

void ShootingRod::set_curve(const RodCurve& curve) {
  set_unloaded(curve.pose(0));
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Pose X = curve.pose(grid_[k]);
    Eigen::Map<RowMatrix>(nodes_[k].R) = X.R;
    Eigen::Map<Vec3>(nodes_[k].p) = X.p;
  }
  const auto S = static_cast<std::size_t>(table_->stages);
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const std::size_t cell = j / S;
    const double s = grid_[cell] + (grid_[cell + 1] - grid_[cell]) * table_->c[j % S];
    Eigen::Map<Vec3>(stages_[j].w) = curve.curvature(s);
    Eigen::Map<Vec3>(stages_[j].p) = curve.pose(s).p;
  }
  evaluated_ = true;  // segments may begin at the nodes
}

void ShootingRod::mark_positions() {
  marked_.resize(stages_.size());
  for (std::size_t j = 0; j < stages_.size(); ++j)
    marked_[j] = vec(stages_[j].p);
}

void ShootingRod::fill_tracks() {
  if (tendons_) tendons_->fill_track();
  if (touch_) touch_->motion.fill_turns(nodes_, rates_);
  if (disks_) disks_->fill_turns();
  Eigen::Index i = 0;
  auto put = [&](const double* value) {
    track_.x.segment<3>(i) = vec(value);
    i += 3;
  };
  for (const CellStage& stage : stages_)
    put(stage.p);
  for (const NodeState& node : nodes_)
    put(node.p);
  if (options_.damping) {
    for (const CellStage& stage : stages_)
      put(stage.u);
    if (extensible_)
      for (const CellStage& stage : stages_)
        put(stage.v);
  }
  if (!options_.rotary_inertia) return;
  i = 0;
  for (const CellStage& stage : stages_) {
    rotation_track_.x.segment<3>(i) = vec(stage.theta);
    rotation_track_.v.segment<3>(i) = vec(stage.omega);
    i += 3;
  }
}

void ShootingRod::accept_tracks() {
  accept_contacts();
  if (tendons_) tendons_->accept();
  if (disks_) disks_->accept();
  if (!options_.rotary_inertia) return;
  for (std::size_t j = 0; j < stages_.size(); ++j)
    std::copy_n(stages_[j].R, 9, &reference_rotations_[9 * j]);
}

void ShootingRod::start_tracks() {
  accept_tracks();
  if (tendons_) tendons_->start_track();
  if (disks_) disks_->start();
  for (CellStage& stage : stages_) {
    std::fill_n(stage.theta, 3, 0.0);
    std::fill_n(stage.omega, 3, 0.0);
  }
  fill_tracks();
  track_.set_start(track_.x, VecX::Zero(track_.x.size()));
  for (Track* turns : tracks())
    if (turns->kind == Track::Kind::kRotation)
      turns->set_start(VecX::Zero(turns->x.size()), VecX::Zero(turns->x.size()));
}

// Velocities that a direction of the unknowns gives stages and nodes, cell by cell:
// phi_j = phi_a + R_j J_r(Omega_j) dOmega_j, dtau_j = phi_j × tau_j + R_j dv_j, dp_j = dp_a + h sum
// a_jk dtau_k, and where v is no unknown dv_j = C_se R_j^T (dn + n_j × phi_j) with dn that of the
// cell's start.
void ShootingRod::start_tracks_moving() {
  start_tracks();
  if (tendons_) {
    std::vector<Vec6> rates;
    note_turning();
    strain_rates(Eigen::Map<const VecX>(lifted_direction_.data(),
                                        static_cast<Eigen::Index>(lifted_direction_.size())),
                 rates);
    tendons_->start_track_moving(rates);
  }
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto lifted = static_cast<std::size_t>(kernel_->lifted);
  const auto n = static_cast<Eigen::Index>(stages_.size());
  const Eigen::Index strains = 3 * (n + static_cast<Eigen::Index>(nodes_.size()));
  Vec12 start = start_direction_.front();
  auto phi = start.head<3>(), dp = start.segment<3>(3), dn = start.segment<3>(6);
  auto turn_followers = [&](std::size_t node) {
    for (std::size_t l = 0; l < load_at_.size(); ++l)
      if (load_at_[l] == node && forcing_.loads[l].follower)
        dn += (rotation_of(nodes_[node]) * forcing_.loads[l].force).cross(phi);
  };
  turn_followers(0);
  track_.v.segment<3>(3 * n) = dp;
  for (std::size_t c = 0; c < static_cast<std::size_t>(cells_); ++c) {
    const double h = (grid_[c + 1] - grid_[c]) * forcing_.length;
    CellStage* stage = &stages_[c * S];
    const double* d = &lifted_direction_[c * lifted];
    std::vector<Vec3> dtau(S), du(S), dv(S, Vec3::Zero());
    Vec3 dOmega_end = Vec3::Zero(), Omega_end = Vec3::Zero();
    for (std::size_t j = 0; j < S; ++j) {
      Vec3 dOmega = Vec3::Zero();
      for (std::size_t k = 0; k < S; ++k)
        dOmega += h * table_->a[j][k] * vec(d + 3 * k);
      const Vec3 Omega = vec(stage[j].Omega), w = vec(stage[j].w), dw = vec(d + 3 * j);
      const Mat3 R = Eigen::Map<const RowMatrix>(stage[j].R), J_r = right_jacobian(Omega);
      du[j] = J_r * dw + right_jacobian_derivative(Omega, w) * dOmega;
      const Vec3 phi_j = phi + R * (J_r * dOmega);
      if (lifts_stretch(law_)) dv[j] = vec(d + 3 * S + 3 * j);
      if (law_ == CellLaw::kExtensibleStatic || law_ == CellLaw::kUnloadedExtensible)
        dv[j] = vec(coefficients_at(c * S + j).C_se)
                    .cwiseProduct(R.transpose() * (dn + vec(stage[j].n).cross(phi_j)));
      dtau[j] = phi_j.cross(vec(stage[j].tau)) + R * dv[j];
      Eigen::Map<Vec3>(stage[j].omega) = R.transpose() * phi_j;
      dOmega_end += h * table_->b[j] * dw;
      Omega_end += h * table_->b[j] * w;
    }
    for (std::size_t j = 0; j < S; ++j) {
      Vec3 at = dp;
      for (std::size_t k = 0; k < S; ++k)
        at += h * table_->a[j][k] * dtau[k];
      const auto i = 3 * static_cast<Eigen::Index>(c * S + j);
      track_.v.segment<3>(i) = at;
      if (options_.rotary_inertia) rotation_track_.v.segment<3>(i) = vec(stage[j].omega);
      if (!options_.damping) continue;
      track_.v.segment<3>(strains + i) = du[j];
      if (extensible_) track_.v.segment<3>(strains + 3 * n + i) = dv[j];
    }
    for (std::size_t j = 0; j < S; ++j)
      dp += h * table_->b[j] * dtau[j];
    phi += Mat3(rotation_of(nodes_[c + 1])) * (right_jacobian(Omega_end) * dOmega_end);
    turn_followers(c + 1);
    if (disks_) disks_->set_rate(c + 1, phi);
    track_.v.segment<3>(3 * (n + static_cast<Eigen::Index>(c) + 1)) = dp;
  }
  track_.set_start(track_.x, VecX(track_.v));
  if (disks_) disks_->start_moving();
  if (options_.rotary_inertia)
    rotation_track_.set_start(VecX::Zero(rotation_track_.x.size()), VecX(rotation_track_.v));
}

RodModel::Unknowns ShootingRod::unknowns() const {
  Unknowns u;
  u.values.resize(static_cast<Eigen::Index>(6 * stages_.size()));
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    u.values.segment<3>(static_cast<Eigen::Index>(6 * j)) = vec(stages_[j].w);
    u.values.segment<3>(static_cast<Eigen::Index>(6 * j + 3)) = vec(stages_[j].v);
  }
  if (finds_tensions()) {
    u.values.conservativeResize(u.values.size() + tendons_->unknowns());
    u.values.tail(tendons_->unknowns()) = tendons_->values();
  }
  u.starts = starts_;
  u.nodes = nodes_;
  if (touch_) u.contacts = touch_->contacts;
  return u;
}

void ShootingRod::set_unknowns(const Unknowns& u) {
  if (touch_) touch_->contacts = u.contacts;
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    std::copy_n(u.values.data() + 6 * j, 3, stages_[j].w);
    std::copy_n(u.values.data() + 6 * j + 3, 3, stages_[j].v);
  }
  if (finds_tensions()) tendons_->set_values(u.values.tail(tendons_->unknowns()));
  // contacts look for what is near from there, and prepare() may cut other segments
  nodes_ = u.nodes;
  if (u.starts.size() == starts_.size()) {
    starts_ = u.starts;
    return;
  }
  // segments were cut differently then
  starts_.front() = u.starts.front();
  for (std::size_t g = 1; g < starts_.size(); ++g)
    starts_[g] = u.nodes[segment_first_[g]];
}

void ShootingRod::predict(const std::vector<const Unknowns*>& past,
                          const std::vector<double>& weights) {
  assert(!past.empty() && past.size() == weights.size());
  Unknowns sum = *past.front();
  sum.contacts = past.back()->contacts;  // the set is what it last was, its forces a start
  sum.nodes = past.back()->nodes;
  for (const Unknowns* u : past)
    if (u->starts.size() != starts_.size()) {
      set_unknowns(*past.back());
      return;
    }
  sum.values *= weights[0];
  for (std::size_t i = 1; i < past.size(); ++i)
    sum.values += weights[i] * past[i]->values;
  for (std::size_t g = 0; g < sum.starts.size(); ++g) {
    const NodeState& first = past[0]->starts[g];
    Vec3 turn = Vec3::Zero(), p = Vec3::Zero(), n = Vec3::Zero(), m = Vec3::Zero();
    for (std::size_t i = 0; i < past.size(); ++i) {
      const NodeState& s = past[i]->starts[g];
      turn += weights[i] * log_so3(rotation_of(s) * rotation_of(first).transpose());
      p += weights[i] * position_of(s);
      n += weights[i] * force_of(s);
      m += weights[i] * moment_of(s);
    }
    NodeState& out = sum.starts[g];
    Eigen::Map<RowMatrix>(out.R) = orthonormalized(exp_so3(turn) * Mat3(rotation_of(first)));
    Eigen::Map<Vec3>(out.p) = p;
    Eigen::Map<Vec3>(out.n) = n;
    Eigen::Map<Vec3>(out.m) = m;
  }
  set_unknowns(sum);
}

void ShootingRod::visit(Archive& archive) {
  archive(growth_);
  archive(evaluated_);
  archive.doubles(stages_);
  archive.resized_doubles(starts_, static_cast<std::size_t>(cells_));
  segment_first_ = segment_starts(static_cast<int>(starts_.size()), cells_);
  archive.doubles(nodes_);
  fluid_.visit(archive);
  for (Track* track : tracks())
    track->visit(archive);
  archive.doubles(reference_rotations_);
  if (tendons_) tendons_->visit(archive);
  if (disks_) disks_->visit(archive);
  if (touch_) touch_->visit(archive);
}

StrainsAtNodes ShootingRod::strains_at_nodes() const {
  return {*table_, grid_, [this](std::size_t j) {
            Vec6 strain;
            strain << vec(stages_[j].u), vec(stages_[j].v);
            return strain;
          }};
}

RodSample ShootingRod::observe() const {
  RodSample sample;
  sample.length = forcing_.length;
  sample.radius = section_.half_width;
  sample.points.resize(nodes_.size());
  const auto n_stages = static_cast<Eigen::Index>(stages_.size());
  const StrainsAtNodes strains = strains_at_nodes();
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    RodPoint& point = sample.points[k];
    const NodeState& node = nodes_[k];
    point.s = grid_[k];
    point.position = position_of(node);
    point.rotation = rotation_of(node);
    point.force = force_of(node);
    point.moment = moment_of(node);
    point.velocity = track_.v.segment<3>(3 * (n_stages + static_cast<Eigen::Index>(k)));
    const Vec6 strain = strains(k);
    point.curvature = strain.head<3>();
    point.rest_curvature = rest_curvature(grid_[k]) + forcing_.heat.curvature;
    point.shear_stretch = strain.tail<3>();
  }
  return sample;
}

double ShootingRod::weight_of(std::size_t stage) const {
  const std::size_t S = static_cast<std::size_t>(table_->stages), cell = stage / S;
  return (grid_[cell + 1] - grid_[cell]) * forcing_.length * table_->b[stage % S];
}

double ShootingRod::magnetic_energy(const MagneticSources& sources) const {
  if (options_.magnets.empty()) return 0;
  const MagneticField field = view_of(sources);
  double energy = 0;
  for (std::size_t j = 0; j < stages_.size(); ++j)
    energy += weight_of(j) * fluid_.magnetic_energy(j, Eigen::Map<const RowMatrix>(stages_[j].R),
                                                    vec(stages_[j].p), field);
  return energy;
}

ThermalEffort ShootingRod::thermal_effort() const {
  ThermalEffort effort;
  const ThermalStrain& heat = forcing_.heat;
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const SectionProperties& own = section(j);
    const Vec3 bent = vec(stages_[j].u) - own.u_rest - heat.curvature;
    effort.add(weight_of(j), own, bent, stages_[j].v[2] - 1 - heat.stretch, options_.extension);
  }
  return effort;
}

RodEnergy ShootingRod::energy() const {
  RodEnergy e;
  const auto n = static_cast<Eigen::Index>(stages_.size());
  const Eigen::Index strains = 3 * (n + static_cast<Eigen::Index>(nodes_.size()));
  const auto free_stiffness = [&](const SectionProperties& own) {
    Vec3 K_se = Vec3::Zero();
    if (options_.shear) K_se.head<2>() = own.K_se.head<2>();
    if (options_.extension) K_se.z() = own.K_se.z();
    return K_se;
  };
  const Vec3 z(0, 0, 1 + forcing_.heat.stretch);
  double carried = 0;
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const double weight = weight_of(j);
    const CellStage& stage = stages_[j];
    const SectionProperties& own = section(j);
    const Vec3 K_se = free_stiffness(own);
    const auto i = 3 * static_cast<Eigen::Index>(j);
    const Vec3 bent = vec(stage.u) - own.u_rest - forcing_.heat.curvature,
               stretch = vec(stage.v) - z;
    e.kinetic += weight * 0.5 * own.rhoA * track_.v.segment<3>(i).squaredNorm();
    if (options_.rotary_inertia)
      e.kinetic += weight * 0.5 * vec(stage.omega).dot(own.rhoJ.cwiseProduct(vec(stage.omega)));
    e.elastic += weight * 0.5 *
                 (bent.dot(own.K_bt.cwiseProduct(bent)) + stretch.dot(K_se.cwiseProduct(stretch)));
    e.gravity -= weight * own.weighing_mass() * forcing_.gravity.dot(vec(stage.p));
    carried += weight * own_work(Eigen::Map<const RowMatrix>(stage.R), vec(stage.m), vec(stage.n),
                                 vec(stage.u), vec(stage.v), tendons_ ? &tendons_->at(j) : nullptr);
    if (options_.drag || options_.line_loads)
      fluid_.add_power(j, Eigen::Map<const RowMatrix>(stage.R).col(2), weight, track_, e);
    if (!options_.damping) continue;
    const Vec3 u_t = track_.v.segment<3>(strains + i);
    e.damping_power += weight * u_t.dot(own.B_bt.cwiseProduct(u_t));
    if (!extensible_) continue;
    const Vec3 v_t = track_.v.segment<3>(strains + 3 * n + i);
    e.damping_power += weight * v_t.dot(own.B_se.cwiseProduct(v_t));
  }
  e.magnetic = magnetic_energy(forcing_.field);
  e.set_feed_power(carried, forcing_.length, tendons_.get());
  if (disks_) disks_->add_energy(track_, e);
  if (touch_ && touch_->motion.friction() && rates_.dynamic())
    e.damping_power += friction_power(touch_->contacts, touch_->rows);
  return e;
}

}  // namespace cprsim
