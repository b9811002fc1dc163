// SPDX-License-Identifier: BSD-3-Clause
// Rigid disks and point masses fastened to a rod. Each stands at a node of the discretisation's
// grid, where internal force and moment jump by what moves it: with its mass m, its inertia
// J = m r² (1/4, 1/4, 1/2) about the section's axes, its centre on the centreline, and the weight
// m g,
//   n+ = n- + m (p_tt - g)                                                                    (1)
//   m+ = m- + t,     t = d/dt(R J R^T w)     where rotary inertia is listed                     (2)
// Time is already algebra (engine/time/scheme.h), p_tt = c_v c_w p + history; t and its derivative
// by the world rotation increment are those of a section (engine/section/rotary.h):
//   d(n+ - n-) = m c_v c_w dp,     d(m+ - m-) = t_phi phi                                      (3)
// Only rods with disks have this.
#pragma once

#include <vector>

#include "engine/model/rod_spec.h"
#include "engine/rod/collocation_point.h"
#include "engine/rod/field.h"
#include "engine/rod/rod_model.h"

namespace cprsim {

/// About the section's axes, kg m².
Vec3 disk_inertia(const DiskSpec& disk);

class RodDisks {
 public:
  /// Where a disk is: the number its method gives to the place of its jump, and the node whose
  /// position the method integrates.
  struct Station {
    std::size_t jump = 0, node = 0;
  };

  /// @param points that the method's track of positions has before the nodes
  RodDisks(const std::vector<DiskSpec>& disks, const std::vector<Station>& stations,
           std::size_t points, bool rotary);

  /// On a grid of nodes s, where jumps and positions have the same numbers.
  RodDisks(const std::vector<DiskSpec>& disks, const std::vector<double>& grid, std::size_t points,
           bool rotary);

  /// Inputs of a solve. @param positions the method's track
  void prepare(const StageRates& rates, const RodForcing& forcing, const Track& positions);

  /// Finds (1), (2) for a section at the place of a jump.
  void evaluate(std::size_t jump, const Mat3& R, const Vec3& p);

  /// n+ - n- and m+ - m- as last found.
  Vec6 jump_at(std::size_t jump) const;
  /// (3): (n, m) by (phi, dp).
  Mat6 by_motion(std::size_t jump) const;

  /// Lets a state pass, from before the disks to beyond them.
  void pass(std::size_t jump, NodeState& state);

  /// The same for rows (phi, dp, dn, dm) of any number of columns.
  template <class Columns>
  void pass_columns(std::size_t jump, Columns&& Y) const {
    for (const Disk& disk : disks_) {
      if (disk.at.jump != jump) continue;
      if (stiffness_ != 0)
        Y.template middleRows<3>(6) += disk.mass * stiffness_ * Y.template middleRows<3>(3);
      if (!turning_) continue;
      const Mat3 by_turn = torque_by_turn(disk);
      Y.template middleRows<3>(9) += by_turn * Y.template topRows<3>();
    }
  }

  /// All their resistance to being moved in this solve, N/m: for estimates.
  double stiffness() const { return mass_ * stiffness_; }

  /// engine/rod/shooting.h with their inertia spread along the rod. @param k of the rod, N/m²
  double growth_exponent(double EI, double length, double k) const;

  /// Weight of all, N.
  double weight() const { return mass_ * gravity_.norm(); }

  // what a time scheme integrates besides the positions: rotations, where a disk has inertia
  Track* turns() { return rotary_ ? &turns_ : nullptr; }

  void fill_turns();
  void accept();  ///< new reference rotations
  void start();   ///< at rest
  /// Turning at the rate w (world axes).
  void set_rate(std::size_t jump, const Vec3& w);
  void start_moving();  ///< as set

  /// @param positions the method's track
  void add_energy(const Track& positions, RodEnergy& energy) const;

  /// @param cells of the field per node of the method
  void describe(std::size_t cells, RodField& field) const;

  void visit(Archive& archive) { archive.doubles(spins_); }

 private:
  struct Disk {
    Station at;
    Eigen::Index place = 0;  ///< of the position in the track
    double mass = 0;
    Vec3 J = Vec3::Zero();
    Vec3 constant = Vec3::Zero();  ///< of (1), N
    Vec3 force = Vec3::Zero();     ///< (1) as last found
    Vec3 p = Vec3::Zero();
  };

  Mat3 torque_by_turn(const Disk& disk) const;

  std::vector<Disk> disks_;
  std::vector<PointSpin> spins_;  ///< of the disks
  bool rotary_ = false, turning_ = false;
  double mass_ = 0, stiffness_ = 0;  ///< of all; c_v c_w
  StageRates rates_;
  Vec3 gravity_ = Vec3::Zero();
  Track turns_{Track::Kind::kRotation};
};

}  // namespace cprsim
