// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/collocation_point.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/engine/robot/sample_scenes.h"

namespace cprsim {
namespace {

struct Sample {
  PointModel model;
  CollocationPoint point;

  explicit Sample(unsigned seed, bool extensible, bool rotary) {
    Numbers numbers(seed);
    model.C_bt = {0.7, 0.9, 1.3};
    if (extensible) model.C_se = {0.03, 0.05, 0.02};
    model.k = 2.5;
    model.rotary = rotary;
    model.c_v = 3;
    model.c_w = 4;
    model.body_rates = true;
    Eigen::Map<Vec3>(model.rhoJ) = Vec3(0.1, 0.2, 0.25);
    point.u0 = 0.4 * numbers.vec3();
    point.b = numbers.vec3();
    for (int i = 0; i < 13; ++i) {
      point.y[i] = numbers.next();
      point.y_s[i] = numbers.next();
    }
    point.y[kQ] += 1.5;  // |q| is not one, nor need it be
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(point.spin.R_start) =
        exp_so3(0.3 * numbers.vec3()) * rotation_of(Vec4(point.y.head<4>()));
    Eigen::Map<Vec3>(point.spin.theta_h) = numbers.vec3();
    Eigen::Map<Vec3>(point.spin.omega_h) = numbers.vec3();
  }

  Vec13 rows(const Vec13& dy, const Vec13& dy_s) const {
    CollocationPoint moved = point;
    moved.y += dy;
    moved.y_s += dy_s;
    return evaluate_point(model, moved);
  }
};

TEST(CollocationPoint, TangentsAreThoseOfTheRows) {
  for (unsigned seed : {1u, 2u, 3u})
    for (bool extensible : {false, true})
      for (bool rotary : {false, true}) {
        Sample sample(seed, extensible, rotary);
        evaluate_point(sample.model, sample.point);
        Mat13 by_y, by_y_s;
        linearize_point(sample.model, sample.point, by_y, by_y_s);
        for (int c = 0; c < 13; ++c) {
          const double h = 1e-3;
          const Vec13 d = h * Vec13::Unit(c), zero = Vec13::Zero();
          const Vec13 along_y = (8 * (sample.rows(d, zero) - sample.rows(-d, zero)) -
                                 (sample.rows(2 * d, zero) - sample.rows(-2 * d, zero))) /
                                (12 * h);
          const Vec13 along_y_s = (8 * (sample.rows(zero, d) - sample.rows(zero, -d)) -
                                   (sample.rows(zero, 2 * d) - sample.rows(zero, -2 * d))) /
                                  (12 * h);
          for (int r = 0; r < 13; ++r) {
            EXPECT_NEAR(by_y(r, c), along_y[r], 1e-8) << "row " << r << ", y " << c;
            EXPECT_NEAR(by_y_s(r, c), along_y_s[r], 1e-8) << "row " << r << ", y_s " << c;
          }
        }
      }
}

TEST(CollocationPoint, QuaternionIncrementsTurnAndScale) {
  Vec4 q;
  q << 0.8, -0.3, 0.5, 0.6;
  const Mat3 R = rotation_of(q);
  EXPECT_LT((R * R.transpose() - Mat3::Identity()).norm(), 1e-15);
  const Vec3 phi(1e-6, -2e-6, 3e-6);
  Vec4 d;
  d << 4e-6, phi;
  const Vec4 moved = q + quaternion_by_increment(q) * d;
  EXPECT_LT((log_so3(rotation_of(moved) * R.transpose()) - phi).norm(), 1e-10);
  EXPECT_NEAR(moved.norm() / q.norm() - 1, 4e-6, 1e-11);
  EXPECT_LT((turn_by_quaternion(q) * (moved - q) - phi).norm(), 1e-15);
  const Vec3 turn(0.4, 1.2, -2.5);
  EXPECT_LT((rotation_of(quaternion_of(turn)) - exp_so3(turn)).norm(), 1e-15);
  EXPECT_LT((rotation_of(quaternion_product(quaternion_of(turn), q)) - exp_so3(turn) * R).norm(),
            1e-14);
}

// The same rod seen from another frame: rows in section axes stay, rows in world axes turn.
TEST(CollocationPoint, RowsTurnWithTheFrame) {
  Sample sample(5, true, true);
  const Vec13 rows = evaluate_point(sample.model, sample.point);
  const Vec3 turn(0.7, -1.9, 0.4);
  const Vec4 q = quaternion_of(turn);
  const Mat3 R = exp_so3(turn);
  Sample turned = sample;
  for (Vec13* y : {&turned.point.y, &turned.point.y_s}) {
    y->head<4>() = quaternion_product(q, Vec4(y->head<4>()));
    for (int at : {kP, kN, kM})
      y->segment<3>(at) = (R * y->segment<3>(at)).eval();
  }
  turned.point.b = R * sample.point.b;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> start(turned.point.spin.R_start);
  start = (R * Mat3(start)).eval();
  const Vec13 rows_turned = evaluate_point(turned.model, turned.point);
  EXPECT_LT((rows_turned.head<4>() - rows.head<4>()).norm(), 1e-13);
  for (int at : {kP, kN, kM})
    EXPECT_LT((rows_turned.segment<3>(at) - R * rows.segment<3>(at)).norm(), 1e-12) << at;
}

TEST(CollocationPoint, OnlyTheFirstRowSeesTheLengthOfTheQuaternion) {
  Sample sample(6, true, false);
  const Vec13 rows = evaluate_point(sample.model, sample.point);
  Sample scaled = sample;
  // a q with a(s) = 1.7 here, a_s = 0.9
  scaled.point.y.head<4>() = 1.7 * sample.point.y.head<4>();
  scaled.point.y_s.head<4>() = 1.7 * sample.point.y_s.head<4>() + 0.9 * sample.point.y.head<4>();
  const Vec13 rows_scaled = evaluate_point(scaled.model, scaled.point);
  EXPECT_LT((rows_scaled.tail<12>() - rows.tail<12>()).norm(), 1e-14);
  EXPECT_GT(std::abs(rows_scaled[kQ] - rows[kQ]), 0.1);
}

}  // namespace
}  // namespace cprsim
