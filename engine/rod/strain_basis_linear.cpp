// SPDX-License-Identifier: BSD-3-Clause
// Variational equations of a strain-basis rod and what they leave to the robot. Columns belong to
// x = (state at the base, q), all in the units of the rod's scale.
#include <algorithm>

#include "engine/math/linear_solve.h"
#include "engine/math/so3.h"
#include "engine/rod/end_wrench.h"
#include "engine/rod/magnus.h"
#include "engine/rod/strain_basis.h"

namespace cprsim {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

VecX StrainRod::state_units() const {
  Vec12 units;
  units << Vec3::Ones(), Vec3::Constant(scale_.length), Vec3::Constant(scale_.force),
      Vec3::Constant(scale_.moment);
  return space_.state.cwiseAbs2().transpose() * units;  // a column lies in one of the four blocks
}

// phi_end = phi + R_end J_r(Omega) dOmega
void StrainRod::vary_gap(std::size_t e, std::size_t gap, Rows3& phi) const {
  for (std::size_t k = gap * rule_.per_gap; k < (gap + 1) * rule_.per_gap; ++k) {
    const StrainRule::Step& step = rule_.steps[k];
    const Turn& done = turns_[e * rule_.steps.size() + k];
    Mat3 u;
    for (Eigen::Index g = 0; g < 3; ++g)
      u.col(g) = strain(e, step.phi.col(g), true);
    const Eigen::Matrix<double, 3, 9> by_u =
        done.R_end * right_jacobian(done.Omega) * magnus_tangent(step.fraction * length_of(e), u);
    for (std::size_t f = 0; f < free_modes_.size(); ++f) {
      const StrainMode& mode = modes_[free_modes_[f]];
      if (!mode.turns) continue;
      const Eigen::Index at = space_.state.cols() + first_unknown(e, f);
      Mat3 along;
      for (Eigen::Index g = 0; g < 3; ++g)
        along.col(g) = unit(mode) * (by_u.middleCols<3>(3 * g) * mode.axis);
      for (Eigen::Index j = 0; j < rule_.functions(); ++j)
        phi.col(at + j) += along * Vec3(step.phi.row(j));
    }
  }
}

// A follower load turns with its section: d(R F) = phi × R F.
void StrainRod::vary_load(std::size_t node, Rows12& y) const {
  for (std::size_t i = 0; i < load_at_.size(); ++i) {
    const PointLoad& load = forcing_.loads[i];
    if (load_at_[i] != node || !load.follower) continue;
    const Mat3 R = rotation_of(nodes_[node]);
    y.middleRows<3>(6) += hat(R * load.force) * y.topRows<3>();
    y.middleRows<3>(9) += hat(R * load.torque) * y.topRows<3>();
  }
  if (disks_) disks_->pass_columns(node, y);
}

// (1) of engine/rod/nodal_contacts.h; nodes are where the forces act.
void StrainRod::vary_contacts(std::size_t node, Rows12& y) {
  node_moves_[node] = y.middleRows<3>(3);
  if (!node_turns_.empty()) node_turns_[node] = y.topRows<3>();
  if (!touch_) return;
  const Mat3 R = rotation_of(nodes_[node]);
  y.middleRows<3>(9) -= touch_->moment_by_turn(node, R) * y.topRows<3>();
  y.bottomRightCorner(6, force_columns()) -= touch_->load_by_forces(node, R);
}

// Variation of (3), in the order of the evaluation.
void StrainRod::vary_element(std::size_t e, Rows12& y) {
  const Eigen::Index G = rule_.points();
  const double h = length_of(e);
  const auto first = e * static_cast<std::size_t>(G);
  std::vector<Rows3>&tau = scratch_.tau, &n = scratch_.n, &m = scratch_.m, &m_s = scratch_.m_rates,
  &fluid = scratch_.fluid;
  for (std::vector<Rows3>* rows : {&tau, &n, &m, &m_s, &fluid})
    rows->resize(static_cast<std::size_t>(G));
  Rows3& phi = scratch_.turn;
  phi = y.topRows<3>();
  for (std::size_t i = 0; i < tau.size(); ++i) {
    const StrainPoint& point = points_[first + i];
    vary_gap(e, i, phi);
    point_turns_[first + i] = phi;
    // d tau = phi × tau + R dv
    tau[i].noalias() = -hat(point.tau) * phi;
    for (std::size_t f = 0; f < free_modes_.size(); ++f) {
      const StrainMode& mode = modes_[free_modes_[f]];
      if (mode.turns) continue;
      const Vec3 axis = point.R * mode.axis;
      for (Eigen::Index k = 0; k < rule_.functions(); ++k)
        tau[i].col(space_.state.cols() + first_unknown(e, f) + k) +=
            rule_.phi(k, static_cast<Eigen::Index>(i)) * axis;
    }
  }
  vary_gap(e, tau.size(), phi);
  const auto integral = [&](std::size_t i, const Rows3* rate, const double* factor, Rows3& sum) {
    for (std::size_t j = 0; j < tau.size(); ++j)
      sum += ((factor ? factor[j] : 1) * h *
              rule_.integrate(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j))) *
             rate[j];
  };
  for (std::size_t i = 0; i < tau.size(); ++i) {
    point_moves_[first + i] = y.middleRows<3>(3);
    integral(i, tau.data(), nullptr, point_moves_[first + i]);
  }
  const Rows3* const p = &point_moves_[first];
  for (std::size_t i = 0; fluid_.acts() && i < tau.size(); ++i) {
    const FluidSection& at = *fluid_.at(first + i);
    fluid[i].noalias() = Eigen::Map<const RowMatrix>(at.force_p) * p[i];
    fluid[i].noalias() += Eigen::Map<const RowMatrix>(at.force_phi) * point_turns_[first + i];
  }
  for (std::size_t i = 0; i < tau.size(); ++i) {
    const StrainPoint& point = points_[first + i];
    n[i] = y.middleRows<3>(6);
    if (inertia_) integral(i, p, &k_[first], n[i]);
    if (fluid_.acts()) integral(i, fluid.data(), nullptr, n[i]);
    m_s[i].noalias() = hat(point.n) * tau[i];
    m_s[i].noalias() -= hat(point.tau) * n[i];
    if (fluid_.loaded())
      m_s[i].noalias() +=
          Eigen::Map<const RowMatrix>(fluid_.at(first + i)->moment_phi) * point_turns_[first + i];
    if (fluid_.field_varies())
      m_s[i].noalias() += Eigen::Map<const RowMatrix>(fluid_.at(first + i)->moment_p) * p[i];
    if (turning_)
      m_s[i].noalias() +=
          Eigen::Map<const RowMatrix>(rotary_[first + i].torque_phi) * point_turns_[first + i];
  }
  for (std::size_t i = 0; i < tau.size(); ++i) {
    m[i] = y.middleRows<3>(9);
    integral(i, m_s.data(), nullptr, m[i]);
  }
  vary_law(e);
  if (tendons_) vary_tendons(e);
  y.topRows<3>() = phi;
  for (std::size_t i = 0; i < tau.size(); ++i) {
    const double hw = h * rule_.gauss.weights[static_cast<Eigen::Index>(i)];
    y.middleRows<3>(3) += hw * tau[i];
    if (inertia_) y.middleRows<3>(6) += (hw * k_[first + i]) * p[i];
    if (fluid_.acts()) y.middleRows<3>(6) += hw * fluid[i];
    y.middleRows<3>(9) += hw * m_s[i];
  }
}

// Variation of (4): d(R^T m) = R^T (dm + m × phi).
void StrainRod::vary_law(std::size_t e) {
  const std::vector<Rows3>&n = scratch_.n, &m = scratch_.m;
  Eigen::RowVectorXd& Lambda = scratch_.wrench;
  const Eigen::Index G = rule_.points(), functions = rule_.functions();
  for (std::size_t f = 0; f < free_modes_.size(); ++f) {
    const StrainMode& mode = modes_[free_modes_[f]];
    const Eigen::Index row = first_unknown(e, f);
    auto rows = law_columns_.middleRows(row, functions);
    for (Eigen::Index i = 0; i < G; ++i) {
      const auto j = static_cast<std::size_t>(i), at = e * static_cast<std::size_t>(G) + j;
      const StrainPoint& point = points_[at];
      const Vec3 axis = point.R * mode.axis, arm = (mode.turns ? point.m : point.n).cross(axis);
      // axis · (dW + W × phi) = axis · dW + (axis × W) · phi
      Lambda.noalias() = axis.transpose() * (mode.turns ? m[j] : n[j]);
      Lambda.noalias() -= arm.transpose() * point_turns_[at];
      const double C = compliance(mode, at) * rule_.gauss.weights[i] / unit(mode);
      for (Eigen::Index k = 0; k < functions; ++k)
        rows.row(k) -= C * rule_.phi(k, i) * Lambda;
    }
    rows.middleCols(space_.state.cols() + row, functions).diagonal().array() += 1;
  }
}

// What (4) has from tendons: + C ∫ Phi^T B^T dLambda_tendons, their stiffness on (du, dv) = B Phi
// dq.
void StrainRod::vary_tendons(std::size_t e) {
  const Eigen::Index G = rule_.points(), functions = rule_.functions(),
                     states = space_.state.cols();
  const auto six = [](const StrainMode& mode) {
    Vec6 axis = Vec6::Zero();
    axis.segment<3>(mode.turns ? 0 : 3) = mode.axis;
    return axis;
  };
  for (Eigen::Index i = 0; i < G; ++i) {
    const std::size_t at = e * static_cast<std::size_t>(G) + static_cast<std::size_t>(i);
    const Mat6 K = stiffness_of(tendons_->at(at));
    for (std::size_t f = 0; f < free_modes_.size(); ++f)
      for (std::size_t g = 0; g < free_modes_.size(); ++g) {
        const StrainMode &row = modes_[free_modes_[f]], &column = modes_[free_modes_[g]];
        const double factor = compliance(row, at) / unit(row) * unit(column) *
                              rule_.gauss.weights[i] * six(row).dot(K * six(column));
        law_columns_.block(first_unknown(e, f), states + first_unknown(e, g), functions, functions)
            .noalias() += factor * rule_.phi.col(i) * rule_.phi.col(i).transpose();
      }
  }
}

void StrainRod::sweep_columns() {
  const Eigen::Index states = space_.state.cols(), n = strain_unknowns();
  point_turns_.resize(points_.size());
  point_moves_.resize(points_.size());
  node_moves_.resize(nodes_.size());
  node_turns_.resize(touch_ || disks_ ? nodes_.size() : 0);
  law_columns_.setZero(n, states + n + force_columns());
  Rows12 y = Rows12::Zero(12, states + n + force_columns());
  y.leftCols(states) = space_.state * state_units().asDiagonal();
  vary_load(0, y);
  vary_contacts(0, y);
  for (std::size_t e = 0; e < elements(); ++e) {
    vary_element(e, y);
    vary_load(e + 1, y);
    vary_contacts(e + 1, y);
  }
  tip_columns_ = y;
}

// What a unit of each of the tendons' unknowns does to the residual of (4).
void StrainRod::add_tensions(Eigen::Ref<MatX> columns) const {
  for (std::size_t j = 0; j < points_.size(); ++j) {
    const std::size_t e = j / static_cast<std::size_t>(rule_.points());
    const auto i = static_cast<Eigen::Index>(j % static_cast<std::size_t>(rule_.points()));
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
      const Vec6 Lambda = tendons_->unit(k) * tendons_->per_unknown(k, j);
      for (std::size_t f = 0; f < free_modes_.size(); ++f) {
        const StrainMode& mode = modes_[free_modes_[f]];
        const double along = mode.axis.dot(Lambda.segment<3>(mode.turns ? 0 : 3));
        columns.col(k).segment(first_unknown(e, f), rule_.functions()) +=
            compliance(mode, j) * rule_.gauss.weights[i] / unit(mode) * along * rule_.phi.col(i);
      }
    }
  }
}

void StrainRod::strain_rates(const Eigen::Ref<const VecX>& direction,
                             std::vector<Vec6>& rates) const {
  rates.assign(points_.size(), Vec6::Zero());
  for (std::size_t j = 0; j < points_.size(); ++j) {
    const std::size_t e = j / static_cast<std::size_t>(rule_.points());
    const auto i = static_cast<Eigen::Index>(j % static_cast<std::size_t>(rule_.points()));
    for (std::size_t f = 0; f < free_modes_.size(); ++f) {
      const StrainMode& mode = modes_[free_modes_[f]];
      rates[j].segment<3>(mode.turns ? 0 : 3) +=
          unit(mode) *
          direction.segment(space_.state.cols() + first_unknown(e, f), rule_.functions())
              .dot(rule_.phi.col(i)) *
          mode.axis;
    }
  }
}

bool StrainRod::linearize(const Port& base, const Port& tip, CondensedRod& out) {
  return finds_tensions() ? border_.linearize(*this, *tendons_, base, tip, out)
                          : condense(base, tip, out, nullptr);
}

bool StrainRod::condense(const Port& base, const Port& tip, CondensedRod& out,
                         TensionPorts* tensions) {
  const Eigen::Index d = space_.freedoms(), n = strain_unknowns(), states = 2 * d;
  const Eigen::Index forces = force_columns(), known = 2 * d + 1,
                     pulls = tensions ? tendons_->unknowns() : 0;
  sweep_columns();
  // the base's rows and (4): A x + B [zeta_A; 1; F; tensions] = 0
  const ConditionRows held = base_.rows(start_, base, scale_);
  const MatX from_x = space_.state * state_units().asDiagonal();
  MatX A = MatX::Zero(d + n, states + n), B = MatX::Zero(d + n, d + 1 + forces + pulls);
  A.topLeftCorner(d, states) = held.by_state * from_x;
  A.bottomRows(n) = law_columns_.leftCols(states + n);
  B.topLeftCorner(d, d) = held.by_body * space_.motion;
  B.col(d) << held.value - base_gap_, law_residual_;
  B.block(d, d + 1, n, forces) = law_columns_.rightCols(forces);
  if (tensions) add_tensions(B.bottomRightCorner(n, pulls));
  if (!general_solution(A, B, general_)) return false;
  out.growth = general_.leftCols(d).cwiseAbs().maxCoeff();

  ConditionRows closed = tip_.rows(nodes_.back(), tip, scale_);
  closed.value -= tip_gap_;
  // what the forces do beside moving x
  const auto answer = [&](const auto& columns) {
    MatX all = columns.leftCols(states + n) * general_;
    all.middleCols(known, forces) += columns.rightCols(forces);
    return all;
  };
  const MorePorts more{forces > 0 ? &touch_->ports() : nullptr, tensions, pulls};
  condense_tip(space_, closed, tip_.held(), nodes_.back(), tip, answer(tip_columns_), out, more);
  condense_base(space_, start_, base, from_x * general_.topRows(states), out, more);
  if (!more.forces) return true;
  std::vector<MatX> moves(nodes_.size(), MatX(6, general_.cols()));
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    moves[k] << answer(node_turns_[k]), answer(node_moves_[k]);
  touch_->describe_motions(moves, tensions ? &tensions->motions : nullptr);
  return true;
}

VecX StrainRod::direction_with_forces() const {
  VecX all(direction_.size() + force_columns());
  all << direction_, force_columns() > 0 ? touch_->direction() : VecX(0);
  return all;
}

ContactScale StrainRod::scale_of_contacts() const {
  const double weight = section_.weighing_mass() * forcing_.gravity.norm() * scale_.length;
  return {
      scale_.length, std::max(scale_.force, weight),
      rates_.dynamic() ? rates_.c_v * scale_.length : scale_.length,
      options_.extension ? 0 : scale_.length / static_cast<double>(elements()) / section_.K_se.z()};
}

Vec6 StrainRod::wrench_on_base(const Port& base) const {
  return cprsim::wrench_on_base(space_, start_, base);
}

Vec6 StrainRod::wrench_on_tip(const Port& tip) const {
  return cprsim::wrench_on_tip(space_, nodes_.back(), tip);
}

void StrainRod::set_direction(const Vec6& z, const Vec6& zeta_A) {
  const VecX forces = force_columns() > 0 ? touch_->direction() : VecX(0);
  if (finds_tensions()) {
    direction_ = general_ * border_.complete(z, zeta_A, forces);
    tension_direction_ = border_.tensions(*tendons_);
    return;
  }
  const Eigen::Index d = space_.freedoms();
  direction_ = general_.leftCols(d) * z.head(d) + general_.middleCols(d, d) * zeta_A.head(d) +
               general_.col(2 * d);
  if (force_columns() > 0) direction_ += general_.rightCols(force_columns()) * forces;
}

void StrainRod::keep() {
  if (finds_tensions()) tendons_->keep();
  if (touch_) touch_->keep();
  kept_start_ = start_;
  kept_q_ = q_;
}

void StrainRod::move(double alpha) {
  if (finds_tensions()) tendons_->move(alpha, tension_direction_);
  if (touch_) touch_->move(alpha);
  const Eigen::Index states = space_.state.cols(), functions = rule_.functions();
  const Vec12 y = space_.state * state_units().cwiseProduct(alpha * direction_.head(states));
  Eigen::Map<RowMatrix>(start_.R) =
      orthonormalized(exp_so3(y.head<3>()) * Mat3(rotation_of(kept_start_)));
  Eigen::Map<Vec3>(start_.p) = position_of(kept_start_) + y.segment<3>(3);
  Eigen::Map<Vec3>(start_.n) = force_of(kept_start_) + y.segment<3>(6);
  Eigen::Map<Vec3>(start_.m) = moment_of(kept_start_) + y.segment<3>(9);
  for (std::size_t e = 0; e < elements(); ++e)
    for (std::size_t f = 0; f < free_modes_.size(); ++f) {
      const auto a = static_cast<Eigen::Index>(free_modes_[f]);
      q_[e].row(a) = kept_q_[e].row(a) +
                     (alpha * unit(modes_[free_modes_[f]])) *
                         direction_.segment(states + first_unknown(e, f), functions).transpose();
    }
}

}  // namespace cprsim
