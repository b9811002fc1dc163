// SPDX-License-Identifier: BSD-3-Clause
// The Eigen types used everywhere, and the pose of a frame.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace cprsim {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;
using VecX = Eigen::VectorXd;
using MatX = Eigen::MatrixXd;
using Quat = Eigen::Quaterniond;

/// Pose X_AB = (R_AB, p_AB) of frame B in frame A: maps B coordinates to A coordinates.
struct Pose {
  Mat3 R = Mat3::Identity();
  Vec3 p = Vec3::Zero();

  Pose operator*(const Pose& X_BC) const { return {R * X_BC.R, p + R * X_BC.p}; }

  Vec3 operator*(const Vec3& p_B) const { return p + R * p_B; }

  Pose inverse() const { return {R.transpose(), -(R.transpose() * p)}; }
};

}  // namespace cprsim
