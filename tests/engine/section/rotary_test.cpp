// SPDX-License-Identifier: BSD-3-Clause
#include "engine/section/rotary.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "engine/robot/body.h"
#include "engine/rod/cell.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

struct Section {
  CellModel model;
  CellStage stage{};
};

Section section(double angle, bool body_rates) {
  Section s;
  s.model.rotary = true;
  s.model.c_v = 3;
  s.model.c_w = 2;
  s.model.body_rates = body_rates;
  Eigen::Map<Vec3>{s.model.rhoJ} = Vec3(0.3, 0.5, 0.8);
  const Mat3 start = exp_so3({0.3, -0.7, 1.1});
  Eigen::Map<RowMat3>{s.stage.R_start} = start;
  Eigen::Map<RowMat3>{s.stage.R} = start * exp_so3(angle * Vec3(0.48, -0.6, 0.64));
  Eigen::Map<Vec3>{s.stage.theta_h} = Vec3(0.4, 0.9, -0.6);
  Eigen::Map<Vec3>{s.stage.omega_h} = Vec3(-0.8, 0.2, 0.5);
  return s;
}

constexpr double kAngles[] = {0, 1e-8, 0.4, 1.5, 2.8};

TEST(Rotary, TorqueTangentIsTheDerivative) {
  for (bool body_rates : {false, true})
    for (double angle : kAngles) {
      Section at = section(angle, body_rates);
      evaluate_rotary(at.model, at.stage);
      const auto f = [](Section s) -> VecX {
        evaluate_rotary(s.model, s.stage);
        return Eigen::Map<const Vec3>(s.stage.torque);
      };
      const auto turned = [](Section s, const VecX& phi) {
        Eigen::Map<RowMat3>{s.stage.R} = exp_so3(phi) * Mat3(Eigen::Map<RowMat3>{s.stage.R});
        return s;
      };
      // truncation (1e-3)^4 times fifth derivatives that grow near pi
      EXPECT_TRUE(jacobians_agree(Eigen::Map<const RowMat3>(at.stage.torque_phi),
                                  difference_jacobian(f, at, 3, turned), 1e-9, 1e-9))
          << body_rates << ", angle " << angle;
    }
}

// A section is a rigid body: two pieces of code, one law.
TEST(Rotary, SectionAndRigidBodyAgree) {
  for (bool body_rates : {false, true})
    for (double angle : kAngles) {
      Section s = section(angle, body_rates);
      evaluate_rotary(s.model, s.stage);
      RigidBody body;
      body.inertia = Eigen::Map<Vec3>(s.model.rhoJ).asDiagonal();
      body.R = Eigen::Map<RowMat3>(s.stage.R_start);
      body.start_tracks(Vec3::Zero(), Vec3::Zero());
      body.rotation.x_h = Eigen::Map<Vec3>(s.stage.theta_h);
      body.rotation.v_h = Eigen::Map<Vec3>(s.stage.omega_h);
      body.R = Eigen::Map<RowMat3>(s.stage.R);
      const RigidBody::Inertial inertial = body.inertial({3, 2, body_rates});
      constexpr double kRoundOff = 1e-13;  // of torques near 30
      EXPECT_LT((inertial.wrench.head<3>() - Eigen::Map<Vec3>(s.stage.torque)).norm(), kRoundOff);
      EXPECT_LT((inertial.by_motion.topLeftCorner<3, 3>() - Eigen::Map<RowMat3>(s.stage.torque_phi))
                    .norm(),
                10 * kRoundOff);
    }
}

}  // namespace
}  // namespace cprsim
