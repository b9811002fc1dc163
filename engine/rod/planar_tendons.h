// SPDX-License-Identifier: BSD-3-Clause
// The tendons of a rod in a plane: engine/rod/rod_tendons.h, which computes in space, seen in the
// plane. Only rods with tendons have one.
#pragma once

#include "engine/rod/planar_cell.h"
#include "engine/rod/rod_tendons.h"

namespace cprsim {

class PlanarTendons {
 public:
  /// @param offset section axes in plane axes at theta = 0
  PlanarTendons(std::vector<Tendon> tendons, double length,
                const std::vector<AskedSection>& sections, double EI,
                const std::vector<double>& stations, const Mat3& offset);

  /// The pull at a stage and its derivatives.
  void evaluate(std::size_t stage, const PlanarStage& at);

  /// Of the pull at a stage on its strains, J/m.
  double work(std::size_t stage, const PlanarStage& at) const {
    const double* pull = pulls_[stage].value;
    return pull[0] * at.kappa + pull[1] * at.v[0] + pull[2] * at.v[1];
  }

  const PlanarPull* at(std::size_t stage) const { return &pulls_[stage]; }

  /// (u, v) in section axes by (kappa, v_t, v_d).
  const Eigen::Matrix<double, 6, 3>& strains() const { return strains_; }

  RodTendons& in_space() { return tendons_; }

  const RodTendons& in_space() const { return tendons_; }

 private:
  RodTendons tendons_;
  Eigen::Matrix<double, 6, 3> strains_;
  std::vector<PlanarPull> pulls_;
};

}  // namespace cprsim
