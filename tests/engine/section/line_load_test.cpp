// SPDX-License-Identifier: BSD-3-Clause
#include "engine/section/line_load.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

const Vec3 kDeadForce(0.4, -0.3, 0.9), kOwnForce(-0.5, 0.8, 0.2), kDeadMoment(0.3, 0.7, -0.6),
    kOwnMoment(0.1, -0.4, 1.2);

/// A section in a fluid that flows and under loads of every kind.
struct Section {
  Vec3 p{0.3, -0.2, 0.5};
  Mat3 R = exp_so3({0.3, -0.7, 1.1});
  FluidSection around{};

  Section() {
    around.normal = 0.7;
    around.added_mass = 1.3;
    around.loaded = 1;
    Eigen::Map<Vec3>{around.velocity_h} = Vec3(0.4, 0.9, -0.6);
    Eigen::Map<Vec3>{around.dead_force} = kDeadForce;
    Eigen::Map<Vec3>{around.own_force} = kOwnForce;
    Eigen::Map<Vec3>{around.dead_moment} = kDeadMoment;
    Eigen::Map<Vec3>{around.own_moment} = kOwnMoment;
  }

  void evaluate() {
    const RowMat3 rows = R;
    evaluate_surroundings(3, 2, {p.x(), p.y(), p.z()}, load_matrix(rows.data()), nullptr, around);
  }
};

Section moved(Section s, const VecX& d) {
  s.p += d.head<3>();
  s.R = exp_so3(d.tail<3>()) * s.R;
  return s;
}

TEST(LineLoad, TangentsAreDerivatives) {
  Section at;
  at.evaluate();
  MatX tangent = MatX::Zero(6, 6);
  tangent.topRows<3>() << Eigen::Map<RowMat3>{at.around.force_p},
      Eigen::Map<RowMat3>{at.around.force_phi};
  tangent.bottomRightCorner<3, 3>() = Eigen::Map<RowMat3>{at.around.moment_phi};
  const auto f = [](Section s) -> VecX {
    s.evaluate();
    Vec6 both;
    both << Eigen::Map<Vec3>{s.around.force}, Eigen::Map<Vec3>{s.around.moment};
    return both;
  };
  EXPECT_TRUE(jacobians_agree(tangent, difference_jacobian(f, at, 6, moved), 1e-8, 1e-8));
}

TEST(LineLoad, ForceAndMomentAreThoseOfTheirDefinition) {
  Section loaded, bare;
  bare.around.loaded = 0;
  loaded.evaluate();
  bare.evaluate();
  const Vec3 f = kDeadForce + loaded.R * kOwnForce, l = kDeadMoment + loaded.R * kOwnMoment;
  EXPECT_LT((Eigen::Map<Vec3>{loaded.around.applied} - f).norm(), 1e-15);
  EXPECT_LT(
      (Eigen::Map<Vec3>{loaded.around.force} - Eigen::Map<Vec3>{bare.around.force} + f).norm(),
      1e-15);
  EXPECT_LT((Eigen::Map<Vec3>{loaded.around.moment} + l).norm(), 1e-15);
}

}  // namespace
}  // namespace cprsim
