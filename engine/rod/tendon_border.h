// SPDX-License-Identifier: BSD-3-Clause
// Unknowns of tendons among those of a rod: tensions where displacements are prescribed, friction.
// Beside the rod's own unknowns y and what is left of them (engine/rod/rod_model.h) stand m
// unknowns x and m rows, the gaps of RodTendons:
//   y = Y_z z + Y_A zeta_A + Y_x x + y_0,    G y + D x + gap = 0                                (1)
// A rod is linearised once as with given x and once for each of them, its residual then being
// increased by the derivative by it; all is affine, so that the difference is Y_x. Of the d + m
// entries of z and x (1) leaves d free, six in space and three in a plane, which are the z of the
// whole. x alone would not do as its pivots: with some choices of z a tension turns the rod's
// moments instead of bending it. Nothing of this runs in a rod whose tensions are given and the
// same all along.
#pragma once

#include "engine/rod/rod_model.h"
#include "engine/rod/rod_tendons.h"

namespace cprsim {

/// What a discretisation offers.
class TensionedRod {
 public:
  virtual ~TensionedRod() = default;

  /// 6, or 3 in a plane: how many z and zeta_A there are.
  virtual Eigen::Index freedoms() const = 0;
  /// RodModel::linearize with given tensions.
  virtual bool linearize_given(const Port& base, const Port& tip, CondensedRod& out) = 0;
  /// RodModel::set_direction after it; the direction of all own unknowns as one vector.
  virtual VecX direction_given(const Vec6& z, const Vec6& zeta_A) = 0;
  /// Adds to the residuals of the law what a unit of an unknown of the tendons does to them; the
  /// second call with `add` false restores them bit by bit.
  virtual void add_tension(Eigen::Index unknown, bool add) = 0;
  /// Rates of (u, v) along a direction, at each section of RodTendons.
  virtual std::vector<Vec6> strain_rates(const VecX& direction) const = 0;
};

class TendonBorder {
 public:
  bool linearize(TensionedRod& rod, const RodTendons& tendons, const Port& base, const Port& tip,
                 CondensedRod& out);

  /// Own unknowns, then those of tendons.
  VecX direction(const Vec6& z, const Vec6& zeta_A) const;

 private:
  MatX columns_;  ///< (own unknowns, those of tendons) by (z, zeta_A, 1)
};

}  // namespace cprsim
