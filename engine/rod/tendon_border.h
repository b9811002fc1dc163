// SPDX-License-Identifier: BSD-3-Clause
// Unknowns of tendons among those of a rod: tensions where displacements are prescribed, friction.
// Beside the rod's own unknowns y and what is left of them (engine/rod/rod_model.h) stand m
// unknowns x and m rows, the gaps of RodTendons:
//   y = Y_z z + Y_A zeta_A + Y_F F + Y_x x + y_0,    G y + D x + gap = 0                        (1)
// F are the forces of contacts and ties that the robot determines. A rod takes the columns Y_x
// along when it is linearised. Of the d + m entries of z and x (1) leaves d free, six in space and
// three in a plane, which are the z of the whole. x alone would not do as its pivots: with some
// choices of z a tension turns the rod's moments instead of bending it. Nothing of this runs in a
// rod whose tensions are given and the same all along.
#pragma once

#include <vector>

#include "engine/rod/rod_model.h"
#include "engine/rod/rod_tendons.h"

namespace cprsim {

/// How the two-port answers to x, in units of RodTendons::unit(): as T_F, WA_F, WB_F and motions of
/// OpenPorts to F. d rows; 12 of the motions.
struct TensionPorts {
  MatX T, WA, WB;
  std::vector<MatX> motions;
};

/// What a discretisation offers.
class TensionedRod {
 public:
  virtual ~TensionedRod() = default;

  /// 6, or 3 in a plane: how many z and zeta_A there are.
  virtual Eigen::Index freedoms() const = 0;
  /// RodModel::linearize with given x.
  virtual bool linearize_given(const Port& base, const Port& tip, CondensedRod& out,
                               TensionPorts& ports) = 0;

  /// What it has left to answer to F; null without any.
  virtual OpenPorts* ports_of_forces() { return nullptr; }

  /// After it, directions of its own unknowns, one for each column [z; zeta_A; 1; F; x] of `cases`,
  /// x in units.
  virtual void find_directions(const MatX& cases, MatX& directions) = 0;
  /// Rates of (u, v) along a direction, at each section of RodTendons.
  virtual void strain_rates(const Eigen::Ref<const VecX>& direction,
                            std::vector<Vec6>& rates) const = 0;
};

class TendonBorder {
 public:
  bool linearize(TensionedRod& rod, const RodTendons& tendons, const Port& base, const Port& tip,
                 CondensedRod& out);

  /// [z; zeta_A; 1; F; x] of a direction, x in units, by what is left of it.
  const MatX& complete(const Vec6& z, const Vec6& zeta_A, const VecX& F);

  /// x of the same, not in units.
  VecX tensions(const RodTendons& tendons) const;

 private:
  bool eliminate(Eigen::Index d);
  void substitute(MatX& by);
  void put_together(MatX& by, const Eigen::Ref<const MatX>& z, const Eigen::Ref<const MatX>& zeta,
                    const Eigen::Ref<const MatX>& one, const Eigen::Ref<const MatX>& F,
                    const Eigen::Ref<const MatX>& x);

  TensionPorts ports_;
  MatX cases_, directions_;
  std::vector<Vec6> rates_;
  MatX rows_;   ///< (1) by [z; zeta_A; 1; F; x]
  MatX outer_;  ///< [z; x] by what is left, zeta_A, 1, F
  std::vector<Eigen::Index> entry_;
  MatX narrow_, wide_, answer_;
  VecX left_;
  MatX complete_;
  OpenPorts none_;
};

}  // namespace cprsim
