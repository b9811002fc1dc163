// SPDX-License-Identifier: BSD-3-Clause
#include "engine/section/magnetic_load.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "engine/section/line_load.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

V3 of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Vec3 vec(const V3& v) {
  return {v.x, v.y, v.z};
}

const Vec3 kMoment(0.5, -0.2, 0.8), kUniform(0.03, -0.01, 0.02);

/// A magnetised section next to two dipoles, in a uniform field.
struct Section {
  Vec3 p{0.3, -0.2, 0.5};
  Mat3 R = exp_so3({0.3, -0.7, 1.1});
  MagneticDipole dipoles[2] = {{{0.1, 0.2, 0.3}, {2e6, -1e6, 3e6}},
                               {{0.6, -0.5, 0.4}, {-1e6, 1e6, 2e6}}};
  int count = 2;
  FluidSection around{};

  MagneticField field() const {
    MagneticField all;
    Eigen::Map<Vec3>{all.uniform} = kUniform;
    all.dipoles = dipoles;
    all.count = count;
    return all;
  }

  Section() {
    around.loaded = around.magnetic = 1;
    Eigen::Map<Vec3>{around.magnetization} = kMoment;
  }

  void evaluate() {
    const RowMat3 rows = R;
    OuterField all;
    all.magnetic = field();
    evaluate_surroundings(3, 2, of(p), load_matrix(rows.data()), &all, around);
  }

  double energy() const {
    const MagneticField all = field();
    const Vec3 m = R * kMoment;
    return -m.dot(vec(magnetic_field(all, of(p), of(m)).B));
  }
};

/// (phi, dp).
Section moved(Section s, const VecX& d) {
  s.R = exp_so3(d.head<3>()) * s.R;
  s.p += d.tail<3>();
  return s;
}

// B from the difference of two opposite poles a hair apart
TEST(MagneticLoad, ADipoleIsTwoPolesNextToEachOther) {
  constexpr double kApart = 1e-4;
  const Vec3 p(0.4, -0.1, 0.3), at(0.1, 0.2, -0.2), moment(20, -30, 10);
  const MagneticDipole dipole{{at.x(), at.y(), at.z()}, {moment.x(), moment.y(), moment.z()}};
  MagneticField field;
  field.dipoles = &dipole;
  field.count = 1;
  const auto pole = [&](const Vec3& place, double strength) {
    const Vec3 r = p - place;
    return Vec3(1e-7 * strength * r / std::pow(r.norm(), 3));
  };
  const Vec3 half = 0.5 * kApart * moment.normalized();
  const Vec3 B = pole(at + half, moment.norm() / kApart) + pole(at - half, -moment.norm() / kApart);
  const Vec3 found = vec(magnetic_field(field, of(p), of(Vec3::Zero())).B);
  EXPECT_LT((found - B).norm(), 1e-7 * B.norm());
}

// force and torque are what the energy -m·B loses by a motion
TEST(MagneticLoad, DerivesFromItsEnergy) {
  for (int count : {0, 2}) {
    Section at;
    at.count = count;
    at.evaluate();
    const auto energy = [](const Section& s) { return VecX::Constant(1, s.energy()).eval(); };
    const MatX slope = difference_jacobian(energy, at, 6, moved);
    Vec6 load;
    load << Eigen::Map<Vec3>{at.around.moment}, Eigen::Map<Vec3>{at.around.force};
    EXPECT_LT((slope.transpose() - load).norm(), 1e-8 * load.norm()) << count;
  }
}

TEST(MagneticLoad, TangentsAreDerivatives) {
  for (int count : {0, 2}) {
    Section at;
    at.count = count;
    at.evaluate();
    MatX tangent(6, 6);
    tangent << Eigen::Map<RowMat3>{at.around.moment_phi}, Eigen::Map<RowMat3>{at.around.moment_p},
        Eigen::Map<RowMat3>{at.around.force_phi}, Eigen::Map<RowMat3>{at.around.force_p};
    const auto f = [](Section s) -> VecX {
      s.evaluate();
      Vec6 both;
      both << Eigen::Map<Vec3>{s.around.moment}, Eigen::Map<Vec3>{s.around.force};
      return both;
    };
    EXPECT_TRUE(jacobians_agree(tangent, difference_jacobian(f, at, 6, moved), 1e-8, 1e-8));
  }
}

TEST(MagneticLoad, IsNothingWithoutAMoment) {
  Section at;
  at.around.magnetic = 0;
  at.evaluate();
  EXPECT_EQ((Eigen::Map<Vec3>{at.around.force}.norm()), 0);
  EXPECT_EQ((Eigen::Map<Vec3>{at.around.moment}.norm()), 0);
}

}  // namespace
}  // namespace cprsim
