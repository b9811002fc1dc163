// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/rod_end.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "engine/math/so3.h"
#include "tests/engine/robot/sample_scenes.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr EndJoint kAll[] = {EndJoint::kFree, EndJoint::kFixed, EndJoint::kRevolute,
                             EndJoint::kUniversal, EndJoint::kBall};

RodEndSpec spec_of(EndJoint joint, bool spin, const Vec3& axis = {0.48, 0.6, 0.64}) {
  RodEndSpec spec = rod_end(joint, kWorld, Pose{});
  spec.spin_free = spin;
  spec.axis = axis;
  return spec;
}

struct Situation {
  NodeState end{};
  Port port;
};

constexpr RodScale kScale{0.7, 3, 2.1};

/// A joint that gapes by `angle` and `shift`.
Situation situation(unsigned seed, double angle, double shift) {
  Numbers numbers(seed);
  Situation s;
  const Pose J = numbers.pose(1, 1), gap = numbers.pose(angle, shift);
  s.port.R = J.R;
  s.port.p = J.p;
  s.port.arm = 0.4 * numbers.vec3();
  s.port.moves = true;
  const Pose E = J * gap;
  Eigen::Map<RowMat3>{s.end.R} = E.R;
  Eigen::Map<Vec3>{s.end.p} = E.p;
  Eigen::Map<Vec3>{s.end.n} = numbers.vec3();
  Eigen::Map<Vec3>{s.end.m} = numbers.vec3();
  return s;
}

/// d: phi, dp, dn, dm of the rod's end, then phi, dp of the body's reference point.
Situation moved(Situation s, const VecX& d) {
  Eigen::Map<RowMat3>{s.end.R} = exp_so3(d.head<3>()) * Mat3(rotation_of(s.end));
  Eigen::Map<Vec3>{s.end.p} += d.segment<3>(3);
  Eigen::Map<Vec3>{s.end.n} += d.segment<3>(6);
  Eigen::Map<Vec3>{s.end.m} += d.segment<3>(9);
  const Mat3 turn = exp_so3(d.segment<3>(12));
  const Vec3 reference = s.port.p - s.port.arm + d.tail<3>();
  s.port.R = turn * s.port.R;
  s.port.arm = turn * s.port.arm;
  s.port.p = reference + s.port.arm;
  return s;
}

TEST(RodEnd, RowsAreDerivativesOfTheirValues) {
  for (EndJoint joint : kAll)
    for (bool spin : {false, true})
      for (double angle : {0.0, 1e-8, 0.4, 1.5}) {
        const RodEnd end(spec_of(joint, spin));
        const Situation at = situation(4, angle, 0.3 * angle);
        const auto f = [&](const Situation& s) { return end.value(s.end, s.port, kScale); };
        const EndRows rows = end.rows(at.end, at.port, kScale);
        MatX analytic(6, 18);
        analytic << rows.by_state, rows.by_body;
        EXPECT_EQ(rows.value, f(at));
        // truncation (1e-3)^4 of functions of size 1
        EXPECT_TRUE(jacobians_agree(analytic, difference_jacobian(f, at, 18, moved), 1e-9, 1e-9))
            << "joint " << static_cast<int>(joint) << ", spin " << spin << ", angle " << angle;
      }
}

void expect_same(const RodEndSpec& one, const RodEndSpec& other) {
  const Situation at = situation(5, 0.3, 0.1);
  const RodEnd a(one), b(other);
  EXPECT_EQ(a.value(at.end, at.port, kScale), b.value(at.end, at.port, kScale));
  EXPECT_STREQ(a.row_name(5), b.row_name(5));
}

TEST(RodEnd, FreeSpinMakesTheNextFreerJoint) {
  const Vec3 axis = Vec3(0.48, 0.6, 0.64), z = Vec3::UnitZ();
  expect_same(spec_of(EndJoint::kFixed, true, axis), spec_of(EndJoint::kRevolute, false, z));
  expect_same(spec_of(EndJoint::kRevolute, true, z), spec_of(EndJoint::kRevolute, false, z));
  expect_same(spec_of(EndJoint::kUniversal, true, axis), spec_of(EndJoint::kBall, false));
  expect_same(spec_of(EndJoint::kBall, true), spec_of(EndJoint::kBall, false));
}

TEST(RodEnd, AClosedJointHasNoGap) {
  for (EndJoint joint : kAll)
    for (bool spin : {false, true}) {
      // the axis of a universal joint is perpendicular to the tangent, so its axes are too
      const RodEnd end(spec_of(joint, spin, Vec3::UnitX()));
      Situation at = situation(6, 0, 0);
      std::fill_n(at.end.n, 3, 0.0);
      std::fill_n(at.end.m, 3, 0.0);
      EXPECT_LT(end.value(at.end, at.port, kScale).norm(), 1e-15);  // round-off
    }
}

// What the joint lets move and what it lets through do no work on each other.
TEST(RodEnd, ConstraintWrenchesDoNoWork) {
  for (EndJoint joint : kAll)
    for (bool spin : {false, true}) {
      const RodEnd end(spec_of(joint, spin, Vec3::UnitX()));
      Situation at = situation(6, 0, 0);
      std::fill_n(at.end.m, 3, 0.0);
      const EndRows rows = end.rows(at.end, at.port, kScale);
      std::vector<Eigen::Index> pose, wrench;
      for (Eigen::Index i = 0; i < 6; ++i)
        (rows.by_state.row(i).head<6>().norm() > 0 ? pose : wrench).push_back(i);
      MatX P = MatX::Zero(6, 6), W = MatX::Zero(6, 6);
      for (Eigen::Index i : pose)
        P.row(i) = rows.by_state.row(i).head<6>();
      for (Eigen::Index i : wrench)
        W.row(i) << rows.by_state.row(i).tail<3>(), rows.by_state.row(i).segment<3>(6);
      const MatX motions = P.fullPivLu().kernel(), wrenches = W.fullPivLu().kernel();
      if (pose.size() < 6) {
        EXPECT_EQ(motions.cols(), 6 - static_cast<Eigen::Index>(pose.size()));
      }
      EXPECT_LT((motions.transpose() * wrenches).norm(), 1e-14)  // round-off
          << "joint " << static_cast<int>(joint) << ", spin " << spin;
    }
}

}  // namespace
}  // namespace cprsim
