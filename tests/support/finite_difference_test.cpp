// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/finite_difference.h"

#include <cmath>
#include <limits>

namespace cprsim {
namespace {

VecX curve(const VecX& x) {
  return Vec2(std::sin(x[0]) * x[1], std::exp(x[1]) + x[2] * x[2]);
}

MatX slope_of_curve(const VecX& x) {
  MatX J(2, 3);
  J << std::cos(x[0]) * x[1], std::sin(x[0]), 0, 0, std::exp(x[1]), 2 * x[2];
  return J;
}

TEST(FiniteDifference, AgreesWithAnExactJacobian) {
  const VecX x = Vec3(0.3, -1.2, 0.7);
  EXPECT_TRUE(jacobians_agree(slope_of_curve(x), difference_jacobian(curve, x), 1e-11));
}

TEST(FiniteDifference, FallsWithTheFourthPowerOfTheStep) {
  const VecX x = Vec3(0.3, -1.2, 0.7);
  const auto error = [&](double h) {
    return (difference_jacobian(curve, x, h) - slope_of_curve(x)).norm();
  };
  EXPECT_NEAR(std::log2(error(0.1) / error(0.05)), 4, 0.1);
}

TEST(FiniteDifference, NamesTheWrongEntry) {
  const VecX x = Vec3(0.3, -1.2, 0.7);
  MatX wrong = slope_of_curve(x);
  wrong(1, 2) *= 1.001;
  const auto result = jacobians_agree(wrong, difference_jacobian(curve, x), 1e-8);
  EXPECT_FALSE(result);
  EXPECT_NE(std::string(result.message()).find("(1, 2)"), std::string::npos) << result.message();
  wrong(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(jacobians_agree(wrong, difference_jacobian(curve, x), 1e-8));
}

TEST(FiniteDifference, WorksOnRotations) {
  // y = R a with R ⊕ d = R exp(d): ∂y/∂d = -R â
  const Vec3 a(1, 2, 3);
  const Mat3 R = Eigen::AngleAxisd(2.5, Vec3(1, -1, 2).normalized()).toRotationMatrix();
  const auto turn = [](const Mat3& at, const VecX& d) -> Mat3 {
    const double angle = d.norm();
    const Vec3 axis = angle > 0 ? Vec3(d / angle) : Vec3::UnitX();
    return at * Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  };
  Mat3 hat;
  hat << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  const auto image = [&](const Mat3& at) -> Vec3 { return at * a; };
  EXPECT_TRUE(jacobians_agree(-R * hat, difference_jacobian(image, R, 3, turn), 1e-10));
}

}  // namespace
}  // namespace cprsim
