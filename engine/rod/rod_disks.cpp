// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/rod_disks.h"

#include <algorithm>
#include <cmath>

#include "engine/rod/arc_grid.h"
#include "engine/section/rotary.h"

namespace cprsim {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// What evaluate_rotary() reads of a disk.
struct DiskModel {
  double rhoJ[3], c_v, c_w;
  bool body_rates;
};

std::vector<RodDisks::Station> stations_on(const std::vector<DiskSpec>& disks,
                                           const std::vector<double>& grid) {
  std::vector<RodDisks::Station> stations;
  for (const DiskSpec& disk : disks) {
    const std::size_t node = nodes_at(grid, {disk.s})[0];
    stations.push_back({node, node});
  }
  return stations;
}

}  // namespace

Vec3 disk_inertia(const DiskSpec& disk) {
  return disk.mass * disk.radius * disk.radius * Vec3(0.25, 0.25, 0.5);
}

RodDisks::RodDisks(const std::vector<DiskSpec>& disks, const std::vector<Station>& stations,
                   std::size_t points, bool rotary)
    : spins_(disks.size()) {
  for (std::size_t i = 0; i < disks.size(); ++i) {
    Disk disk;
    disk.at = stations[i];
    disk.place = 3 * static_cast<Eigen::Index>(points + stations[i].node);
    disk.mass = disks[i].mass;
    disk.J = disk_inertia(disks[i]);
    mass_ += disk.mass;
    rotary_ = rotary_ || (rotary && !disk.J.isZero(0));
    disks_.push_back(disk);
    Eigen::Map<RowMatrix>(spins_[i].R).setIdentity();
    Eigen::Map<RowMatrix>(spins_[i].R_start).setIdentity();
  }
  if (rotary_) turns_.resize(3 * static_cast<Eigen::Index>(disks.size()));
}

RodDisks::RodDisks(const std::vector<DiskSpec>& disks, const std::vector<double>& grid,
                   std::size_t points, bool rotary)
    : RodDisks(disks, stations_on(disks, grid), points, rotary) {}

void RodDisks::prepare(const StageRates& rates, const RodForcing& forcing, const Track& positions) {
  rates_ = rates;
  gravity_ = forcing.gravity;
  stiffness_ = rates.c_v * rates.c_w;
  turning_ = rotary_ && rates.dynamic();
  for (std::size_t i = 0; i < disks_.size(); ++i) {
    Disk& disk = disks_[i];
    disk.constant = -disk.mass * gravity_;
    if (!rates.dynamic()) continue;
    disk.constant += disk.mass * (rates.c_w * positions.x_h.segment<3>(disk.place) +
                                  positions.v_h.segment<3>(disk.place));
    if (!turning_) continue;
    const auto k = 3 * static_cast<Eigen::Index>(i);
    Eigen::Map<Vec3>(spins_[i].theta_h) = turns_.x_h.segment<3>(k);
    Eigen::Map<Vec3>(spins_[i].omega_h) = turns_.v_h.segment<3>(k);
  }
}

void RodDisks::evaluate(std::size_t jump, const Mat3& R, const Vec3& p) {
  for (std::size_t i = 0; i < disks_.size(); ++i) {
    Disk& disk = disks_[i];
    if (disk.at.jump != jump) continue;
    disk.p = p;
    disk.force = disk.mass * stiffness_ * p + disk.constant;
    Eigen::Map<RowMatrix>(spins_[i].R) = R;
    if (turning_)
      evaluate_rotary(
          DiskModel{
              {disk.J.x(), disk.J.y(), disk.J.z()}, rates_.c_v, rates_.c_w, rates_.body_rates},
          spins_[i]);
  }
}

double RodDisks::growth_exponent(double EI, double length, double k) const {
  return length * std::pow((k + stiffness() / length) / EI, 0.25) / std::sqrt(2.0);
}

Vec6 RodDisks::jump_at(std::size_t jump) const {
  Vec6 sum = Vec6::Zero();
  for (std::size_t i = 0; i < disks_.size(); ++i) {
    if (disks_[i].at.jump != jump) continue;
    sum.head<3>() += disks_[i].force;
    if (turning_) sum.tail<3>() += Eigen::Map<const Vec3>(spins_[i].torque);
  }
  return sum;
}

Mat3 RodDisks::torque_by_turn(const Disk& disk) const {
  return Eigen::Map<const RowMatrix>(
      spins_[static_cast<std::size_t>(&disk - disks_.data())].torque_phi);
}

Mat6 RodDisks::by_motion(std::size_t jump) const {
  Mat6 B = Mat6::Zero();
  for (const Disk& disk : disks_) {
    if (disk.at.jump != jump) continue;
    B.topRightCorner<3, 3>().diagonal().array() += disk.mass * stiffness_;
    if (turning_) B.bottomLeftCorner<3, 3>() += torque_by_turn(disk);
  }
  return B;
}

void RodDisks::pass(std::size_t jump, NodeState& state) {
  evaluate(jump, rotation_of(state), position_of(state));
  const Vec6 J = jump_at(jump);
  Eigen::Map<Vec3>(state.n) += J.head<3>();
  Eigen::Map<Vec3>(state.m) += J.tail<3>();
}

void RodDisks::fill_turns() {
  if (!rotary_) return;
  for (std::size_t i = 0; i < spins_.size(); ++i) {
    std::copy_n(spins_[i].theta, 3, turns_.x.data() + 3 * i);
    std::copy_n(spins_[i].omega, 3, turns_.v.data() + 3 * i);
  }
}

void RodDisks::accept() {
  for (PointSpin& spin : spins_)
    std::copy_n(spin.R, 9, spin.R_start);
}

void RodDisks::start() {
  accept();
  for (PointSpin& spin : spins_) {
    std::fill_n(spin.theta, 3, 0.0);
    std::fill_n(spin.omega, 3, 0.0);
  }
  if (rotary_) turns_.set_start(VecX::Zero(turns_.x.size()), VecX::Zero(turns_.x.size()));
}

void RodDisks::set_rate(std::size_t jump, const Vec3& w) {
  for (std::size_t i = 0; i < disks_.size(); ++i)
    if (disks_[i].at.jump == jump)
      Eigen::Map<Vec3>(spins_[i].omega) = Eigen::Map<const RowMatrix>(spins_[i].R).transpose() * w;
}

void RodDisks::start_moving() {
  if (!rotary_) return;
  fill_turns();
  turns_.set_start(VecX::Zero(turns_.x.size()), VecX(turns_.v));
}

void RodDisks::add_energy(const Track& positions, RodEnergy& energy) const {
  for (std::size_t i = 0; i < disks_.size(); ++i) {
    const Disk& disk = disks_[i];
    energy.kinetic += 0.5 * disk.mass * positions.v.segment<3>(disk.place).squaredNorm();
    energy.gravity -= disk.mass * gravity_.dot(disk.p);
    if (!rotary_) continue;
    const Vec3 omega = Eigen::Map<const Vec3>(spins_[i].omega);
    energy.kinetic += 0.5 * omega.dot(disk.J.cwiseProduct(omega));
  }
}

void RodDisks::describe(std::size_t cells, RodField& field) const {
  for (std::size_t i = 0; i < disks_.size(); ++i)
    field.disks.push_back({cells * disks_[i].at.node, disks_[i].mass, disks_[i].J,
                           Mat3(Eigen::Map<const RowMatrix>(spins_[i].R))});
}

}  // namespace cprsim
