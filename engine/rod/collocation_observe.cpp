// SPDX-License-Identifier: BSD-3-Clause
// What a rod of splines shows to predictors and observers.
#include <cassert>
#include <cmath>

#include "engine/math/so3.h"
#include "engine/rod/collocation.h"
#include "engine/rod/tableau.h"

namespace cprsim {

RodModel::Unknowns CollocationRod::unknowns() const {
  Unknowns u;
  u.values.resize(13 * static_cast<Eigen::Index>(control_.size()));
  for (std::size_t k = 0; k < control_.size(); ++k)
    u.values.segment<13>(13 * static_cast<Eigen::Index>(k)) = control_[k];
  if (finds_tensions()) {
    u.values.conservativeResize(u.values.size() + tendons_->unknowns());
    u.values.tail(tendons_->unknowns()) = tendons_->values();
  }
  for (const Site& node : nodes_)
    u.nodes.push_back(state_of(value(node)));
  if (touch_) u.contacts = touch_->contacts();
  return u;
}

void CollocationRod::set_unknowns(const Unknowns& u) {
  for (std::size_t k = 0; k < control_.size(); ++k)
    control_[k] = u.values.segment<13>(13 * static_cast<Eigen::Index>(k));
  if (finds_tensions()) tendons_->set_values(u.values.tail(tendons_->unknowns()));
  if (!touch_) return;
  touch_->set_contacts(u.contacts);
  update_touch_nodes();
}

/// What a plane leaves of an increment of the fields (q, p, n, m) at q.
Vec13 CollocationRod::left_by_plane(const Vec13& by_fields, const Vec4& q) const {
  Vec13 increment = by_fields;
  increment[kQ] = q.dot(by_fields.head<4>()) / q.squaredNorm();
  increment.segment<3>(kQ + 1) = turn_by_quaternion(q) * by_fields.head<4>();
  increment = (increments_ * (increments_.transpose() * increment)).eval();
  increment.head<4>() = (quaternion_by_increment(q) * increment.head<4>()).eval();
  return increment;
}

// No row holds what leaves a plane: past round-off must not add up there.
void CollocationRod::predict(const std::vector<const Unknowns*>& past,
                             const std::vector<double>& weights) {
  assert(!past.empty() && past.size() == weights.size());
  Unknowns sum;
  sum.values = weights[0] * past[0]->values;
  for (std::size_t i = 1; i < past.size(); ++i)
    sum.values += weights[i] * past[i]->values;
  set_unknowns(*past.back());
  for (std::size_t k = 0; k < control_.size(); ++k) {
    const Vec13 next = sum.values.segment<13>(13 * static_cast<Eigen::Index>(k));
    control_[k] += left_by_plane(next - control_[k], Vec4(control_[k].head<4>()));
  }
  if (finds_tensions()) tendons_->set_values(sum.values.tail(tendons_->unknowns()));
  // quaternions add up to another length
  const double length = control_.front().head<4>().norm();
  for (Vec13& control : control_)
    control.head<4>() /= length;
  if (touch_) update_touch_nodes();
}

void CollocationRod::visit(Archive& archive) {
  archive(growth_);
  archive.doubles(control_);
  archive.doubles(points_);
  fluid_.visit(archive);
  for (Track* track : tracks())
    track->visit(archive);
  archive.doubles(reference_rotations_);
  if (tendons_) tendons_->visit(archive);
  if (disks_) disks_->visit(archive);
  if (touch_) touch_->visit(archive);
}

RodSample CollocationRod::observe() const {
  RodSample sample;
  sample.length = forcing_.length;
  sample.radius = section_.half_width;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    CollocationPoint at;
    at.y = value(nodes_[k]);
    at.y_s = derivative(nodes_[k]);
    evaluate_point({}, at);
    NodeState state = k + 1 < nodes_.size() ? state_of(at.y) : tip_state();
    RodPoint point;
    point.s = nodes_[k].s;
    point.position = position_of(state);
    point.rotation = rotation_of(state);
    point.force = force_of(state);
    point.moment = moment_of(state);
    point.velocity = track_.v.segment<3>(3 * static_cast<Eigen::Index>(points_.size() + k));
    point.curvature = at.u;
    point.shear_stretch = at.R.transpose() * at.y_s.segment<3>(kP);
    point.rest_curvature = rest_curvature(nodes_[k].s) + forcing_.heat.curvature;
    sample.points.push_back(point);
  }
  return sample;
}

RodField CollocationRod::field() const {
  RodField f;
  f.table = &arc_tableau(ArcIntegrator::kGauss6);
  std::size_t piece = 0;
  for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) {
    const double s = nodes_[k].s, h = nodes_[k + 1].s - s;
    f.cells.push_back(h * forcing_.length);
    while (piece + 1 < pieces_.size() && nodes_[k].basis.first >= pieces_[piece + 1].first_control)
      ++piece;
    for (int i = 0; i < f.table->stages; ++i) {
      const Site at = site(piece, s + f.table->c[i] * h);
      if (options_.along) f.sections.push_back(options_.along->at(at.s, at.s));
      const Vec13 y = value(at);
      f.points.push_back({rotation_of(Vec4(y.head<4>())), derivative(at).segment<3>(kP),
                          y.segment<3>(kN), y.segment<3>(kM)});
      if (fluid_.field())
        f.magnetic.push_back(
            fluid_.outer_stiffness(s + 0.5 * h, f.points.back().R, y.segment<3>(kP)));
      if (tendons_) describe_tendons(at, f);
    }
  }
  if (disks_) disks_->describe(1, f);
  f.base = base_state();
  f.tip = tip_state();
  describe_section(f, section_, options_.shear, options_.extension);
  return f;
}

double CollocationRod::magnetic_energy(const MagneticSources& sources) const {
  if (options_.magnets.empty()) return 0;
  const MagneticField field = view_of(sources);
  double energy = 0;
  for (std::size_t j = 0; j < points_.size(); ++j)
    energy += weights_[j] * forcing_.length *
              fluid_.magnetic_energy(j, points_[j].R, points_[j].p(), field);
  return energy;
}

ThermalEffort CollocationRod::thermal_effort() const {
  ThermalEffort effort;
  const ThermalStrain& heat = forcing_.heat;
  for (std::size_t j = 0; j < points_.size(); ++j)
    effort.add(weights_[j] * forcing_.length, section(j),
               points_[j].u - section(j).u_rest - heat.curvature,
               points_[j].v.z() - 1 - heat.stretch, options_.extension);
  return effort;
}

RodEnergy CollocationRod::energy() const {
  RodEnergy e;
  const auto n = static_cast<Eigen::Index>(points_.size());
  const auto elastic = [&](const SectionProperties& own, const Vec3& u, const Vec3& v) {
    Vec3 K_se = Vec3::Zero();
    if (options_.shear) K_se.head<2>() = own.K_se.head<2>();
    if (options_.extension) K_se.z() = own.K_se.z();
    const Vec3 bent = u - own.u_rest - forcing_.heat.curvature,
               stretch = v - Vec3(0, 0, 1 + forcing_.heat.stretch);
    return 0.5 * (bent.dot(own.K_bt.cwiseProduct(bent)) + stretch.dot(K_se.cwiseProduct(stretch)));
  };
  double carried = 0;
  for (std::size_t j = 0; j < points_.size(); ++j) {
    const double weight = weights_[j] * forcing_.length;
    const CollocationPoint& point = points_[j];
    const SectionProperties& own = section(j);
    const auto i = 3 * static_cast<Eigen::Index>(j), strain = strain_track() + i;
    e.kinetic += weight * 0.5 * own.rhoA * track_.v.segment<3>(i).squaredNorm();
    if (options_.rotary_inertia) {
      const Vec3 omega = Eigen::Map<const Vec3>(point.spin.omega);
      e.kinetic += weight * 0.5 * omega.dot(own.rhoJ.cwiseProduct(omega));
    }
    e.elastic += weight * elastic(own, point.u, point.v);
    e.gravity -= weight * own.weighing_mass() * forcing_.gravity.dot(point.p());
    carried += weight * own_work(point.R, point.m(), point.n(), point.u, point.v, tendons_at(j));
    if (options_.drag || options_.line_loads)
      fluid_.add_power(j, point.R.col(2), weight, track_, e);
    if (!options_.damping) continue;
    const Vec3 u_t = track_.v.segment<3>(strain);
    e.damping_power += weight * u_t.dot(own.B_bt.cwiseProduct(u_t));
    if (!extensible_) continue;
    const Vec3 v_t = track_.v.segment<3>(strain + 3 * n);
    e.damping_power += weight * v_t.dot(own.B_se.cwiseProduct(v_t));
  }
  e.magnetic = magnetic_energy(forcing_.field);
  e.set_feed_power(carried, forcing_.length, tendons_.get());
  if (touch_) e.damping_power += touch_->friction_power();
  if (disks_) disks_->add_energy(track_, e);
  return e;
}

std::string CollocationRod::row_name(int row) const {
  const int d = static_cast<int>(space_.freedoms());
  if (row < d) return "base of " + name_ + ", " + base_.row_name(row);
  if (row == d) return "unit quaternion at the base of " + name_;
  row -= d + 1;
  for (std::size_t g = 0; g < pieces_.size(); ++g) {
    if (g > 0) {
      if (row < width()) return "join " + std::to_string(g) + " between pieces of " + name_;
      row -= width();
    }
    if (row < width() * pieces_[g].points) {
      static const char* const kRows[] = {"unit quaternion", "curvature law", "stretch law",
                                          "force balance", "moment balance"};
      Eigen::Index at = 0;  // of the 13
      rows_.row(row % width()).cwiseAbs().maxCoeff(&at);
      const auto j = static_cast<std::size_t>(pieces_[g].first_point + row / width());
      return std::string(kRows[(at + 2) / 3]) + " of " + name_ +
             " at s = " + std::to_string(sites_[j].s);
    }
    row -= width() * pieces_[g].points;
  }
  if (row >= d) return "tendons of " + name_;
  return "tip of " + name_ + ", " + tip_.row_name(row);
}

}  // namespace cprsim
