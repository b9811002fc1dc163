// SPDX-License-Identifier: BSD-3-Clause
// Contacts in a shooting rod. In the sweep of columns a contact's force f is a seventh to ninth
// unknown beside z from where it first acts to the node at which its rows C_z z + C_f f + C_A
// zeta_A + c = 0 can be formed; these leave six of the nine free:
//   (z, f) = Q_2 z' - Q_1 R^-T (C_A zeta_A + c),   [C_z C_f]^T = Q_1 R                   (1)
// Q_2 is orthonormal, so a contact adds no growth however stiff it is.
#include <algorithm>
#include <cmath>

#include "engine/math/linear_solve.h"
#include "engine/math/so3.h"
#include "engine/rod/shooting_open.h"

namespace cprsim {
namespace {

using RowMajor12 = Eigen::Matrix<double, 12, Eigen::Dynamic, Eigen::RowMajor>;
using ColumnsMap = Eigen::Map<RowMajor12>;
using ConstColumnsMap = Eigen::Map<const RowMajor12>;
using ContactColumns = Eigen::Matrix<double, 3, kWide>;

// rows that say (nearly) the same determine no force
constexpr double kSameRows = 1e-15;

}  // namespace

void ShootingRod::set_surfaces(const std::vector<Surface>& surfaces, double radius, bool friction) {
  if (!touch_) touch_ = std::make_unique<Touch>();  // else it is tied already
  touch_->surfaces = surfaces;
  touch_->radius = radius;
  touch_->motion.start(friction, nodes_.size());
  accept_contacts();
}

const std::vector<Surface>& ShootingRod::surfaces() const {
  return touch_->surfaces;
}

std::vector<RodContact>& ShootingRod::contacts() {
  return touch_->contacts;
}

std::vector<ContactRows>& ShootingRod::contact_state() {
  return touch_->rows;
}

void ShootingRod::accept_contacts() {
  if (!touch_) return;
  touch_->motion.accept(nodes_);
  for (RodContact& contact : touch_->contacts)
    contact.held = contact.force;
}

const NodeState& ShootingRod::cell_state(std::size_t cell) const {
  for (std::size_t g = 1; g < starts_.size(); ++g)
    if (segment_first_[g] == cell) return starts_[g];
  return nodes_[cell];
}

const RodContact* ShootingRod::contact_in(std::size_t cell) const {
  if (!touch_) return nullptr;
  for (const RodContact& contact : touch_->contacts)
    if (contact.role == ContactRole::kOwn && contact.cell == cell && !contact.at_node())
      return &contact;
  return nullptr;
}

void ShootingRod::open_contacts(std::size_t cell, NodeState& state) const {
  for (const RodContact& contact : touch_->contacts)
    if (contact.cell == cell && !contact.at_node()) add_contact_force(contact, 0, state);
}

// (2) of engine/rod/contact.h, at one end of the contact's cell.
void ShootingRod::add_contact_force(const RodContact& contact, int end, NodeState& state) const {
  const ContactWeights weights(contact.xi);
  const double h = contact.at_node() ? 0 : cell_length(contact.cell);
  const Mat3 R = rotation_of(state);
  const Vec3 t = R.col(2), &f = contact.force;
  Eigen::Map<Vec3>(state.n) -= weights.H[end] * f;
  Eigen::Map<Vec3>(state.m) -=
      weights.G[end] * h * t.cross(f) + weights.S[end] * contact.lever_at(R).cross(f);
}

void ShootingRod::close_contacts(std::size_t node, NodeState& state) const {
  for (const RodContact& contact : touch_->contacts)
    if (contact.closing_node() == node)
      add_contact_force(contact, contact.at_node() ? 0 : 1, state);
}

ContactNode ShootingRod::contact_node(const NodeState& state, std::size_t node) const {
  const auto at = 3 * static_cast<Eigen::Index>(stages_.size() + node);
  return touch_->motion.at(node, state, rates_,
                           rates_.dynamic() ? Vec3(track_.x_h.segment<3>(at)) : Vec3(Vec3::Zero()));
}

// Of a limp rope the weight is what forces are measured by, not the bending stiffness.
ContactScale ShootingRod::contact_scale() const {
  const double weight = section_.weighing_mass() * forcing_.gravity.norm() * scale_.length;
  return {scale_.length, std::max(scale_.force, weight),
          rates_.dynamic() ? rates_.c_v * scale_.length : scale_.length,
          options_.extension ? 0 : scale_.length / cells_ / section_.K_se.z()};
}

ContactEnds ShootingRod::contact_ends(std::size_t index) const {
  const RodContact& contact = touch_->contacts[index];
  const std::size_t k = contact.cell;
  ContactEnds ends;
  if (contact.at_node()) {
    ends.node[0] = contact_node(nodes_[k], k);
    return ends;
  }
  ends.node[0] = contact_node(cell_state(k), k);
  ends.node[1] = contact_node(nodes_[k + 1], k + 1);
  ends.h = cell_length(k);
  return ends;
}

void ShootingRod::contact_residual(RodResidual& r, int& row) {
  const ContactScale unit = contact_scale();
  std::vector<ContactRows>& rows = touch_->rows;
  rows.resize(touch_->contacts.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RodContact& contact = touch_->contacts[i];
    rows[i].slip.setZero();
    if (contact.role != ContactRole::kOwn) continue;
    rows[i] = contact_rows(contact, touch_->surfaces[static_cast<std::size_t>(contact.surface)],
                           touch_->radius, contact_ends(i), unit);
    for (double value : rows[i].value)
      add_row(r, value, row++);
  }
}

/// @param column of Y from which on the force's own columns stand; -1: only its turning with the
/// rod
void ShootingRod::add_force_columns(const RodContact& contact, int end, const NodeState& state,
                                    int column, double* Y0) const {
  ColumnsMap Y(Y0, 12, columns_);
  const ContactWeights weights(contact.xi);
  const double hG = contact.at_node() ? 0 : cell_length(contact.cell) * weights.G[end];
  const Mat3 R = rotation_of(state), t = hat(R.col(2)), lever = hat(contact.lever_at(R));
  // d(t × f) = (phi × t) × f + t × df, and the same of an arm
  if (hG != 0) Y.middleRows<3>(9) -= hG * hat(contact.force) * t * Y.topRows<3>();
  if (contact.grip == Grip::kTie) Y.middleRows<3>(9) -= hat(contact.force) * lever * Y.topRows<3>();
  if (column < 0) return;
  const double unit = port_scale_.force;
  Y.block<3, 3>(6, column) -= weights.H[end] * unit * Mat3::Identity();
  Y.block<3, 3>(9, column) -= unit * (hG * t + weights.S[end] * lever);
}

void ShootingRod::open_contact_columns(std::size_t cell, double* Y) {
  const RodContact& contact = *contact_in(cell);
  touch_->opened.assign(Y, Y + 12 * kWide);
  add_force_columns(contact, 0, cell_state(cell), kContactColumn, Y);
  if (!is_open()) return;
  open_->opened = open_->blocks;
  for (Open::Block& block : open_->blocks)
    add_force_columns(contact, 0, cell_state(cell), -1, block.data());
}

bool ShootingRod::meet_contact(std::size_t index, std::size_t zone, double* Y0) {
  ColumnsMap Y(Y0, 12, columns_);
  const RodContact& contact = touch_->contacts[index];
  const ContactRows& rows = touch_->rows[index];
  const std::size_t node = contact.closing_node();
  const int last = contact.at_node() ? 0 : 1;
  ContactColumns C = ContactColumns::Zero();
  C.middleCols<3>(kContactColumn) = port_scale_.force * rows.by_force;
  C += rows.by_p[last] * Y.middleRows<3>(3) + rows.by_phi[last] * Y.topRows<3>();
  if (!contact.at_node()) {
    const ConstColumnsMap opened(touch_->opened.data(), 12, kWide);
    C += rows.by_p[0] * opened.middleRows<3>(3) + rows.by_phi[0] * opened.topRows<3>();
  }
  constexpr int kAffine = 12;
  C.col(kAffine) += rows.value;
  add_force_columns(contact, last, nodes_[node], kContactColumn, Y0);
  // (1); TallQr takes three more rows that concern nothing
  TallQr::Mat12x6 A = TallQr::Mat12x6::Zero();
  A.topLeftCorner<6, 3>() = C.leftCols<6>().transpose();
  A.block<3, 3>(6, 0) = C.middleCols<3>(kContactColumn).transpose();
  A.bottomRightCorner<3, 3>().setIdentity();
  const TallQr qr(A);
  const Vec3 pivots = qr.R.diagonal().head<3>().cwiseAbs();
  if (!(pivots.minCoeff() > kSameRows * pivots.maxCoeff())) return false;
  Eigen::Matrix<double, 6, 7> particular = Eigen::Matrix<double, 6, 7>::Zero();
  particular.topLeftCorner<3, 6>() = C.middleCols<6>(6);
  particular.topRightCorner<3, 1>() = C.col(kAffine);
  const Mat6 lower = qr.R.transpose();
  lower.triangularView<Eigen::Lower>().solveInPlace(particular);
  const Eigen::Matrix<double, 12, 7> held = -(qr.Q1 * particular);
  Recombination& rec = recombinations_[zone];
  const double unit = port_scale_.force;
  rec.N = qr.Q2.topRows<6>();
  rec.P_A = held.topLeftCorner<6, 6>();
  rec.p = held.topRightCorner<6, 1>();
  rec.F = unit * qr.Q2.middleRows<3>(6);
  rec.F_A = unit * held.block<3, 6>(6, 0);
  rec.f = unit * held.block<3, 1>(6, 6);
  const TallQr::Mat12x6 Y_z = Y.leftCols<6>();
  const Eigen::Matrix<double, 12, 3> Y_f = Y.middleCols<3>(kContactColumn);
  if (is_open()) meet_open_columns(contact, rows, {lower, qr.Q1, Y_z, Y_f}, zone);
  Y.leftCols<6>() = Y_z * rec.N + Y_f * (rec.F / unit);
  Y.middleCols<6>(6) += Y_z * rec.P_A + Y_f * (rec.F_A / unit);
  Y.col(kAffine) += Y_z * rec.p + Y_f * (rec.f / unit);
  Y.middleCols<3>(kContactColumn).setZero();
  return true;
}

}  // namespace cprsim
