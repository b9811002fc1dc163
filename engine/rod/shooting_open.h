// SPDX-License-Identifier: BSD-3-Clause
// What a shooting rod keeps of contacts whose forces are unknowns of the whole robot. In the sweep
// each such force is a given of the rod like the motion of the base's body: three more particular
// columns, in blocks of four forces that pass the cells as the wide columns do.
#pragma once

#include <vector>

#include "engine/rod/shooting.h"

namespace cprsim {

struct ShootingRod::Open {
  static constexpr int kUsed = 12;  ///< columns of a block that carry forces

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
  std::vector<std::size_t> first;     ///< first cell in which a block is not zero
  std::vector<Block> blocks, opened;
  std::vector<std::vector<Block>> at_zone;
  std::vector<std::vector<double>> directions;  ///< of lifted unknowns: lifted × kWide a cell
  std::vector<Recombination> recombinations;
  std::vector<Mark> marks;
  VecX weights;  ///< forces of the direction over their unit, kUsed a block
  OpenPorts ports;
};

/// How meet_contact() determined the force of a contact of the rod's own.
struct ShootingRod::ContactElimination {
  Mat6 lower;
  Eigen::Matrix<double, 12, 6> Q1, Y_z;
  Eigen::Matrix<double, 12, 3> Y_f;
};

}  // namespace cprsim
