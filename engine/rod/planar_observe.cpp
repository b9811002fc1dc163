// SPDX-License-Identifier: BSD-3-Clause
// What a planar rod shows to time schemes, predictors and observers; as
// engine/rod/shooting_observe.cpp.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "engine/rod/arc_grid.h"
#include "engine/rod/planar.h"

namespace cprsim {

void PlanarRod::capture_gap(const Port& base, const Port& tip) {
  // a free end has no joint that could gape
  if (base_ != PlanarHold::kFree)
    base_gap_start_ = end_value(base_, starts_.front(), place(base), 1);
  if (tip_ != PlanarHold::kFree) tip_gap_start_ = end_value(tip_, nodes_.back(), place(tip), 1);
}

void PlanarRod::hold_gap(double fraction) {
  base_gap_ = fraction * base_gap_start_;
  tip_gap_ = fraction * tip_gap_start_;
}

// The same bow as ShootingRod's, to the side to which that bends about the section's x axis.
void PlanarRod::bow(const Port& base, const Port& tip) {
  const Place at = place(base);
  const Vec2 chord = place(tip).p - at.p;
  const double ratio = chord.norm() / forcing_.length;
  if (ratio > 0.999) return;
  const bool turns = base_ != PlanarHold::kFixed && ratio > 1e-6;
  const bool bent =
      std::any_of(own_.begin(), own_.end(), [](const Own& own) { return own.kappa_rest != 0; });
  set_unloaded(0, Vec2::Zero());
  const double unloaded = std::atan2(nodes_.back().p[1], nodes_.back().p[0]);
  set_unloaded(turns ? std::atan2(chord.y(), chord.x()) - unloaded : std::atan2(at.s, at.c), at.p);
  if (bent) return;  // a bent rod knows where to go
  const double A = std::min(2.2, 2 * std::sqrt(1 - ratio)), k = 2 * std::numbers::pi;
  const int axis = std::abs(offset_(2, 0)) >= std::abs(offset_(2, 1)) ? 0 : 1;
  const double side = std::copysign(A * k / forcing_.length, offset_(2, axis));
  const auto S = static_cast<std::size_t>(table_->stages);
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const std::size_t cell = j / S;
    const double s = grid_[cell] + (grid_[cell + 1] - grid_[cell]) * table_->c[j % S];
    stages_[j].kappa = side * std::cos(k * s);
  }
}

void PlanarRod::set_curve(const RodCurve& curve) {
  const auto place_at = [&](double s) {
    const Pose X = curve.pose(s);
    const Vec3 t = plane_.transpose() * X.R.col(2), p = plane_.transpose() * X.p;
    return std::pair<double, Vec2>(std::atan2(t.y(), t.x()), p.head<2>());
  };
  const auto [theta, p] = place_at(0);
  set_unloaded(theta, p);
  const auto S = static_cast<std::size_t>(table_->stages);
  double last = theta;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    PlanarNode& node = nodes_[k];
    const auto [angle, there] = place_at(grid_[k]);
    last += std::remainder(angle - last, 2 * std::numbers::pi);
    node.theta = last;
    node.c = std::cos(last);
    node.s = std::sin(last);
    node.p[0] = there.x();
    node.p[1] = there.y();
  }
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const std::size_t cell = j / S;
    const double s = grid_[cell] + (grid_[cell + 1] - grid_[cell]) * table_->c[j % S];
    const Pose X = curve.pose(s);
    stages_[j].kappa = plane_.col(2).dot(X.R * curve.curvature(s));
    const Vec2 there = plane_.leftCols<2>().transpose() * X.p;
    std::copy_n(there.data(), 2, stages_[j].p);
  }
  evaluated_ = true;  // segments may begin at the nodes
}

void PlanarRod::mark_positions() {
  marked_.resize(stages_.size());
  for (std::size_t j = 0; j < stages_.size(); ++j)
    marked_[j] = {stages_[j].p[0], stages_[j].p[1]};
}

void PlanarRod::fill_tracks() {
  if (tendons_) tendons_->in_space().fill_track();
  double* x = track_.x.data();
  for (const PlanarStage& stage : stages_)
    x = std::copy_n(stage.p, 2, x);
  for (const PlanarNode& node : nodes_)
    x = std::copy_n(node.p, 2, x);
  if (options_.rotary_inertia) {
    for (const PlanarStage& stage : stages_)
      *x++ = stage.theta;
    for (std::size_t d = 0; d < disks_.size(); ++d)
      track_.x[disk_angles_ + static_cast<Eigen::Index>(d)] = nodes_[disks_[d].node].theta;
  }
  if (!options_.damping) return;
  for (const PlanarStage& stage : stages_)
    *x++ = stage.kappa;
  if (!extensible_) return;
  for (const PlanarStage& stage : stages_)
    x = std::copy_n(stage.v, 2, x);
}

void PlanarRod::start_tracks() {
  accept_tracks();
  fill_tracks();
  if (tendons_) tendons_->in_space().start_track();
  track_.set_start(VecX(track_.x), VecX::Zero(track_.x.size()));
}

// Velocities that a direction of the unknowns gives stages and nodes, cell by cell:
// dtheta_j = dtheta_a + h sum a_jk dkappa_k, dtau_j = dtheta_j e3 × tau_j + dv_t t + dv_d d,
// dp_j = dp_a + h sum a_jk dtau_k, and where v is no unknown it follows from the law.
void PlanarRod::start_tracks_moving() {
  start_tracks();
  if (tendons_) {
    std::vector<Vec6> rates;
    strain_rates(Eigen::Map<const VecX>(lifted_direction_.data(),
                                        static_cast<Eigen::Index>(lifted_direction_.size())),
                 rates);
    tendons_->in_space().start_track_moving(rates);
  }
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto lifted = static_cast<std::size_t>(kernel_.lifted);
  const auto n = static_cast<Eigen::Index>(stages_.size());
  const Vec6& start = start_direction_.front();
  double dtheta = start[0];
  Vec2 dp = start.segment<2>(1), dn = start.segment<2>(3);
  const auto turn_followers = [&](std::size_t node) {
    for (std::size_t l = 0; l < load_at_.size(); ++l) {
      if (load_at_[l] != node || !forcing_.loads[l].follower) continue;
      const PlanarNode& at = nodes_[node];
      const Vec3 f = offset_ * forcing_.loads[l].force;
      dn -= dtheta * Vec2(-(at.s * f.x() + at.c * f.y()), at.c * f.x() - at.s * f.y());
    }
  };
  turn_followers(0);
  VecX v = VecX::Zero(track_.x.size());
  v.segment<2>(2 * n) = dp;
  for (std::size_t c = 0; c < static_cast<std::size_t>(cells_); ++c) {
    const double h = (grid_[c + 1] - grid_[c]) * forcing_.length;
    const PlanarStage* stage = &stages_[c * S];
    const double* d = &lifted_direction_[c * lifted];
    Vec2 dtau[kMaxStages];
    for (std::size_t j = 0; j < S; ++j) {
      const PlanarStage& at = stage[j];
      double turn = dtheta;
      for (std::size_t k = 0; k < S; ++k)
        turn += h * table_->a[j][k] * d[k];
      const Vec2 t(at.c, at.s), across(-at.s, at.c), force(at.n[0], at.n[1]);
      Vec2 dv = Vec2::Zero();
      if (lifts_stretch(law_)) dv = {d[S + 2 * j], d[S + 2 * j + 1]};
      if (law_ == CellLaw::kExtensibleStatic)
        dv = {coefficients_[c * S + j].C_v[0] * (t.dot(dn) + turn * across.dot(force)),
              coefficients_[c * S + j].C_v[1] * (across.dot(dn) - turn * t.dot(force))};
      dtau[j] = turn * Vec2(-at.tau[1], at.tau[0]) + dv[0] * t + dv[1] * across;
      const auto i = static_cast<Eigen::Index>(c * S + j);
      if (options_.rotary_inertia) v[angles_ + i] = turn;
      if (!options_.damping) continue;
      v[strains_ + i] = d[j];
      if (extensible_) v.segment<2>(strains_ + n + 2 * i) = dv;
    }
    for (std::size_t j = 0; j < S; ++j) {
      Vec2 at = dp;
      for (std::size_t k = 0; k < S; ++k)
        at += h * table_->a[j][k] * dtau[k];
      v.segment<2>(2 * static_cast<Eigen::Index>(c * S + j)) = at;
    }
    for (std::size_t j = 0; j < S; ++j) {
      dp += h * table_->b[j] * dtau[j];
      dtheta += h * table_->b[j] * d[j];
    }
    turn_followers(c + 1);
    for (std::size_t i = 0; options_.rotary_inertia && i < disks_.size(); ++i)
      if (disks_[i].node == c + 1) v[disk_angles_ + static_cast<Eigen::Index>(i)] = dtheta;
    v.segment<2>(2 * (n + static_cast<Eigen::Index>(c) + 1)) = dp;
  }
  track_.set_start(VecX(track_.x), v);
}

// values: curvature, stretch and shear of every stage, then six numbers for every segment's start,
// then for every node; then those of tendons.
RodModel::Unknowns PlanarRod::unknowns() const {
  Unknowns u;
  u.values.resize(count_values());
  double* to = u.values.data();
  for (const PlanarStage& stage : stages_) {
    *to++ = stage.kappa;
    to = std::copy_n(stage.v, 2, to);
  }
  for (const auto* list : {&starts_, &nodes_})
    for (const PlanarNode& node : *list) {
      *to++ = node.theta;
      to = std::copy_n(node.p, 2, to);
      to = std::copy_n(node.n, 2, to);
      *to++ = node.m;
    }
  if (finds_tensions())
    u.values.tail(tendons_->in_space().unknowns()) = tendons_->in_space().values();
  return u;
}

Eigen::Index PlanarRod::count_values() const {
  return static_cast<Eigen::Index>(3 * stages_.size() + 6 * (starts_.size() + nodes_.size())) +
         tendon_unknowns();
}

void PlanarRod::set_unknowns(const Unknowns& u) {
  const double* from = u.values.data();
  for (PlanarStage& stage : stages_) {
    stage.kappa = *from++;
    std::copy_n(from, 2, stage.v);
    from += 2;
  }
  const auto set = [](PlanarNode& node, const double* x) {
    node = {x[0], {x[1], x[2]}, {x[3], x[4]}, x[5], std::cos(x[0]), std::sin(x[0])};
  };
  const Eigen::Index found = tendon_unknowns();
  if (found > 0) tendons_->in_space().set_values(u.values.tail(found));
  const std::size_t all =
      (static_cast<std::size_t>(u.values.size() - found) - 3 * stages_.size()) / 6;
  const std::size_t then = all - nodes_.size();
  set(starts_.front(), from);
  // where segments were cut differently their starts are the nodes reached
  for (std::size_t g = 1; g < starts_.size(); ++g)
    set(starts_[g], from + 6 * (then == starts_.size() ? g : then + segment_first_[g]));
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    set(nodes_[k], from + 6 * (then + k));
}

void PlanarRod::predict(const std::vector<const Unknowns*>& past,
                        const std::vector<double>& weights) {
  assert(!past.empty() && past.size() == weights.size());
  const Eigen::Index size = count_values();
  Unknowns sum;
  sum.values = VecX::Zero(size);
  for (std::size_t i = 0; i < past.size(); ++i) {
    if (past[i]->values.size() != size) {
      set_unknowns(*past.back());
      return;
    }
    sum.values += weights[i] * past[i]->values;
  }
  set_unknowns(sum);
}

void PlanarRod::visit(Archive& archive) {
  archive(growth_);
  archive(evaluated_);
  archive.doubles(stages_);
  archive.resized_doubles(starts_, static_cast<std::size_t>(cells_));
  segment_first_ = segment_starts(static_cast<int>(starts_.size()), cells_);
  archive.doubles(nodes_);
  if (around_) around_->in_space().visit(archive);
  for (Track* track : tracks())
    track->visit(archive);
  if (tendons_) tendons_->in_space().visit(archive);
}

// Curvature, stretch and shear.
StrainsAtNodes PlanarRod::strains_at_nodes() const {
  return {*table_, grid_, [this](std::size_t j) {
            const PlanarStage& stage = stages_[j];
            Vec6 strain = Vec6::Zero();
            strain.head<3>() << stage.kappa, stage.v[0], stage.v[1];
            return strain;
          }};
}

RodSample PlanarRod::observe() const {
  RodSample sample;
  sample.length = forcing_.length;
  sample.radius = section_.half_width;
  sample.points.resize(nodes_.size());
  const auto n = static_cast<Eigen::Index>(stages_.size());
  const StrainsAtNodes strains = strains_at_nodes();
  const Mat3 to_section = offset_.transpose();
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    RodPoint& point = sample.points[k];
    const PlanarNode& node = nodes_[k];
    Mat3 turn = Mat3::Identity();
    turn.topLeftCorner<2, 2>() << node.c, -node.s, node.s, node.c;
    point.s = grid_[k];
    point.position = plane_ * Vec3(node.p[0], node.p[1], height_);
    point.rotation = plane_ * turn * offset_;
    point.force = plane_.leftCols<2>() * Vec2(node.n[0], node.n[1]);
    point.moment = node.m * plane_.col(2);
    point.velocity =
        plane_.leftCols<2>() * track_.v.segment<2>(2 * (n + static_cast<Eigen::Index>(k)));
    const Vec6 strain = strains(k);
    const std::size_t next =
        std::min(k, nodes_.size() - 2) * static_cast<std::size_t>(table_->stages);
    const double rest = options_.along
                            ? to_section.col(2).dot(options_.along->rest_curvature(grid_[k]))
                            : own_[next].kappa_rest;
    point.rest_curvature = (rest + heat_curvature()) * to_section.col(2);
    point.curvature = strain[0] * to_section.col(2);
    point.shear_stretch = to_section * Vec3(strain[1], strain[2], 0);
  }
  return sample;
}

double PlanarRod::weight_of(std::size_t stage) const {
  const std::size_t S = static_cast<std::size_t>(table_->stages), cell = stage / S;
  return (grid_[cell + 1] - grid_[cell]) * forcing_.length * table_->b[stage % S];
}

double PlanarRod::magnetic_energy(const MagneticSources& sources) const {
  if (!around_ || options_.magnets.empty()) return 0;
  const MagneticField field = view_of(sources);
  double energy = 0;
  for (std::size_t j = 0; j < stages_.size(); ++j)
    energy += weight_of(j) * around_->magnetic_energy(j, stages_[j], field);
  return energy;
}

ThermalEffort PlanarRod::thermal_effort() const {
  ThermalEffort effort;
  const auto S = static_cast<std::size_t>(table_->stages);
  const Vec3 normal = offset_.row(2);
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const double w = (grid_[j / S + 1] - grid_[j / S]) * forcing_.length * table_->b[j % S];
    const Own& own = own_[j];
    effort.first.head<3>() -=
        w * own.K_b * (stages_[j].kappa - own.kappa_rest - heat_curvature()) * normal;
    effort.second.head<3>() += w * own.K_b * normal.cwiseAbs2();
    if (!options_.extension) continue;
    effort.first[3] -= w * own.K_v.x() * (stages_[j].v[0] - 1 - forcing_.heat.stretch);
    effort.second[3] += w * own.K_v.x();
  }
  return effort;
}

RodEnergy PlanarRod::energy() const {
  RodEnergy e;
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto n = static_cast<Eigen::Index>(stages_.size());
  const Vec2 gravity = plane_.leftCols<2>().transpose() * forcing_.gravity;
  const double at_height = height_ * plane_.col(2).dot(forcing_.gravity);
  double carried = 0;
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const std::size_t cell = j / S;
    const double w = (grid_[cell + 1] - grid_[cell]) * forcing_.length * table_->b[j % S];
    const PlanarStage& stage = stages_[j];
    const Own& own = own_[j];
    const double bent = stage.kappa - own.kappa_rest - heat_curvature(),
                 stretched = options_.extension ? stage.v[0] - 1 - forcing_.heat.stretch : 0,
                 sheared = options_.shear ? stage.v[1] : 0;
    const auto i = static_cast<Eigen::Index>(j);
    e.kinetic += w * 0.5 * own.rhoA * track_.v.segment<2>(2 * i).squaredNorm();
    if (options_.rotary_inertia)
      e.kinetic += w * 0.5 * own.rhoI * track_.v[angles_ + i] * track_.v[angles_ + i];
    e.elastic += w * 0.5 *
                 (own.K_b * bent * bent + own.K_v.x() * stretched * stretched +
                  own.K_v.y() * sheared * sheared);
    e.gravity -= w * own.weighing * (gravity.dot(Vec2(stage.p[0], stage.p[1])) + at_height);
    const double n_t = stage.c * stage.n[0] + stage.s * stage.n[1],
                 n_d = stage.c * stage.n[1] - stage.s * stage.n[0];
    carried += w * (stage.m * stage.kappa + n_t * stage.v[0] + n_d * stage.v[1]);
    if (tendons_) carried -= w * tendons_->work(j, stage);
    if (!options_.damping) continue;
    const double kappa_t = track_.v[strains_ + i];
    e.damping_power += w * own.B_b * kappa_t * kappa_t;
    if (extensible_)
      e.damping_power += w * own.B_v.dot(track_.v.segment<2>(strains_ + n + 2 * i).cwiseAbs2());
  }
  if (around_) {
    std::vector<double> weights;
    for (std::size_t j = 0; j < stages_.size(); ++j)
      weights.push_back(weight_of(j));
    around_->add_powers(weights, stages_, track_, e);
    e.magnetic = magnetic_energy(forcing_.field);
  }
  e.set_feed_power(carried, forcing_.length, tendons_ ? &tendons_->in_space() : nullptr);
  for (std::size_t d = 0; d < disks_.size(); ++d) {
    const Disk& disk = disks_[d];
    const PlanarNode& node = nodes_[disk.node];
    const Eigen::Index i = 2 * (n + static_cast<Eigen::Index>(disk.node));
    e.kinetic += 0.5 * disk.mass * track_.v.segment<2>(i).squaredNorm();
    e.gravity -= disk.mass * forcing_.gravity.dot(plane_ * Vec3(node.p[0], node.p[1], height_));
    if (options_.rotary_inertia)
      e.kinetic +=
          0.5 * disk.inertia * std::pow(track_.v[disk_angles_ + static_cast<Eigen::Index>(d)], 2);
  }
  return e;
}

}  // namespace cprsim
