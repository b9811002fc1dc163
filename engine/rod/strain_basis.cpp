// SPDX-License-Identifier: BSD-3-Clause
// Setting up, coefficients of a solve, and the residual; equations in engine/rod/strain_basis.h.
#include "engine/rod/strain_basis.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/math/so3.h"
#include "engine/rod/arc_grid.h"
#include "engine/rod/magnus.h"
#include "engine/rod/shooting.h"
#include "engine/section/line_load.h"
#include "engine/section/rotary.h"

namespace cprsim {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// Tip errors fall with the square of what the basis cannot represent; the quadrature, exact up to
// degree 2 points - 1, must keep up with that.
constexpr int kExtraPoints = 3;

}  // namespace

StrainRod::StrainRod(std::string name, const EndCondition& base, const EndCondition& tip,
                     const std::optional<Mat3>& plane, const Pose& X_WBase,
                     const SectionProperties& section, double length, const StrainOptions& options)
    : name_(std::move(name)),
      base_(base),
      tip_(tip),
      space_(plane ? MotionSpace::in_plane(*plane) : MotionSpace::all()),
      section_(section),
      options_(options),
      rule_(options.order, options.order + kExtraPoints),
      grid_(arc_grid(options.elements, options.stations, options.along.get())),
      fluid_(options.drag || options.line_loads
                 ? (grid_.size() - 1) * static_cast<std::size_t>(rule_.points())
                 : 0) {
  list_modes(X_WBase.R);
  load_at_ = nodes_at(grid_, options_.stations);
  const auto functions = rule_.functions();
  const std::size_t points = elements() * static_cast<std::size_t>(rule_.points());
  q_.assign(elements(), MatX::Zero(static_cast<Eigen::Index>(modes_.size()), functions));
  q_0_ = q_;
  points_.resize(points);
  b_.assign(points, Vec3::Zero());
  nodes_.resize(grid_.size());
  turns_.resize(elements() * rule_.steps.size());
  const auto strains = options.damping ? q_.size() * static_cast<std::size_t>(q_[0].size()) : 0;
  track_.resize(static_cast<Eigen::Index>(3 * (points + nodes_.size()) + strains));
  if (options.rotary_inertia) {
    rotary_.resize(points);
    rotation_track_.resize(static_cast<Eigen::Index>(3 * points));
  }
  for (VecX* gap : {&tip_gap_, &base_gap_, &tip_gap_start_, &base_gap_start_})
    gap->setZero(space_.freedoms());
  forcing_.length = length;
  if (options_.line_loads) {
    std::vector<double> inside;
    for (std::size_t j = 0; j < points; ++j) {
      const std::size_t e = j / static_cast<std::size_t>(rule_.points());
      inside.push_back(0.5 * (grid_[e] + grid_[e + 1]));
    }
    fluid_.place(std::move(inside), options_.magnets);
  }
  if (options_.along) list_sections();
  if (!options_.tendons.empty()) place_tendons();
  if (options_.touches) touch_.reset(new NodalContacts(*this));
  if (!options_.disks.empty())
    disks_ = std::make_unique<RodDisks>(options_.disks, grid_, points, options_.rotary_inertia);
  set_unloaded(X_WBase);
}

// With constant u: R = R_0 exp(s u^), p = p_0 + s R_0 J_l(s u) z.
void StrainRod::set_unloaded(const Pose& X_WBase) {
  for (MatX& q : q_)
    q.setZero();
  const auto place = [&](double s, NodeState& node) {
    node = NodeState{};
    if (options_.along) {
      const Pose X = X_WBase * options_.along->unloaded(s, forcing_.length);
      Eigen::Map<RowMatrix>(node.R) = X.R;
      Eigen::Map<Vec3>(node.p) = X.p;
      return;
    }
    const Vec3 turned = s * forcing_.length * section_.u_rest;
    Eigen::Map<RowMatrix>(node.R) = X_WBase.R * exp_so3(turned);
    Eigen::Map<Vec3>(node.p) =
        X_WBase.p + X_WBase.R * (s * forcing_.length * right_jacobian(-turned).col(2));
  };
  place(0, start_);
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    place(grid_[k], nodes_[k]);
  for (StrainPoint& point : points_) {
    point.R = X_WBase.R;
    point.p = point.n = point.m = Vec3::Zero();
    point.u = section_.u_rest;
    point.v = Vec3::UnitZ();
    point.tau = X_WBase.R.col(2);
  }
  evaluated_ = false;
}

void StrainRod::prepare(const StageRates& rates, const RodForcing& forcing) {
  rates_ = rates;
  for (MatX& q : q_) {
    add_thermal_strain(1, forcing_.heat, q);
    add_thermal_strain(-1, forcing.heat, q);
  }
  forcing_ = forcing;
  if (tendons_) tendons_->set(forcing.tendons, forcing.length);
  assert(forcing_.loads.size() == load_at_.size());
  k_.assign(points_.size(), 0);
  double k_most = 0;
  for (std::size_t j = 0; j < points_.size(); ++j) {
    k_[j] = section(j).rhoA * rates.c_v * rates.c_w + forcing.relaxation;
    k_most = std::max(k_most, k_[j]);
  }
  inertia_ = k_most != 0;
  turning_ = options_.rotary_inertia && rates.dynamic();
  fluid_.prepare(section_, sections_, rates, forcing, track_);
  const double L = forcing.length, EI = section_.K_bt.head<2>().maxCoeff();
  scale_ = {L, EI / (L * L), EI / L};
  // positions carry round-off eps L; inertia turns it into forces eps k L²
  constexpr double kRoundOff = 50 * std::numeric_limits<double>::epsilon();
  double k = k_most + fluid_.stiffness();
  if (disks_) {
    disks_->prepare(rates, forcing_, track_);
    k += disks_->stiffness() / L;
  }
  noise_ = std::max(1.0, kRoundOff * k * std::pow(L, 4) / (EI * forcing.tolerance));
  free_modes_.clear();
  for (std::size_t a = 0; a < modes_.size(); ++a) {
    if (compliance(modes_[a]) > 0)
      free_modes_.push_back(a);
    else
      for (MatX& q : q_)
        q.row(static_cast<Eigen::Index>(a)).setZero();
  }
  update_point_inputs();
  double N = 0;
  for (const StrainPoint& point : points_)
    N = std::max(N, point.n.norm());
  growth_ = cprsim::growth_exponent(section_, section_.K_bt, Vec3::Zero(), L,
                                    k_most + fluid_.stiffness(), N);
  if (disks_) growth_ = std::max(growth_, disks_->growth_exponent(EI, L, k_most));
}

// (4) with xi_t = c_v q + q_h, divided by K + c_v B: q + C B q_h - C ∫ Phi^T Lambda = 0.
void StrainRod::update_point_inputs() {
  const auto n = static_cast<Eigen::Index>(points_.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto i = static_cast<std::size_t>(j);
    b_[i] = -section(i).weighing_mass() * forcing_.gravity;
    if (forcing_.relaxation > 0) b_[i] -= forcing_.relaxation * marked_[i];
    if (!rates_.dynamic()) continue;
    b_[i] += section(i).rhoA *
             (rates_.c_w * track_.x_h.segment<3>(3 * j) + track_.v_h.segment<3>(3 * j));
    if (!turning_) continue;
    std::copy_n(rotation_track_.x_h.data() + 3 * j, 3, rotary_[i].theta_h);
    std::copy_n(rotation_track_.v_h.data() + 3 * j, 3, rotary_[i].omega_h);
  }
  for (MatX& q : q_0_)
    q.setZero();
  if (!rates_.dynamic() || !options_.damping) return;
  const double* history = track_.x_h.data() + position_coordinates();
  for (MatX& q : q_0_) {
    q = Eigen::Map<const MatX>(history, q.rows(), q.cols());
    history += q.size();
    for (std::size_t a = 0; a < modes_.size(); ++a) {
      auto row = q.row(static_cast<Eigen::Index>(a));
      // the histories are those of the whole strain
      row[0] += rates_.c_v * thermal_strain(modes_[a], forcing_.heat);
      if (sections_.empty())
        row *= compliance(modes_[a]) * modes_[a].damping;
      else
        row = weighted_by_damping(modes_[a], static_cast<std::size_t>(&q - q_0_.data()), row);
    }
  }
}

void StrainRod::apply_load(std::size_t node, NodeState& state) const {
  for (std::size_t i = 0; i < load_at_.size(); ++i) {
    if (load_at_[i] != node) continue;
    const PointLoad& load = forcing_.loads[i];
    const Mat3 R = load.follower ? Mat3(rotation_of(state)) : Mat3(Mat3::Identity());
    Eigen::Map<Vec3>(state.n) -= R * load.force;
    Eigen::Map<Vec3>(state.m) -= R * load.torque;
  }
  if (disks_) disks_->pass(node, state);
  if (!touch_) return;
  const Vec6 load = touch_->load_at(node, rotation_of(state));
  Eigen::Map<Vec3>(state.n) -= load.head<3>();
  Eigen::Map<Vec3>(state.m) -= load.tail<3>();
}

Vec3 StrainRod::strain(std::size_t element, const Eigen::Ref<const VecX>& phi, bool turns) const {
  Vec3 sum(0, 0, 1 + forcing_.heat.stretch);
  if (turns) sum = rest_curvature(element, phi);
  for (std::size_t a : free_modes_)
    if (modes_[a].turns == turns)
      sum += q_[element].row(static_cast<Eigen::Index>(a)).dot(phi) * modes_[a].axis;
  return sum;
}

// (2)
StrainRod::Turn StrainRod::turn(std::size_t element, const StrainRule::Step& step,
                                const Mat3& R_start) const {
  Mat3 u;
  for (Eigen::Index g = 0; g < 3; ++g)
    u.col(g) = strain(element, step.phi.col(g), true);
  const Vec3 Omega = magnus_step(step.fraction * length_of(element), u);
  return {Omega, R_start * exp_so3(Omega)};
}

Mat3 StrainRod::cross_gap(std::size_t element, std::size_t gap, Mat3 R) {
  for (std::size_t k = gap * rule_.per_gap; k < (gap + 1) * rule_.per_gap; ++k) {
    Turn& done = turns_[element * rule_.steps.size() + k];
    done = turn(element, rule_.steps[k], R);
    R = done.R_end;
  }
  return R;
}

void StrainRod::evaluate_rotary_inertia(std::size_t point) {
  struct {
    double rhoJ[3], c_v, c_w;
    bool body_rates;
  } model{{section(point).rhoJ.x(), section(point).rhoJ.y(), section(point).rhoJ.z()},
          rates_.c_v,
          rates_.c_w,
          rates_.body_rates};

  Eigen::Map<RowMatrix>(rotary_[point].R) = points_[point].R;
  evaluate_rotary(model, rotary_[point]);
}

Vec3 StrainRod::fluid_force(std::size_t point) {
  const StrainPoint& at = points_[point];
  const RowMatrix R = at.R;
  evaluate_surroundings(rates_.c_v, rates_.c_w, load(at.p.data()), load_matrix(R.data()),
                        fluid_.field(), *fluid_.at(point));
  return Eigen::Map<const Vec3>(fluid_.at(point)->force);
}

/// Moment or force that the rod itself carries at a point, section axes.
Vec3 StrainRod::own_wrench(const StrainMode& mode, std::size_t at) const {
  const StrainPoint& point = points_[at];
  Vec3 own = point.R.transpose() * (mode.turns ? point.m : point.n);
  if (tendons_) {
    const TendonSection& tendons = tendons_->at(at);
    own -= Eigen::Map<const Vec3>(mode.turns ? tendons.moment : tendons.force);
  }
  return own;
}

// (4)
void StrainRod::project_law(std::size_t e) {
  const Eigen::Index G = rule_.points();
  const std::size_t first = e * static_cast<std::size_t>(G);
  for (std::size_t j = first; tendons_ && j < first + static_cast<std::size_t>(G); ++j)
    tendons_->evaluate(j, points_[j].u, points_[j].v);
  for (std::size_t f = 0; f < free_modes_.size(); ++f) {
    const auto a = static_cast<Eigen::Index>(free_modes_[f]);
    const StrainMode& mode = modes_[free_modes_[f]];
    auto row = law_residual_.segment(first_unknown(e, f), rule_.functions());
    row = (q_[e].row(a) + q_0_[e].row(a)).transpose();
    for (Eigen::Index i = 0; i < G; ++i) {
      const std::size_t at = first + static_cast<std::size_t>(i);
      row -= compliance(mode, at) * rule_.gauss.weights[i] * mode.axis.dot(own_wrench(mode, at)) *
             rule_.phi.col(i);
    }
    row /= unit(mode);
  }
}

// (3) along an element.
void StrainRod::evaluate_element(std::size_t e, NodeState& state) {
  const Eigen::Index G = rule_.points();
  const double h = length_of(e);
  const VecX& w = rule_.gauss.weights;
  StrainPoint* const point = &points_[e * static_cast<std::size_t>(G)];
  Mat3 R = rotation_of(state);
  const Vec3 p0 = position_of(state), n0 = force_of(state), m0 = moment_of(state);
  Vec3 p_end = p0, n_end = n0, m_end = m0;
  std::vector<Vec3>&n_s = scratch_.n_s, &m_s = scratch_.m_s;
  n_s.resize(static_cast<std::size_t>(G));
  m_s.resize(static_cast<std::size_t>(G));
  for (Eigen::Index i = 0; i < G; ++i) {
    R = cross_gap(e, static_cast<std::size_t>(i), R);
    point[i].R = R;
    point[i].u = strain(e, rule_.phi.col(i), true);
    point[i].v = strain(e, rule_.phi.col(i), false);
    point[i].tau = R * point[i].v;
    p_end += h * w[i] * point[i].tau;
  }
  const auto integral = [&](Eigen::Index i, const auto& value) {
    Vec3 sum = Vec3::Zero();
    for (Eigen::Index j = 0; j < G; ++j)
      sum += rule_.integrate(i, j) * value(j);
    return Vec3(h * sum);
  };
  for (Eigen::Index i = 0; i < G; ++i) {
    const auto k = static_cast<std::size_t>(i);
    point[i].p = p0 + integral(i, [&](Eigen::Index j) { return point[j].tau; });
    const std::size_t at = e * static_cast<std::size_t>(G) + k;
    n_s[k] = k_[at] * point[i].p + b_[at];
    if (fluid_.acts()) n_s[k] += fluid_force(at);
    n_end += h * w[i] * n_s[k];
  }
  for (Eigen::Index i = 0; i < G; ++i) {
    const std::size_t k = static_cast<std::size_t>(i), at = e * static_cast<std::size_t>(G) + k;
    point[i].n = n0 + integral(i, [&](Eigen::Index j) { return n_s[static_cast<std::size_t>(j)]; });
    m_s[k] = point[i].n.cross(point[i].tau);
    if (fluid_.loaded()) m_s[k] += Eigen::Map<const Vec3>(fluid_.at(at)->moment);
    if (turning_) {
      evaluate_rotary_inertia(at);
      m_s[k] += Eigen::Map<const Vec3>(rotary_[at].torque);
    }
    m_end += h * w[i] * m_s[k];
  }
  for (Eigen::Index i = 0; i < G; ++i)
    point[i].m = m0 + integral(i, [&](Eigen::Index j) { return m_s[static_cast<std::size_t>(j)]; });
  Eigen::Map<RowMatrix>(state.R) = cross_gap(e, static_cast<std::size_t>(G), R);
  Eigen::Map<Vec3>(state.p) = p_end;
  Eigen::Map<Vec3>(state.n) = n_end;
  Eigen::Map<Vec3>(state.m) = m_end;
}

void StrainRod::add_row(RodResidual& r, double value, int row) const {
  r.sum_squares += value * value;
  const double size = std::abs(value);
  if (!std::isfinite(value)) r.finite = false;
  if (size > r.largest || !std::isfinite(value)) {
    r.largest = std::isfinite(value) ? size : std::numeric_limits<double>::infinity();
    r.worst_row = row;
  }
}

RodResidual StrainRod::evaluate(const Port& base, const Port& tip) {
  RodResidual r;
  int row = 0;
  const auto add = [&](const VecX& values) {
    for (double value : values)
      add_row(r, value, row++);
  };
  RodScale loose = scale_;
  loose.force *= noise_;
  loose.moment *= noise_;
  add(base_.value(start_, base, loose) - base_gap_);
  law_residual_.resize(strain_unknowns());
  NodeState state = start_;
  apply_load(0, state);
  nodes_[0] = state;
  for (std::size_t e = 0; e < elements(); ++e) {
    evaluate_element(e, state);
    project_law(e);
    apply_load(e + 1, state);
    nodes_[e + 1] = state;
  }
  if (touch_) touch_->begin_rows();
  section_evaluations_ += static_cast<long>(points_.size());
  add(law_residual_ / noise_);
  add(tip_.value(state, tip, loose) - tip_gap_);
  if (finds_tensions()) add(tendon_gaps());
  evaluated_ = r.finite;
  return r;
}

std::string StrainRod::row_name(int row) const {
  const int d = static_cast<int>(space_.freedoms()), law = static_cast<int>(strain_unknowns());
  if (row < d) return "base of " + name_ + ", " + base_.row_name(row);
  row -= d;
  if (row >= law + d) return "tendons of " + name_;
  if (row >= law) return "tip of " + name_ + ", " + tip_.row_name(row - law);
  const int functions = static_cast<int>(rule_.functions());
  const int element = row / functions / static_cast<int>(free_modes_.size());
  return "strain law of " + name_ + " in element " + std::to_string(element + 1) + " of " +
         std::to_string(elements()) + ", degree " + std::to_string(row % functions);
}

}  // namespace cprsim
