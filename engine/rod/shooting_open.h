// SPDX-License-Identifier: BSD-3-Clause
// What a shooting rod keeps of contacts whose forces are unknowns of the whole robot, and of
// unknowns of tendons (engine/rod/tendon_border.h). In the sweep each is a given of the rod like
// the motion of the base's body: more particular columns, in blocks of twelve that pass the cells
// as the wide columns do. Those of forces enter where the forces act, those of tendons in all
// cells.
#pragma once

#include <vector>

#include "engine/rod/shooting.h"

namespace cprsim {

struct ShootingRod::Open {
  static constexpr int kUsed = 12;  ///< columns of a block that carry forces or tensions

  using Block = Eigen::Matrix<double, 12, kWide, Eigen::RowMajor>;
  using Used6 = Eigen::Matrix<double, 6, kUsed>;
  using Used3 = Eigen::Matrix<double, 3, kUsed>;

  /// Columns of the ends of a contact's cell: rows phi_0, p_0, phi_1, p_1, as found in its zone.
  struct Mark {
    std::size_t zone = 0;
    Eigen::Matrix<double, 12, kWide> main;
    std::vector<Eigen::Matrix<double, 12, kUsed>> blocks;
  };

  /// Parts of ShootingRod::Recombination that belong to blocks.
  struct Recombination {
    std::vector<Used6> G, P;
    std::vector<Used3> F;
  };

  std::vector<std::size_t> contacts;  ///< index into Touch::contacts of each force
  std::size_t force_blocks = 0;       ///< the first ones; those of tendons are behind them
  Eigen::Index tensions = 0;
  std::vector<double> sources;  ///< of tendons, as CellModel::sources, cell by cell, block by block
  std::vector<std::size_t> first;  ///< first cell in which a block is not zero
  std::vector<Block> blocks, opened;
  std::vector<std::vector<Block>> at_zone;
  std::vector<std::vector<double>> directions;  ///< of lifted unknowns: lifted × kWide a cell
  std::vector<Recombination> recombinations;
  std::vector<Mark> marks;
  VecX weights;  ///< forces and tensions of the direction over their units, kUsed a block
  OpenPorts ports;
  std::vector<Used6> Z;  ///< of a zone's start by the columns of each block
  std::vector<Used3> f;  ///< likewise of the force of a contact of the rod's own, met at its end

  std::size_t block_count() const { return blocks.size(); }

  Eigen::Matrix<double, kUsed, 1> weights_of(std::size_t block) const {
    return weights.segment<kUsed>(kUsed * static_cast<Eigen::Index>(block));
  }

  /// Hands columns of a block on: those of forces for newtons, those of tendons for their units.
  template <class Columns, class ByForces, class ByTensions>
  void share(std::size_t block, const Columns& from, double per_unit, ByForces& by_F,
             ByTensions* by_x) const {
    for (Eigen::Index c = 0; c < kUsed; ++c) {
      if (block < force_blocks) {
        const Eigen::Index at = kUsed * static_cast<Eigen::Index>(block) + c;
        if (at < by_F.cols()) by_F.col(at) = per_unit * from.col(c);
      } else {
        const Eigen::Index at = kUsed * static_cast<Eigen::Index>(block - force_blocks) + c;
        if (by_x && at < tensions) by_x->col(at) = from.col(c);
      }
    }
  }
};

/// How meet_contact() determined the force of a contact of the rod's own.
struct ShootingRod::ContactElimination {
  Mat6 lower;
  Eigen::Matrix<double, 12, 6> Q1, Y_z;
  Eigen::Matrix<double, 12, 3> Y_f;
};

}  // namespace cprsim
