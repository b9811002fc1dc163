// SPDX-License-Identifier: BSD-3-Clause
#include "engine/section/fluid.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kCv = 3, kCw = 2;

struct Section {
  Vec3 p{0.3, -0.2, 0.5};
  Mat3 R = exp_so3({0.3, -0.7, 1.1});
  FluidSection fluid{};

  Vec3 force() {
    const Vec3 t = R.col(2);
    evaluate_fluid(kCv, kCw, {p.x(), p.y(), p.z()}, {t.x(), t.y(), t.z()}, fluid);
    return Eigen::Map<Vec3>{fluid.force};
  }
};

Section section(double normal, double tangential, double added_mass) {
  Section s;
  s.fluid.normal = normal;
  s.fluid.tangential = tangential;
  s.fluid.added_mass = added_mass;
  Eigen::Map<Vec3>{s.fluid.velocity_h} = Vec3(0.4, 0.9, -0.6);
  Eigen::Map<Vec3>{s.fluid.acceleration_h} = Vec3(-0.8, 0.2, 1.5);
  return s;
}

Section moved(Section s, const VecX& d) {
  s.p += d.head<3>();
  s.R = exp_so3(d.tail<3>()) * s.R;
  return s;
}

TEST(Fluid, TangentsAreDerivatives) {
  for (const Section& start :
       {section(0.7, 0, 0), section(0, 0.4, 0), section(0, 0, 1.3), section(0.7, 0.4, 1.3)}) {
    Section at = start;
    at.force();
    MatX tangent(3, 6);
    tangent << Eigen::Map<RowMat3>{at.fluid.force_p}, Eigen::Map<RowMat3>{at.fluid.force_phi};
    const auto f = [](Section s) -> VecX { return s.force(); };
    EXPECT_TRUE(jacobians_agree(tangent, difference_jacobian(f, at, 6, moved), 1e-8, 1e-8));
  }
}

TEST(Fluid, ForceIsThatOfItsDefinition) {
  Section s = section(0.7, 0.4, 1.3);
  const Vec3 force = s.force(), t = s.R.col(2);
  const Vec3 v = kCv * s.p + Vec3(0.4, 0.9, -0.6), a = kCv * kCw * s.p + Vec3(-0.8, 0.2, 1.5);
  const Vec3 v_n = t.cross(v).cross(t), a_n = t.cross(a).cross(t), v_t = v - v_n;
  EXPECT_LT((force - (0.7 * v_n.norm() * v_n + 0.4 * v_t.norm() * v_t + 1.3 * a_n)).norm(), 1e-14);
}

TEST(Fluid, AtRestNothingIsUndefined) {
  Section s = section(0.7, 0.4, 0);
  Eigen::Map<Vec3>{s.fluid.velocity_h} = -kCv * s.p;
  EXPECT_EQ(s.force(), Vec3::Zero());
  EXPECT_LT(Eigen::Map<RowMat3>{s.fluid.force_p}.norm(), 1e-14);
  EXPECT_LT(Eigen::Map<RowMat3>{s.fluid.force_phi}.norm(), 1e-14);
}

}  // namespace
}  // namespace cprsim
