// SPDX-License-Identifier: BSD-3-Clause
// The variational sweep with forces that the robot determines. Their columns pass cells, contacts
// and segments' starts as those of the base body's motion do, and what the ends of their cells do
// is carried back to the z that remains.
#include <algorithm>

#include "engine/math/so3.h"
#include "engine/rod/shooting_open.h"

namespace cprsim {

ShootingRod::~ShootingRod() = default;

std::size_t ShootingRod::open_count() const {
  return touch_ && touch_->open ? touch_->open->contacts.size() : 0;
}

const OpenPorts& ShootingRod::open_ports() const {
  return touch_->open->ports;
}

void ShootingRod::set_open_direction(const VecX& forces) {
  Open& open = *touch_->open;
  open.weights.setZero(Open::kUsed * static_cast<Eigen::Index>(open.blocks.size()));
  open.weights.head(forces.size()) = forces / port_scale_.force;
  touch_->direction.resize(contact_count());
  for (std::size_t j = 0; j < open.contacts.size(); ++j)
    touch_->direction[open.contacts[j]] = forces.segment<3>(3 * static_cast<Eigen::Index>(j));
}

void ShootingRod::begin_open_columns() {
  std::vector<std::size_t> shared;
  for (std::size_t i = 0; i < contact_count(); ++i)
    if (touch_->contacts[i].role != ContactRole::kOwn) shared.push_back(i);
  if (shared.empty()) {
    touch_->open.reset();
    return;
  }
  if (!touch_->open) touch_->open = std::make_unique<Open>();
  Open& open = *touch_->open;
  open.contacts = std::move(shared);
  const std::size_t count = open.contacts.size(), blocks = (count + 3) / 4;
  open.blocks.assign(blocks, Open::Block::Zero());
  open.at_zone.resize(boundaries_.size() + 1);
  open.recombinations.assign(boundaries_.size(), {});
  open.first.clear();
  for (std::size_t b = 0; b < blocks; ++b)
    open.first.push_back(touch_->contacts[open.contacts[4 * b]].cell);
  open.directions.assign(blocks, {});
  for (std::vector<double>& directions : open.directions)
    directions.assign(
        static_cast<std::size_t>(cells_) * static_cast<std::size_t>(kernel_->lifted) * kWide, 0);
  open.marks.assign(count, {});
  for (Open::Mark& mark : open.marks) {
    mark.main.setZero();
    mark.blocks.assign(blocks, Eigen::Matrix<double, 12, Open::kUsed>::Zero());
  }
}

void ShootingRod::record_open_motion(std::size_t j, int end, std::size_t zone, const double* Y0) {
  Open& open = *touch_->open;
  Open::Mark& mark = open.marks[j];
  mark.zone = zone;
  mark.main.middleRows<6>(6 * end) = Eigen::Map<const Open::Block>(Y0).topRows<6>();
  for (std::size_t b = 0; b < open.blocks.size(); ++b)
    mark.blocks[b].middleRows<6>(6 * end) = open.blocks[b].topLeftCorner<6, Open::kUsed>();
}

// The force acts along with the turning of the section on which it acts: on all columns.
void ShootingRod::add_open_force(std::size_t j, int end, const NodeState& state, double* Y) {
  Open& open = *touch_->open;
  const RodContact& contact = touch_->contacts[open.contacts[j]];
  add_force_columns(contact, end, state, -1, Y);
  for (std::size_t b = 0; b < open.blocks.size(); ++b)
    add_force_columns(contact, end, state, b == j / 4 ? 3 * static_cast<int>(j % 4) : -1,
                      open.blocks[b].data());
}

void ShootingRod::enter_open_forces(std::size_t cell, std::size_t zone, double* Y) {
  const Open& open = *touch_->open;
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
  const Open& open = *touch_->open;
  for (std::size_t j = 0; j < open.contacts.size(); ++j) {
    const RodContact& contact = touch_->contacts[open.contacts[j]];
    if (contact.closing_node() != node) continue;
    const int end = contact.at_node() ? 0 : 1;
    record_open_motion(j, end, zone, Y);
    add_open_force(j, end, nodes_[node], Y);
  }
}

bool ShootingRod::sweep_open_columns(std::size_t cell) {
  Open& open = *touch_->open;
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto lifted = static_cast<std::size_t>(kernel_->lifted);
  for (std::size_t b = 0; b < open.blocks.size(); ++b) {
    if (cell < open.first[b]) continue;
    Open::Block& block = open.blocks[b];
    if (!kernel_->linearize_wide(model_, &stages_[cell * S], cell_state(cell), nodes_[cell + 1],
                                 block.data(), &open.directions[b][cell * lifted * kWide]))
      return false;
    // the affine part is in the other columns already
    block.rightCols<kWide - Open::kUsed>().setZero();
    apply_load_columns(cell + 1, nodes_[cell + 1], block.data());
  }
  return true;
}

// In linear order zones are swept with what their start had.
void ShootingRod::keep_open_columns(std::size_t zone) {
  touch_->open->at_zone[zone] = touch_->open->blocks;
}

void ShootingRod::meet_open_columns(const RodContact& contact, const ContactRows& rows,
                                    const ContactElimination& how, std::size_t zone) {
  Open& open = *touch_->open;
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
  Open& open = *touch_->open;
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

// Back through the recombinations as in close_base(), with the forces F besides.
void ShootingRod::close_open_ports(const Port& base, const Port& tip) {
  Open& open = *touch_->open;
  OpenPorts& out = open.ports;
  const auto count = 3 * static_cast<Eigen::Index>(open.contacts.size());
  const double per_unit = 1 / port_scale_.force;
  out.contacts = open.contacts;
  out.motions.resize(open.contacts.size());
  // the forces' columns of all blocks side by side
  const auto all = [&](const auto& blocks) {
    using Part = typename std::decay_t<decltype(blocks)>::value_type;
    Eigen::Matrix<double, Part::RowsAtCompileTime, Eigen::Dynamic> side(
        Part::RowsAtCompileTime, Open::kUsed * static_cast<Eigen::Index>(blocks.size()));
    for (std::size_t b = 0; b < blocks.size(); ++b)
      side.template middleCols<Open::kUsed>(Open::kUsed * static_cast<Eigen::Index>(b)) =
          blocks[b].template leftCols<Open::kUsed>();
    return side;
  };
  using Forces6 = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  const Eigen::Matrix<double, 12, Eigen::Dynamic> last =
      per_unit * all(open.blocks).leftCols(count);
  out.T_F = tip_.rows(nodes_.back(), tip, scale_).by_state * last;
  out.WB_F = tip_wrench_by_state(tip) * last;

  Mat6 Z = Mat6::Identity(), Z_A = Mat6::Zero();
  Forces6 Z_F = Forces6::Zero(6, Open::kUsed * static_cast<Eigen::Index>(open.blocks.size()));
  Vec6 z0 = Vec6::Zero();
  // of the force of a contact of the rod's own, met at the zone's end
  Eigen::Matrix<double, 3, 6> f_z, f_A;
  Eigen::Matrix<double, 3, Eigen::Dynamic> f_F = Z_F.topRows<3>();
  Vec3 f0 = Vec3::Zero();
  f_z.setZero();
  f_A.setZero();
  constexpr int kAffine = 12;
  for (std::size_t g = boundaries_.size() + 1; g-- > 0;) {
    if (g < boundaries_.size()) {
      const Recombination& rec = recombinations_[g];
      const Open::Recombination& more = open.recombinations[g];
      const auto R = rec.R.triangularView<Eigen::Upper>();
      Z_A -= rec.G_A;
      Z_F -= all(more.G);
      z0 -= rec.g;
      R.solveInPlace(Z);
      R.solveInPlace(Z_A);
      R.solveInPlace(Z_F);
      R.solveInPlace(z0);
      f_z.setZero();
      f_A.setZero();
      f_F.setZero();
      f0.setZero();
      if (boundaries_[g].contact >= 0) {
        f_z = per_unit * rec.F * Z;
        f_A = per_unit * (rec.F * Z_A + rec.F_A);
        f_F = per_unit * (rec.F * Z_F + all(more.F));
        f0 = per_unit * (rec.F * z0 + rec.f);
        Z = (rec.N * Z).eval();
        Z_A = (rec.N * Z_A + rec.P_A).eval();
        Z_F = (rec.N * Z_F + all(more.P)).eval();
        z0 = (rec.N * z0 + rec.p).eval();
      }
    }
    for (std::size_t j = 0; j < open.marks.size(); ++j) {
      const Open::Mark& mark = open.marks[j];
      if (mark.zone != g) continue;
      const Eigen::Matrix<double, 12, 6> by_z = mark.main.leftCols<6>();
      const Eigen::Matrix<double, 12, 3> by_f = mark.main.middleCols<3>(kContactColumn);
      OpenPorts::Motion& motion = out.motions[j];
      motion.by_z = by_z * Z + by_f * f_z;
      motion.by_A = mark.main.middleCols<6>(6) + by_z * Z_A + by_f * f_A;
      motion.by_F = per_unit * (all(mark.blocks) + by_z * Z_F + by_f * f_F).leftCols(count);
      motion.value = mark.main.col(kAffine) + by_z * z0 + by_f * f0;
    }
  }
  out.WA_F.setZero(6, count);
  if (!base_.held() || !base.moves) return;
  const Eigen::Map<const Open::Block> Y(zone_start_columns_.front().data());
  out.WA_F = per_unit * (base_wrench_by_state(base) * Y.leftCols<6>() * Z_F).leftCols(count);
}

void ShootingRod::step_back_open(std::size_t zone, Vec6& z) const {
  const Open::Recombination& rec = touch_->open->recombinations[zone];
  for (std::size_t b = 0; b < rec.G.size(); ++b)
    z -= rec.G[b] *
         touch_->open->weights.segment<Open::kUsed>(Open::kUsed * static_cast<Eigen::Index>(b));
}

void ShootingRod::meet_back_open(std::size_t zone, Vec6& z, Vec3& force) const {
  const Open::Recombination& rec = touch_->open->recombinations[zone];
  for (std::size_t b = 0; b < rec.P.size(); ++b) {
    const Eigen::Matrix<double, Open::kUsed, 1> w =
        touch_->open->weights.segment<Open::kUsed>(Open::kUsed * static_cast<Eigen::Index>(b));
    z += rec.P[b] * w;
    force += rec.F[b] * w;
  }
}

void ShootingRod::add_open_directions() {
  const Open& open = *touch_->open;
  const auto lifted = static_cast<std::size_t>(kernel_->lifted);
  for (std::size_t b = 0; b < open.blocks.size(); ++b) {
    const Eigen::Matrix<double, Open::kUsed, 1> w =
        open.weights.segment<Open::kUsed>(Open::kUsed * static_cast<Eigen::Index>(b));
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
