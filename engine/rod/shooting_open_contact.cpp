// SPDX-License-Identifier: BSD-3-Clause
// The variational sweep with what others determine: forces by the robot, unknowns of tendons by
// their border. Their columns pass cells, contacts and segments' starts as those of the base body's
// motion do, and what the ends of contacts' cells do is carried back to the z that remains.
#include <algorithm>

#include "engine/math/so3.h"
#include "engine/rod/shooting_open.h"

namespace cprsim {

ShootingRod::~ShootingRod() = default;

bool ShootingRod::is_open() const {
  return open_ && open_->block_count() > 0;
}

const OpenPorts& ShootingRod::open_ports() const {
  return open_->ports;
}

OpenPorts* ShootingRod::ports_of_forces() {
  return open_->contacts.empty() ? nullptr : &open_->ports;
}

void ShootingRod::set_open_direction(const VecX& forces) {
  open_->weights.head(forces.size()) = forces / port_scale_.force;
  touch_->direction.resize(contact_count());
  for (std::size_t j = 0; j < open_->contacts.size(); ++j)
    touch_->direction[open_->contacts[j]] = forces.segment<3>(3 * static_cast<Eigen::Index>(j));
}

void ShootingRod::begin_open_columns() {
  if (!open_) open_ = std::make_unique<Open>();
  Open& open = *open_;
  open.contacts.clear();
  for (std::size_t i = 0; i < contact_count(); ++i)
    if (touch_->contacts[i].role != ContactRole::kOwn) open.contacts.push_back(i);
  open.tensions = finds_tensions() ? tendons_->unknowns() : 0;
  const std::size_t count = open.contacts.size(),
                    tension_blocks = (static_cast<std::size_t>(open.tensions) + 11) / 12;
  open.force_blocks = (count + 3) / 4;
  const std::size_t blocks = open.force_blocks + tension_blocks;
  open.weights.setZero(Open::kUsed * static_cast<Eigen::Index>(blocks));
  open.blocks.assign(blocks, Open::Block::Zero());
  if (blocks == 0) return;
  open.at_zone.resize(boundaries_.size() + 1);
  open.recombinations.resize(boundaries_.size());
  for (Open::Recombination& rec : open.recombinations) {
    rec.G.clear();
    rec.P.clear();
    rec.F.clear();
  }
  open.first.clear();
  for (std::size_t b = 0; b < open.force_blocks; ++b)
    open.first.push_back(touch_->contacts[open.contacts[4 * b]].cell);
  open.first.resize(blocks, 0);
  open.directions.resize(blocks);
  for (std::vector<double>& directions : open.directions)
    directions.assign(
        static_cast<std::size_t>(cells_) * static_cast<std::size_t>(kernel_->lifted) * kWide, 0);
  open.marks.resize(count);
  for (Open::Mark& mark : open.marks) {
    mark.main.setZero();
    mark.blocks.assign(blocks, Eigen::Matrix<double, 12, Open::kUsed>::Zero());
  }
  if (open.tensions > 0) find_tension_sources();
}

void ShootingRod::record_open_motion(std::size_t j, int end, std::size_t zone, const double* Y0) {
  Open& open = *open_;
  Open::Mark& mark = open.marks[j];
  mark.zone = zone;
  mark.main.middleRows<6>(6 * end) = Eigen::Map<const Open::Block>(Y0).topRows<6>();
  for (std::size_t b = 0; b < open.blocks.size(); ++b)
    mark.blocks[b].middleRows<6>(6 * end) = open.blocks[b].topLeftCorner<6, Open::kUsed>();
}

// The force acts along with the turning of the section on which it acts: on all columns.
void ShootingRod::add_open_force(std::size_t j, int end, const NodeState& state, double* Y) {
  Open& open = *open_;
  const RodContact& contact = touch_->contacts[open.contacts[j]];
  add_force_columns(contact, end, state, -1, Y);
  for (std::size_t b = 0; b < open.blocks.size(); ++b)
    add_force_columns(contact, end, state, b == j / 4 ? 3 * static_cast<int>(j % 4) : -1,
                      open.blocks[b].data());
}

void ShootingRod::enter_open_forces(std::size_t cell, std::size_t zone, double* Y) {
  const Open& open = *open_;
  const auto inside = [&](std::size_t j) {
    const RodContact& contact = touch_->contacts[open.contacts[j]];
    return contact.cell == cell && !contact.at_node();
  };
  for (std::size_t j = 0; j < open.contacts.size(); ++j)
    if (inside(j)) record_open_motion(j, 0, zone, Y);
  for (std::size_t j = 0; j < open.contacts.size(); ++j)
    if (inside(j)) add_open_force(j, 0, cell_state(cell), Y);
}

void ShootingRod::close_open_forces(std::size_t node, std::size_t zone, double* Y) {
  const Open& open = *open_;
  for (std::size_t j = 0; j < open.contacts.size(); ++j) {
    const RodContact& contact = touch_->contacts[open.contacts[j]];
    if (contact.closing_node() != node) continue;
    const int end = contact.at_node() ? 0 : 1;
    record_open_motion(j, end, zone, Y);
    add_open_force(j, end, nodes_[node], Y);
  }
}

bool ShootingRod::sweep_open_columns(std::size_t cell) {
  Open& open = *open_;
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto lifted = static_cast<std::size_t>(kernel_->lifted);
  for (std::size_t b = 0; b < open.blocks.size(); ++b) {
    if (cell < open.first[b]) continue;
    Open::Block& block = open.blocks[b];
    model_.sources = b < open.force_blocks ? nullptr : tension_sources(cell, b - open.force_blocks);
    const bool regular =
        kernel_->linearize_wide(model_, &stages_[cell * S], cell_state(cell), nodes_[cell + 1],
                                block.data(), &open.directions[b][cell * lifted * kWide]);
    model_.sources = nullptr;
    if (!regular) return false;
    // the affine part is in the other columns already
    block.rightCols<kWide - Open::kUsed>().setZero();
    apply_load_columns(cell + 1, nodes_[cell + 1], block.data(), kWide);
  }
  return true;
}

// In linear order zones are swept with what their start had.
void ShootingRod::keep_open_columns(std::size_t zone) {
  open_->at_zone[zone] = open_->blocks;
}

void ShootingRod::meet_open_columns(const RodContact& contact, const ContactRows& rows,
                                    const ContactElimination& how, std::size_t zone) {
  Open& open = *open_;
  const int last = contact.at_node() ? 0 : 1;
  const double unit = port_scale_.force;
  const NodeState& state = nodes_[contact.closing_node()];
  Open::Recombination& rec = open.recombinations[zone];
  for (std::size_t b = 0; b < open.blocks.size(); ++b) {
    Open::Block& block = open.blocks[b];
    Eigen::Matrix<double, 6, Open::kUsed> held = Open::Used6::Zero();
    const Eigen::Matrix<double, 6, Open::kUsed> now = block.topLeftCorner<6, Open::kUsed>();
    held.topRows<3>() =
        rows.by_p[last] * now.bottomRows<3>() + rows.by_phi[last] * now.topRows<3>();
    if (!contact.at_node()) {
      const Open::Used6 then = open.opened[b].topLeftCorner<6, Open::kUsed>();
      held.topRows<3>() += rows.by_p[0] * then.bottomRows<3>() + rows.by_phi[0] * then.topRows<3>();
    }
    add_force_columns(contact, last, state, -1, block.data());
    how.lower.triangularView<Eigen::Lower>().solveInPlace(held);
    const Eigen::Matrix<double, 12, Open::kUsed> moved = -(how.Q1 * held);
    rec.P.emplace_back(moved.topRows<6>());
    rec.F.emplace_back(unit * moved.middleRows<3>(6));
    block.leftCols<Open::kUsed>() += how.Y_z * rec.P.back() + how.Y_f * moved.middleRows<3>(6);
  }
}

void ShootingRod::orthogonalize_open_columns(std::size_t zone, const Vec3& turn, const Vec12& units,
                                             const Eigen::Matrix<double, 12, 6>& Q) {
  Open& open = *open_;
  Open::Recombination& rec = open.recombinations[zone];
  const Mat3 back = exp_so3(-turn);
  for (Open::Block& block : open.blocks) {
    Eigen::Matrix<double, 12, Open::kUsed> Y = block.leftCols<Open::kUsed>();
    Y.topRows<3>() = (back * Y.topRows<3>()).eval();
    Y = (units.cwiseInverse().asDiagonal() * Y).eval();
    rec.G.emplace_back(Q.transpose() * Y);
    Y -= Q * rec.G.back();
    block.leftCols<Open::kUsed>() = units.asDiagonal() * Y;
  }
}

// Back through the recombinations as in close_base(), with forces and tensions besides.
void ShootingRod::close_open_ports(const Port& base, const Port& tip, TensionPorts* tensions) {
  Open& open = *open_;
  OpenPorts& out = open.ports;
  const auto count = 3 * static_cast<Eigen::Index>(open.contacts.size());
  const double per_unit = 1 / port_scale_.force;
  out.contacts = open.contacts;
  out.motions.resize(open.contacts.size());
  for (auto* by_F : {&out.T_F, &out.WA_F, &out.WB_F})
    by_F->resize(6, count);
  if (tensions) {
    for (MatX* by_x : {&tensions->T, &tensions->WA, &tensions->WB})
      by_x->setZero(6, open.tensions);
    tensions->motions.resize(out.motions.size());
  }
  const Mat6x12 rows = tip_.rows(nodes_.back(), tip, scale_).by_state, W = tip_wrench_by_state(tip);
  for (std::size_t b = 0; b < open.block_count(); ++b) {
    const Eigen::Matrix<double, 12, Open::kUsed> last = open.blocks[b].leftCols<Open::kUsed>();
    open.share(b, Open::Used6(rows * last), per_unit, out.T_F, tensions ? &tensions->T : nullptr);
    open.share(b, Open::Used6(W * last), per_unit, out.WB_F, tensions ? &tensions->WB : nullptr);
  }

  Mat6 Z = Mat6::Identity(), Z_A = Mat6::Zero();
  Vec6 z0 = Vec6::Zero();
  open.Z.assign(open.block_count(), Open::Used6::Zero());
  // of the force of a contact of the rod's own, met at the zone's end
  Eigen::Matrix<double, 3, 6> f_z, f_A;
  Vec3 f0 = Vec3::Zero();
  f_z.setZero();
  f_A.setZero();
  open.f.assign(open.block_count(), Open::Used3::Zero());
  for (std::size_t g = boundaries_.size() + 1; g-- > 0;) {
    if (g < boundaries_.size()) {
      const Recombination& rec = recombinations_[g];
      const Open::Recombination& more = open.recombinations[g];
      const auto R = rec.R.triangularView<Eigen::Upper>();
      const bool met = boundaries_[g].contact >= 0;
      Z_A -= rec.G_A;
      z0 -= rec.g;
      R.solveInPlace(Z);
      R.solveInPlace(Z_A);
      R.solveInPlace(z0);
      for (std::size_t b = 0; b < open.block_count(); ++b) {
        Open::Used6& Z_b = open.Z[b];
        Z_b -= more.G[b];
        R.solveInPlace(Z_b);
        open.f[b].setZero();
        if (!met) continue;
        open.f[b] = per_unit * (rec.F * Z_b + more.F[b]);
        Z_b = (rec.N * Z_b + more.P[b]).eval();
      }
      f_z.setZero();
      f_A.setZero();
      f0.setZero();
      if (met) {
        f_z = per_unit * rec.F * Z;
        f_A = per_unit * (rec.F * Z_A + rec.F_A);
        f0 = per_unit * (rec.F * z0 + rec.f);
        Z = (rec.N * Z).eval();
        Z_A = (rec.N * Z_A + rec.P_A).eval();
        z0 = (rec.N * z0 + rec.p).eval();
      }
    }
    for (std::size_t j = 0; j < open.marks.size(); ++j) {
      const Open::Mark& mark = open.marks[j];
      if (mark.zone != g) continue;
      const Eigen::Matrix<double, 12, 6> by_z = mark.main.leftCols<6>();
      const Eigen::Matrix<double, 12, 3> by_f = mark.main.middleCols<3>(kContactColumn);
      constexpr int kAffine = 12;
      OpenPorts::Motion& motion = out.motions[j];
      motion.by_z = by_z * Z + by_f * f_z;
      motion.by_A = mark.main.middleCols<6>(6) + by_z * Z_A + by_f * f_A;
      motion.value = mark.main.col(kAffine) + by_z * z0 + by_f * f0;
      motion.by_F.resize(12, count);
      if (tensions) tensions->motions[j].resize(12, open.tensions);
      for (std::size_t b = 0; b < open.block_count(); ++b) {
        const Eigen::Matrix<double, 12, Open::kUsed> all =
            mark.blocks[b] + by_z * open.Z[b] + by_f * open.f[b];
        open.share(b, all, per_unit, motion.by_F, tensions ? &tensions->motions[j] : nullptr);
      }
    }
  }
  out.WA_F.setZero();
  if (!base_.held() || !base.moves) return;
  const Eigen::Map<const Open::Block> Y(zone_start_columns_.front().data());
  const Mat6 W_z = base_wrench_by_state(base) * Y.leftCols<6>();
  for (std::size_t b = 0; b < open.block_count(); ++b)
    open.share(b, Open::Used6(W_z * open.Z[b]), per_unit, out.WA_F,
               tensions ? &tensions->WA : nullptr);
}

void ShootingRod::step_back_open(std::size_t zone, Vec6& z) const {
  const Open::Recombination& rec = open_->recombinations[zone];
  for (std::size_t b = 0; b < rec.G.size(); ++b)
    z -= rec.G[b] * open_->weights_of(b);
}

void ShootingRod::meet_back_open(std::size_t zone, Vec6& z, Vec3& force) const {
  const Open::Recombination& rec = open_->recombinations[zone];
  for (std::size_t b = 0; b < rec.P.size(); ++b) {
    z += rec.P[b] * open_->weights_of(b);
    force += rec.F[b] * open_->weights_of(b);
  }
}

void ShootingRod::add_open_directions() {
  const Open& open = *open_;
  const auto lifted = static_cast<std::size_t>(kernel_->lifted);
  for (std::size_t b = 0; b < open.blocks.size(); ++b) {
    const Eigen::Matrix<double, Open::kUsed, 1> w = open.weights_of(b);
    if (w.isZero(0)) continue;
    for (std::size_t g = 0; g <= boundaries_.size(); ++g) {
      const int segment = g == 0 ? 0 : boundaries_[g - 1].segment;
      if (segment >= 0)
        start_direction_[static_cast<std::size_t>(segment)] +=
            open.at_zone[g][b].leftCols<Open::kUsed>() * w;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(cells_) * lifted; ++i)
      lifted_direction_[i] +=
          Eigen::Map<const Eigen::Matrix<double, Open::kUsed, 1>>(&open.directions[b][i * kWide])
              .dot(w);
  }
}

}  // namespace cprsim
