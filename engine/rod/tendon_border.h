// SPDX-License-Identifier: BSD-3-Clause
// Tensions as unknowns of a rod, where displacements of tendons are prescribed. Beside the rod's
// own unknowns y and what is left of them (engine/rod/rod_model.h) stand m tensions x and m rows,
// the gaps of RodTendons:
//   y = Y_z z + Y_A zeta_A + Y_x x + y_0,    G y + D x + gap = 0                                (1)
// A rod is linearised once as with given tensions and once for each unknown one, its residual then
// being increased by the derivative by that tension; all is affine, so that the difference is Y_x.
// Of the 6 + m entries of z and x (1), m small, leaves six free, which are the z of the whole. x
// alone would not do as its pivots: with some choices of z a tension turns the rod's moments
// instead of bending it. Nothing of this runs in a rod whose tensions are given.
#pragma once

#include "engine/rod/rod_model.h"
#include "engine/rod/rod_tendons.h"

namespace cprsim {

/// What a discretisation offers.
class TensionedRod {
 public:
  virtual ~TensionedRod() = default;

  /// RodModel::linearize with given tensions.
  virtual bool linearize_given(const Port& base, const Port& tip, CondensedRod& out) = 0;
  /// RodModel::set_direction after it; the direction of all own unknowns as one vector.
  virtual VecX direction_given(const Vec6& z, const Vec6& zeta_A) = 0;
  /// Adds to the residuals of the law what a unit of an unknown tension does to them; the second
  /// call with `add` false restores them bit by bit.
  virtual void add_tension(Eigen::Index unknown, bool add) = 0;
  /// Rates of (u, v) along a direction, at each section of RodTendons.
  virtual std::vector<Vec6> strain_rates(const VecX& direction) const = 0;
};

class TendonBorder {
 public:
  bool linearize(TensionedRod& rod, const RodTendons& tendons, const Port& base, const Port& tip,
                 CondensedRod& out);

  /// Own unknowns, then tensions.
  VecX direction(const Vec6& z, const Vec6& zeta_A) const;

 private:
  MatX columns_;  ///< (own unknowns, tensions) by (z, zeta_A, 1)
};

}  // namespace cprsim
