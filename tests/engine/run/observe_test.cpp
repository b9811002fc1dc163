// SPDX-License-Identifier: BSD-3-Clause
#include "engine/run/observe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/model/scene.h"

namespace cprsim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kExact = 1e-14;  // a handful of rounding errors of numbers of order 1

Mat3 about(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// A body that falls from rest, turning at a constant rate about one axis.
Snapshot falling(double t) {
  Snapshot snapshot;
  snapshot.time = t;
  BodySample body;
  body.X_WB = {about({1, 2, 2}, 3 * t), Vec3(t, 0, 1 - 0.5 * 9.81 * t * t)};
  body.linear_velocity = Vec3(1, 0, -9.81 * t);
  body.angular_velocity = 3 * Vec3(1, 2, 2).normalized();
  snapshot.bodies.push_back(body);
  JointSample joint;
  joint.position.x() = t * t * t;
  joint.velocity.x() = 3 * t * t;
  snapshot.joints.push_back(joint);
  snapshot.energy.work = 2 * t;
  snapshot.solver.iterations = static_cast<int>(std::lround(10 * t));
  return snapshot;
}

/// A quarter of a circle of radius R in the x-z plane, tangent z at the base, sampled at n + 1
/// points.
RodSample quarter_circle(double R, int n) {
  RodSample rod;
  rod.length = R * kPi / 2;
  for (int i = 0; i <= n; ++i) {
    RodPoint point;
    point.s = static_cast<double>(i) / n;
    const double angle = point.s * kPi / 2;
    point.position = Vec3(R * (1 - std::cos(angle)), 0, R * std::sin(angle));
    point.rotation = about(Vec3::UnitY(), angle);
    point.curvature = Vec3(0, 1 / R, 0);
    rod.points.push_back(point);
  }
  return rod;
}

Channel channel(ChannelEntity entity, Quantity quantity, int component = 0, double s = 0) {
  Channel c;
  c.name = "test";
  c.entity = entity;
  c.index = 0;
  c.s = s;
  c.quantity = quantity;
  c.component = component;
  return c;
}

TEST(Interpolate, IsExactForCubicMotionAndConstantRates) {
  const Snapshot a = falling(0.1), b = falling(0.5);
  for (const double t : {0.1, 0.2, 0.37, 0.5}) {
    const Snapshot exact = falling(t), got = interpolate(a, b, t);
    EXPECT_EQ(got.time, t);
    EXPECT_LT((got.bodies[0].X_WB.p - exact.bodies[0].X_WB.p).norm(), kExact);
    EXPECT_LT((got.bodies[0].X_WB.R - exact.bodies[0].X_WB.R).norm(), kExact);
    EXPECT_NEAR(got.joints[0].position.x(), exact.joints[0].position.x(), kExact);
    EXPECT_NEAR(got.energy.work, exact.energy.work, kExact);
  }
}

TEST(Interpolate, ReturnsTheEndsUntouchedAndNeverExtrapolates) {
  const Snapshot a = falling(0.1), b = falling(0.5);
  EXPECT_EQ(interpolate(a, b, 0.1).bodies[0].X_WB.p, a.bodies[0].X_WB.p);
  EXPECT_EQ(interpolate(a, b, 0.5).bodies[0].X_WB.p, b.bodies[0].X_WB.p);
  EXPECT_EQ(interpolate(a, b, 0.6).bodies[0].X_WB.p, b.bodies[0].X_WB.p);
  EXPECT_EQ(interpolate(a, b, 0.2).solver.iterations, b.solver.iterations);
}

TEST(Interpolate, GoesLinearlyWhereNothingHasAVelocity) {
  Snapshot a = falling(0), b = falling(1);
  for (Snapshot* s : {&a, &b}) {
    s->bodies[0].linear_velocity.setZero();
    s->joints[0].velocity.setZero();
  }
  const Snapshot quarter = interpolate(a, b, 0.25);
  EXPECT_LT(
      (quarter.bodies[0].X_WB.p - (0.75 * a.bodies[0].X_WB.p + 0.25 * b.bodies[0].X_WB.p)).norm(),
      kExact);
  EXPECT_NEAR(quarter.joints[0].position.x(), 0.25, kExact);
}

TEST(Interpolate, KeepsTheGridOfTheLaterStateWhenItChanged) {
  Snapshot a, b;
  a.rods.push_back(quarter_circle(1, 8));
  b.time = 1;
  b.rods.push_back(quarter_circle(1, 4));
  const Snapshot half = interpolate(a, b, 0.5);
  ASSERT_EQ(half.rods[0].points.size(), 5u);
  EXPECT_LT((half.rods[0].points[1].position - b.rods[0].points[1].position).norm(), kExact);
}

/// Rod 0 touches link 1 at two points and rod 1 at one; links 2 and 1 touch each other.
Snapshot touching() {
  Snapshot snapshot;
  ContactSample& contact = snapshot.contact;
  ContactPoint point;
  point.normal = Vec3::UnitZ();
  point.other = {false, 1};
  point.position = Vec3(1, 0, 0);
  point.force = Vec3(0.5, 0, 3);
  point.slip = Vec3(0.1, 0, 0);
  point.gap = -1e-4;
  contact.points.push_back(point);
  point.position = Vec3(2, 0, 0);
  point.force = Vec3(-0.5, 0, 1);
  point.slip = Vec3(0, -0.2, 0);
  point.gap = -2e-4;
  contact.points.push_back(point);
  point.other = {true, 1};
  point.force = Vec3(0, 0, 7);
  contact.points.push_back(point);
  LinkContact link;
  link.link = 2;
  link.other = 1;
  link.force = Vec3(0, 0, 5);
  contact.links.push_back(link);
  contact.distances.push_back(
      {{ContactParty{false, 1}, ContactParty{true, 0}}, -3e-4, Vec3::Zero()});
  contact.distances.push_back(
      {{ContactParty{true, 0}, ContactParty{false, 3}}, 0.02, Vec3(4, 5, 6)});
  return snapshot;
}

double of_pair(const ContactPair& pair, Quantity quantity, int component = 0) {
  Channel c = channel(ChannelEntity::kContactPair, quantity, component);
  c.pair = pair;
  return evaluate(c, Scene{}, touching());
}

TEST(Evaluate, SumsUpThePointsOfAPair) {
  const ContactParty rod{true, 0}, link{false, 1};
  EXPECT_EQ(of_pair({rod, link}, Quantity::kContactCount), 2);
  EXPECT_EQ(of_pair({rod, link}, Quantity::kForce, 2), 4);
  EXPECT_EQ(of_pair({link, rod}, Quantity::kForce, 2), -4);
  EXPECT_EQ(of_pair({rod, link}, Quantity::kForce, 0), 0);
  EXPECT_EQ(of_pair({link, rod}, Quantity::kContactForce), 4);
  EXPECT_EQ(of_pair({rod, link}, Quantity::kContactFriction), 1);
  EXPECT_EQ(of_pair({rod, link}, Quantity::kPosition, 0), 1.25);  // (3 * 1 + 1 * 2) / 4
  EXPECT_EQ(of_pair({rod, link}, Quantity::kContactSlip), 0.2);
  EXPECT_EQ(of_pair({rod, link}, Quantity::kContactPenetration), 3e-4);
  EXPECT_EQ(of_pair({rod, link}, Quantity::kContactGap), -3e-4);
  EXPECT_EQ(of_pair({rod, {true, 1}}, Quantity::kContactForce), 7);
  EXPECT_EQ(of_pair({link, {false, 2}}, Quantity::kForce, 2), -5);
}

TEST(Evaluate, OfAPairThatDoesNotTouchIsWhereItIsNearest) {
  const ContactPair apart{ContactParty{true, 0}, ContactParty{false, 3}};
  EXPECT_EQ(of_pair(apart, Quantity::kContactCount), 0);
  EXPECT_EQ(of_pair(apart, Quantity::kContactGap), 0.02);
  EXPECT_EQ(of_pair(apart, Quantity::kContactPenetration), 0);
  EXPECT_EQ(of_pair(apart, Quantity::kPosition, 1), 5);
  EXPECT_EQ(of_pair({ContactParty{true, 1}, ContactParty{true, 1}}, Quantity::kPosition), 0);
}

TEST(PointAt, ErrorFallsWithTheSixthPowerOfTheSpacing) {
  const auto error = [](int n) {
    const double s = (1 + 0.5) / n, angle = s * kPi / 2;
    const RodPoint point = point_at(quarter_circle(1, n), s);
    return (point.position - Vec3(1 - std::cos(angle), 0, std::sin(angle))).norm();
  };
  for (const int n : {2, 4, 8}) {
    EXPECT_NEAR(std::log2(error(n) / error(2 * n)), 6, 0.2);  // quintic Hermite: h^6
  }
}

/// 1 m of a curve in the xz plane whose curvature is 3 + 2 sin(2 s), under a moment of 1 N m²
/// times that.
double heading(double s) {
  return 3 * s + 1 - std::cos(2 * s);
}

RodPoint wavy_point(double s) {
  RodPoint point;
  point.s = s;
  constexpr int kPieces = 400;  // Simpson's rule
  for (int i = 0; i < kPieces; ++i)
    for (const auto& [at, weight] : {std::pair{0., 1.}, std::pair{0.5, 4.}, std::pair{1., 1.}}) {
      const double angle = heading(s * (i + at) / kPieces);
      point.position += weight * s / (6 * kPieces) * Vec3(std::sin(angle), 0, std::cos(angle));
    }
  point.rotation = about(Vec3::UnitY(), heading(s));
  point.curvature = Vec3(0, 3 + 2 * std::sin(2 * s), 0);
  point.moment = point.curvature;
  // m_s = -t × n, with n across the tangent
  point.force = -4 * std::cos(2 * s) * (point.rotation * Vec3::UnitX());
  return point;
}

RodSample wavy(int n) {
  RodSample rod;
  rod.length = 1;
  for (int i = 0; i <= n; ++i)
    rod.points.push_back(wavy_point(static_cast<double>(i) / n));
  return rod;
}

struct WavyErrors {
  double position = 0, rotation = 0, curvature = 0, moment = 0, force = 0;

  explicit WavyErrors(const RodSample& rod) {
    for (int k = 0; k < 100; ++k) {
      const double s = (k + 0.5) / 100;
      const RodPoint got = point_at(rod, s), exact = wavy_point(s);
      position = std::max(position, (got.position - exact.position).norm());
      rotation = std::max(rotation, (got.rotation - exact.rotation).norm());
      curvature = std::max(curvature, (got.curvature - exact.curvature).norm());
      moment = std::max(moment, (got.moment - exact.moment).norm());
      force = std::max(force, (got.force - exact.force).norm());
    }
  }
};

TEST(PointAt, KnowsWhatStrainsAndForcesSay) {
  const WavyErrors coarse(wavy(8)), fine(wavy(16));
  EXPECT_GT(std::log2(coarse.position / fine.position), 5.5);
  EXPECT_GT(std::log2(coarse.rotation / fine.rotation), 3.7);
  EXPECT_GT(std::log2(coarse.curvature / fine.curvature), 2.7);
  EXPECT_GT(std::log2(coarse.moment / fine.moment), 3.7);
  EXPECT_GT(std::log2(coarse.force / fine.force), 2.5);
  EXPECT_LT(fine.position, 1e-8);
}

// A node between two sections knows the mean of its two curvatures: nothing is built on that.
TEST(PointAt, IsNotMisledByAJump) {
  RodSample rod = quarter_circle(1, 8);
  const double before =
      (point_at(rod, 0.3).position - point_at(quarter_circle(1, 64), 0.3).position).norm();
  EXPECT_LT(before, 1e-8);
  rod.points[3].curvature *= 3;
  for (const double s : {0.27, 0.3, 0.34}) {
    const RodPoint got = point_at(rod, s);
    const double angle = s * kPi / 2;
    EXPECT_LT((got.position - Vec3(1 - std::cos(angle), 0, std::sin(angle))).norm(), 2e-5);
    EXPECT_LT((got.rotation - about(Vec3::UnitY(), angle)).norm(), 5e-3);
  }
}

TEST(PointAt, GivesGridPointsExactlyAndHoldsTheEnds) {
  const RodSample rod = quarter_circle(0.3, 5);
  for (const RodPoint& point : rod.points) {
    EXPECT_EQ(point_at(rod, point.s).position, point.position);
  }
  EXPECT_EQ(point_at(rod, 1.5).position, rod.points.back().position);
  EXPECT_LT((point_at(rod, 0.31).rotation - about(Vec3::UnitY(), 0.31 * kPi / 2)).norm(), kExact);
}

TEST(PointAt, NamesARodWithoutPoints) {
  EXPECT_THROW(point_at(RodSample{}, 0.5), std::invalid_argument);
}

TEST(Evaluate, ReadsBodiesFramesJointsAndRods) {
  Scene scene;
  NamedFrame frame;
  frame.at = {0, {Mat3::Identity(), Vec3(0.1, 0, 0)}};
  scene.frames.push_back(frame);
  Snapshot snapshot = falling(0.2);
  snapshot.rods.push_back(quarter_circle(0.5, 6));
  const BodySample& body = snapshot.bodies[0];

  EXPECT_EQ(evaluate(channel(ChannelEntity::kBody, Quantity::kPosition, 2), scene, snapshot),
            body.X_WB.p.z());
  const Vec3 arm = body.X_WB.R * Vec3(0.1, 0, 0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(evaluate(channel(ChannelEntity::kFrame, Quantity::kPosition, i), scene, snapshot),
                (body.X_WB.p + arm)[i], kExact);
    EXPECT_NEAR(
        evaluate(channel(ChannelEntity::kFrame, Quantity::kLinearVelocity, i), scene, snapshot),
        (body.linear_velocity + body.angular_velocity.cross(arm))[i], kExact);
  }
  EXPECT_EQ(evaluate(channel(ChannelEntity::kJoint, Quantity::kJointVelocity), scene, snapshot),
            snapshot.joints[0].velocity.x());
  EXPECT_EQ(evaluate(channel(ChannelEntity::kRod, Quantity::kLength), scene, snapshot),
            0.5 * kPi / 2);
  EXPECT_NEAR(
      evaluate(channel(ChannelEntity::kRodPoint, Quantity::kPosition, 0, 1), scene, snapshot), 0.5,
      kExact);
  EXPECT_NEAR(
      evaluate(channel(ChannelEntity::kRodPoint, Quantity::kCurvature, 1, 0.4), scene, snapshot), 2,
      kExact);
  EXPECT_NEAR(evaluate(channel(ChannelEntity::kEnergy, Quantity::kEnergyWork), scene, snapshot),
              0.4, kExact);
  EXPECT_EQ(evaluate(channel(ChannelEntity::kSolver, Quantity::kSolverIterations), scene, snapshot),
            2);
}

TEST(Evaluate, RefusesAQuantityThatTheEntityDoesNotHave) {
  const Snapshot snapshot = falling(0);
  EXPECT_THROW(evaluate(channel(ChannelEntity::kBody, Quantity::kLength), Scene{}, snapshot),
               std::invalid_argument);
}

TEST(ChannelReader, KeepsTheSignOfAQuaternionContinuousOverTwoTurns) {
  std::vector<Channel> channels;
  for (int i = 0; i < 4; ++i) {
    channels.push_back(channel(ChannelEntity::kBody, Quantity::kOrientation, i));
  }
  const Scene scene;
  ChannelReader reader(scene, channels);
  Vec4 last = Vec4::Zero();
  const double step = 4 * kPi / 3 / 60;  // falling() turns at 3 rad/s
  for (int k = 0; k <= 60; ++k) {
    const std::vector<double>& row = reader.read(falling(k * step));
    const Vec4 q(row[0], row[1], row[2], row[3]);
    EXPECT_NEAR(q.norm(), 1, kExact);
    if (k > 0) {
      EXPECT_LT((q - last).norm(), 1.01 * 3 * step / 2);  // |dq| = angle / 2
    }
    last = q;
  }
  EXPECT_NEAR(last.w(), 1, 1e-12);  // two whole turns: back at the start, not at its negative
}

}  // namespace
}  // namespace cprsim
