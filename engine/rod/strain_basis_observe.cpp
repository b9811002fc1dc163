// SPDX-License-Identifier: BSD-3-Clause
// What a strain-basis rod shows to time schemes, predictors and observers.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "engine/math/so3.h"
#include "engine/rod/strain_basis.h"
#include "engine/rod/tableau.h"

namespace cprsim {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

void StrainRod::capture_gap(const Port& base, const Port& tip) {
  // a free end has no joint that could gape
  if (base_.held()) base_gap_start_ = base_.value(start_, base, scale_);
  if (tip_.held()) tip_gap_start_ = tip_.value(nodes_.back(), tip, scale_);
}

void StrainRod::hold_gap(double fraction) {
  base_gap_ = fraction * base_gap_start_;
  tip_gap_ = fraction * tip_gap_start_;
}

// The bow of ShootingRod, u = A k cos(k s / L) / L, projected onto the polynomials.
void StrainRod::bow(const Port& base, const Port& tip) {
  const Vec3 chord = tip.p - base.p;
  const double ratio = chord.norm() / forcing_.length;
  if (ratio > 0.999) return;
  Mat3 R = base.R;
  if (space_.freedoms() == 3) {  // the joint's axes may be spun against the section's
    const Mat3 now = rotation_of(start_);
    R = rotation_between(now.col(2), base.R.col(2)) * now;
  }
  const Vec3 unloaded = options_.along
                            ? Vec3(R * options_.along->unloaded(1, forcing_.length).p)
                            : Vec3(R * right_jacobian(-forcing_.length * section_.u_rest).col(2));
  if (!base_.fixed() && ratio > 1e-6) R = rotation_between(unloaded, chord) * R;
  set_unloaded({R, base.p});
  if (bent_at_rest()) return;  // a bent rod knows where to go
  const double A = std::min(2.2, 2 * std::sqrt(1 - ratio)), k = 2 * std::numbers::pi;
  // about the weaker axis
  const bool second = modes_[1].turns && space_.freedoms() == 6 && modes_[1].K < modes_[0].K;
  for (std::size_t e = 0; e < elements(); ++e)
    for (Eigen::Index i = 0; i < rule_.points(); ++i) {
      const double s = grid_[e] + (grid_[e + 1] - grid_[e]) * rule_.gauss.points[i];
      q_[e].row(second ? 1 : 0) += rule_.gauss.weights[i] * A * k / forcing_.length *
                                   std::cos(k * s) * rule_.phi.col(i).transpose();
    }
}

void StrainRod::set_curve(const RodCurve& curve) {
  set_unloaded(curve.pose(0));
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Pose X = curve.pose(grid_[k]);
    Eigen::Map<RowMatrix>(nodes_[k].R) = X.R;
    Eigen::Map<Vec3>(nodes_[k].p) = X.p;
  }
  for (std::size_t e = 0; e < elements(); ++e)
    for (Eigen::Index i = 0; i < rule_.points(); ++i) {
      const VecX phi = rule_.phi.col(i);
      const double s = grid_[e] + (grid_[e + 1] - grid_[e]) * rule_.gauss.points[i];
      const Vec3 bent = curve.curvature(s) - rest_curvature(e, phi);
      for (std::size_t a = 0; a < modes_.size(); ++a)
        if (modes_[a].turns)
          q_[e].row(static_cast<Eigen::Index>(a)) +=
              rule_.gauss.weights[i] * modes_[a].axis.dot(bent) * phi.transpose();
      points_[e * static_cast<std::size_t>(rule_.points()) + static_cast<std::size_t>(i)].p =
          curve.pose(s).p;
    }
}

void StrainRod::mark_positions() {
  marked_.clear();
  for (const StrainPoint& point : points_)
    marked_.push_back(point.p);
}

std::vector<Track*> StrainRod::tracks() {
  std::vector<Track*> all{&track_};
  if (tendons_) all.push_back(tendons_->track());
  if (options_.rotary_inertia) all.push_back(&rotation_track_);
  if (touch_ && touch_->turns()) all.push_back(touch_->turns());
  if (disks_ && disks_->turns()) all.push_back(disks_->turns());
  return all;
}

void StrainRod::fill_tracks() {
  if (tendons_) tendons_->fill_track();
  if (touch_) touch_->fill_turns();
  double* x = track_.x.data();
  for (const StrainPoint& point : points_)
    x = std::copy_n(point.p.data(), 3, x);
  for (const NodeState& node : nodes_)
    x = std::copy_n(node.p, 3, x);
  for (std::size_t e = 0; options_.damping && e < elements(); ++e) {
    // what damps is the rate of the whole strain, heat's part included
    for (std::size_t a = 0; a < modes_.size(); ++a)
      x[a] = thermal_strain(modes_[a], forcing_.heat);
    std::fill_n(x + modes_.size(), q_[e].size() - q_[e].rows(), 0.0);
    Eigen::Map<VecX>(x, q_[e].size()) += Eigen::Map<const VecX>(q_[e].data(), q_[e].size());
    x += q_[e].size();
  }
  for (std::size_t j = 0; j < rotary_.size(); ++j) {
    std::copy_n(rotary_[j].theta, 3, rotation_track_.x.data() + 3 * j);
    std::copy_n(rotary_[j].omega, 3, rotation_track_.v.data() + 3 * j);
  }
  if (disks_) disks_->fill_turns();
}

void StrainRod::accept_tracks() {
  if (touch_) touch_->accept_contacts();
  if (tendons_) tendons_->accept();
  for (std::size_t j = 0; j < rotary_.size(); ++j)
    Eigen::Map<RowMatrix>(rotary_[j].R_start) = points_[j].R;
  if (disks_) disks_->accept();
}

void StrainRod::start_tracks() {
  accept_tracks();
  if (tendons_) tendons_->start_track();
  for (Rotary& rotary : rotary_) {
    std::fill_n(rotary.theta, 3, 0.0);
    std::fill_n(rotary.omega, 3, 0.0);
  }
  if (disks_) disks_->start();
  fill_tracks();
  track_.set_start(VecX(track_.x), VecX::Zero(track_.x.size()));
  const Eigen::Index turns = rotation_track_.x.size();
  if (options_.rotary_inertia) rotation_track_.set_start(VecX::Zero(turns), VecX::Zero(turns));
  if (touch_) touch_->start_turns();
}

// The direction taken as a velocity, through the variational equations that gave it.
void StrainRod::start_tracks_moving() {
  start_tracks();
  if (tendons_) {
    std::vector<Vec6> rates;
    strain_rates(direction_, rates);
    tendons_->start_track_moving(rates);
  }
  VecX v = VecX::Zero(track_.x.size());
  const VecX moving = direction_with_forces();
  Eigen::Index at = 0;
  for (const auto* moves : {&point_moves_, &node_moves_})
    for (const Rows3& columns : *moves) {
      v.segment<3>(at) = columns * moving;
      at += 3;
    }
  for (std::size_t e = 0; options_.damping && e < elements(); ++e) {
    MatX q_t = MatX::Zero(q_[e].rows(), q_[e].cols());
    for (std::size_t f = 0; f < free_modes_.size(); ++f)
      q_t.row(static_cast<Eigen::Index>(free_modes_[f])) =
          unit(modes_[free_modes_[f]]) *
          direction_.segment(space_.state.cols() + first_unknown(e, f), rule_.functions())
              .transpose();
    Eigen::Map<MatX>(v.data() + at, q_t.rows(), q_t.cols()) = q_t;
    at += q_t.size();
  }
  track_.set_start(VecX(track_.x), v);
  if (disks_) {
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      disks_->set_rate(k, node_turns_[k] * moving);
    disks_->start_moving();
  }
  for (std::size_t j = 0; j < rotary_.size(); ++j) {
    const Vec3 omega = points_[j].R.transpose() * (point_turns_[j] * moving);
    std::copy_n(omega.data(), 3, rotary_[j].omega);
    rotation_track_.v.segment<3>(static_cast<Eigen::Index>(3 * j)) = omega;
  }
  if (options_.rotary_inertia)
    rotation_track_.set_start(VecX::Zero(rotation_track_.x.size()), VecX(rotation_track_.v));
}

// As solutions from other instants are looked at a strain is a whole one, heat's part included.
void StrainRod::add_thermal_strain(double sign, const ThermalStrain& heat,
                                   Eigen::Ref<MatX> q) const {
  if (heat.none()) return;
  for (std::size_t a = 0; a < modes_.size(); ++a)
    if (modes_[a].listed)
      q(static_cast<Eigen::Index>(a), 0) += sign * thermal_strain(modes_[a], heat);
}

RodModel::Unknowns StrainRod::unknowns() const {
  Unknowns u;
  u.starts = {start_};
  const Eigen::Index size = q_[0].size();
  u.values.resize(size * static_cast<Eigen::Index>(q_.size()));
  for (std::size_t e = 0; e < elements(); ++e) {
    Eigen::Map<MatX> whole(u.values.data() + static_cast<Eigen::Index>(e) * size, q_[e].rows(),
                           q_[e].cols());
    whole = q_[e];
    add_thermal_strain(1, forcing_.heat, whole);
  }
  if (finds_tensions()) {
    u.values.conservativeResize(u.values.size() + tendons_->unknowns());
    u.values.tail(tendons_->unknowns()) = tendons_->values();
  }
  if (touch_) {
    u.nodes = nodes_;
    u.contacts = touch_->contacts();
  }
  return u;
}

void StrainRod::set_unknowns(const Unknowns& u) {
  if (touch_) {
    nodes_ = u.nodes;  // contacts look for what is near from there
    touch_->set_contacts(u.contacts);
  }
  start_ = u.starts.front();
  const Eigen::Index size = q_[0].size();
  for (std::size_t e = 0; e < elements(); ++e)
    std::copy_n(u.values.data() + static_cast<Eigen::Index>(e) * size, size, q_[e].data());
  for (MatX& q : q_)
    add_thermal_strain(-1, forcing_.heat, q);
  if (finds_tensions()) tendons_->set_values(u.values.tail(tendons_->unknowns()));
}

void StrainRod::predict(const std::vector<const Unknowns*>& past,
                        const std::vector<double>& weights) {
  assert(!past.empty() && past.size() == weights.size());
  Unknowns sum = *past.front();
  sum.contacts = past.back()->contacts;  // the set is what it last was, its forces a start
  sum.nodes = past.back()->nodes;
  sum.values.setZero();
  const NodeState& first = past.front()->starts.front();
  // increments from the first, so that only what moves in this rod's space is extrapolated
  Vec12 y = Vec12::Zero();
  for (std::size_t i = 0; i < past.size(); ++i) {
    const NodeState& s = past[i]->starts.front();
    sum.values += weights[i] * past[i]->values;
    Vec12 from_first;
    from_first << log_so3(rotation_of(s) * rotation_of(first).transpose()),
        position_of(s) - position_of(first), force_of(s) - force_of(first),
        moment_of(s) - moment_of(first);
    y += weights[i] * from_first;
  }
  y = space_.state * (space_.state.transpose() * y);
  NodeState& start = sum.starts.front();
  Eigen::Map<RowMatrix>(start.R) = orthonormalized(exp_so3(y.head<3>()) * Mat3(rotation_of(first)));
  Eigen::Map<Vec3>(start.p) += y.segment<3>(3);
  Eigen::Map<Vec3>(start.n) += y.segment<3>(6);
  Eigen::Map<Vec3>(start.m) += y.segment<3>(9);
  set_unknowns(sum);
}

void StrainRod::visit(Archive& archive) {
  archive(growth_);
  archive(evaluated_);
  std::vector<NodeState> start{start_};
  archive.doubles(start);
  start_ = start.front();
  for (MatX& q : q_)
    archive(q);
  archive.doubles(points_);
  archive.doubles(nodes_);
  archive.doubles(turns_);
  archive.doubles(rotary_);
  fluid_.visit(archive);
  for (Track* track : tracks())
    track->visit(archive);
  if (tendons_) tendons_->visit(archive);
  if (disks_) disks_->visit(archive);
  if (touch_) touch_->visit(archive);
}

RodSample StrainRod::observe() const {
  RodSample sample;
  sample.length = forcing_.length;
  sample.radius = section_.half_width;
  const auto add = [&](std::size_t e, double x, std::size_t moving) -> RodPoint& {
    RodPoint point;
    point.s = grid_[e] + (grid_[e + 1] - grid_[e]) * x;
    const VecX phi = legendre(x, rule_.order);
    point.curvature = strain(e, phi, true);
    point.shear_stretch = strain(e, phi, false);
    point.rest_curvature = rest_curvature(e, phi);
    point.velocity = track_.v.segment<3>(3 * static_cast<Eigen::Index>(moving));
    sample.points.push_back(point);
    return sample.points.back();
  };
  const auto add_border = [&](std::size_t e, double x, std::size_t node) {
    RodPoint& point = add(e, x, points_.size() + node);
    point.position = position_of(nodes_[node]);
    point.rotation = rotation_of(nodes_[node]);
    point.force = force_of(nodes_[node]);
    point.moment = moment_of(nodes_[node]);
  };
  for (std::size_t e = 0; e < elements(); ++e) {
    add_border(e, 0, e);
    for (Eigen::Index i = 0; i < rule_.points(); ++i) {
      const auto at = e * static_cast<std::size_t>(rule_.points()) + static_cast<std::size_t>(i);
      RodPoint& point = add(e, rule_.gauss.points[i], at);
      point.position = points_[at].p;
      point.rotation = points_[at].R;
      point.force = points_[at].n;
      point.moment = points_[at].m;
    }
  }
  add_border(elements() - 1, 1, elements());
  return sample;
}

// Between its own points the equilibrium is known, too: sections by one Magnus step, wrenches as
// the polynomials that the integration matrix integrates.
RodField StrainRod::field() const {
  RodField f;
  f.table = &arc_tableau(ArcIntegrator::kGauss6);
  const int pieces = static_cast<int>(rule_.points());
  const Eigen::Index G = rule_.points();
  for (std::size_t e = 0; e < elements(); ++e)
    for (int c = 0; c < pieces; ++c) {
      f.cells.push_back(length_of(e) / pieces);
      for (int j = 0; j < f.table->stages; ++j) {
        const double x = (c + f.table->c[j]) / pieces;
        Eigen::Index from = G - 1;
        while (from >= 0 && rule_.gauss.points[from] > x)
          --from;
        const auto first = e * static_cast<std::size_t>(G);
        const Mat3 R = from < 0 ? Mat3(rotation_of(nodes_[e]))
                                : points_[first + static_cast<std::size_t>(from)].R;
        const StrainRule::Step step = rule_.step(from < 0 ? 0 : rule_.gauss.points[from], x);
        FieldPoint point{turn(e, step, R).R_end, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        point.tau = point.R * strain(e, legendre(x, rule_.order), false);
        const VecX weights = interpolation_weights(rule_.gauss, x);
        for (Eigen::Index i = 0; i < G; ++i) {
          point.n += weights[i] * points_[first + static_cast<std::size_t>(i)].n;
          point.m += weights[i] * points_[first + static_cast<std::size_t>(i)].m;
        }
        f.points.push_back(point);
        const double begin = grid_[e], width = grid_[e + 1] - begin, s = begin + width * x;
        if (options_.along) f.sections.push_back(options_.along->at(s, begin + 0.5 * width));
        if (fluid_.field()) {
          Vec3 p = Vec3::Zero();
          for (Eigen::Index i = 0; i < G; ++i)
            p += weights[i] * points_[first + static_cast<std::size_t>(i)].p;
          f.magnetic.push_back(fluid_.outer_stiffness(begin + 0.5 * width, point.R, p));
        }
        if (!tendons_) continue;
        const VecX phi = legendre(x, rule_.order);
        MatX held;
        const Mat6 stiffness =
            tendons_->stiffness(s, s, strain(e, phi, true), strain(e, phi, false), &held);
        f.add_tendons(stiffness, held);
      }
    }
  if (disks_) disks_->describe(static_cast<std::size_t>(pieces), f);
  f.base = start_;
  f.tip = nodes_.back();
  describe_section(f, section_, options_.shear, options_.extension);
  return f;
}

}  // namespace cprsim
