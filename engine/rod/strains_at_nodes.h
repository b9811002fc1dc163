// SPDX-License-Identifier: BSD-3-Clause
// Strains at the nodes of a rod by shooting, which knows them at the stages of its cells only.
//
// Polynomials through the stages of one cell and of two neighbours tell them: of a node the latter
// is taken, unless it leaves what the two cells by themselves say by more than these differ from
// each other. So it does where strains bend: at a point load, a contact. Where they jump, the mean
// of both sides is between them.
#pragma once

#include <functional>
#include <vector>

#include "engine/math/types.h"
#include "engine/rod/tableau.h"

namespace cprsim {

class StrainsAtNodes {
 public:
  /// @param grid of the cells, fractions of the length. @param at_stage strains of a stage, counted
  /// along the rod, in any order
  StrainsAtNodes(const ArcTableau& table, const std::vector<double>& grid,
                 std::function<Vec6(std::size_t)> at_stage)
      : table_(table), grid_(grid), at_stage_(std::move(at_stage)) {}

  Vec6 operator()(std::size_t node) const;

 private:
  /// Of the polynomial through the stages of cells first .. last, at a node.
  Vec6 fitted(std::size_t first, std::size_t last, std::size_t node) const;
  Vec6 between(std::size_t node) const;
  Vec6 at_end(std::size_t node) const;

  const ArcTableau& table_;
  const std::vector<double>& grid_;
  std::function<Vec6(std::size_t)> at_stage_;
};

}  // namespace cprsim
