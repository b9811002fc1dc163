// SPDX-License-Identifier: BSD-3-Clause
// Free bodies that touch planes, obstacles and each other.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

#include "tests/collision/worlds.h"

namespace cprsim {
namespace {

constexpr double kG = 9.81;

TEST(Contact, ADroppedCubeLandsAndRests) {
  for (double dt : {1e-3, 5e-3}) {
    World world(scene_of({ground(), cube(Vec3(0, 0, 0.2))}));
    world.run(1.5, dt);
    EXPECT_NEAR(world[1].X_WB.p.z(), 0.01, 1e-8) << dt;
    EXPECT_LT(world[1].X_WB.p.head<2>().norm(), 1e-9) << dt;
    EXPECT_LT(world[1].linear_velocity.norm(), 1e-9) << dt;
    EXPECT_EQ(world.free->contacts().count, 4);
    EXPECT_LT(world.free->contacts().penetration, 1e-8);
  }
}

// On a slope: the plane's forces on the cube, summed up, are its weight, friction's share included.
TEST(Contact, SinglePointsCarryTheWeight) {
  const double slope = 0.3;
  World world(scene_of({ground(Vec3(-std::sin(slope), 0, std::cos(slope))), [&] {
                          BodySpec body = cube(Vec3::Zero());
                          const Mat3 R =
                              Eigen::AngleAxisd(-slope, Vec3::UnitY()).toRotationMatrix();
                          body.X_WB = {R, R * Vec3(0, 0, 0.01)};
                          return body;
                        }()}));
  world.run(1, 1e-3);
  const ContactSample contact = world.free->contacts();
  ASSERT_EQ(contact.links.size(), 4u);
  Vec3 on_cube = Vec3::Zero();
  for (const LinkContact& point : contact.links) {
    EXPECT_EQ(point.link + point.other, 1);
    on_cube += (point.link == 1 ? 1 : -1) * point.force;
    EXPECT_LT(point.slip.norm(), 1e-6);
    EXPECT_LT(std::abs(point.gap), 1e-6);
    EXPECT_NEAR(std::abs(point.normal.z()), std::cos(slope), 1e-9);
  }
  EXPECT_LT((on_cube - Vec3(0, 0, 0.1 * kG)).norm(), 1e-3 * 0.1 * kG);
}

TEST(Contact, ATiltedCubeComesToRestOnAFace) {
  BodySpec body = cube(Vec3(0, 0, 0.05));
  body.X_WB.R = Eigen::AngleAxisd(0.4, Vec3(1, 2, 0.5).normalized()).toRotationMatrix();
  World world(scene_of({ground(), body}));
  world.run(3, 1e-3);
  EXPECT_NEAR(world[1].X_WB.p.z(), 0.01, 1e-6);
  EXPECT_LT(world[1].linear_velocity.norm(), 1e-6);
  EXPECT_LT(world[1].angular_velocity.norm(), 1e-4);
}

TEST(Contact, EnergyNeverGrowsWhileACubeTumblesToRest) {
  BodySpec body = cube(Vec3(0, 0, 0.05));
  body.X_WB.R = Eigen::AngleAxisd(0.7, Vec3(1, 0.3, 0).normalized()).toRotationMatrix();
  body.linear_velocity = Vec3(0.3, 0, 0);
  World world(scene_of({ground(), body}));
  double last = world.energy();
  for (int i = 0; i < 1500; ++i) {
    world.step(1e-3);
    EXPECT_LT(world.energy(), last + 2e-5 * 0.1 * kG * 0.05) << i;  // 2e-5 of the drop
    last = world.energy();
  }
}

class Resting : public ::testing::TestWithParam<std::pair<ShapeKind, double>> {};

TEST_P(Resting, EveryShapeRestsOnAPlane) {
  const auto& [kind, height] = GetParam();
  ShapeSpec spec = shape(kind, Vec3(0.01, 0.02, 0.005));
  if (kind == ShapeKind::kEllipsoid) spec.size = Vec3(0.01, 0.02, 0.006);
  Scene scene = scene_of({ground(), loose_body(spec, Vec3(0, 0, height + 0.01))});
  if (kind == ShapeKind::kMesh) {
    // a pyramid on a square of edge 2 cm, apex 2 cm above, with a vertex inside
    MeshSpec mesh;
    mesh.positions = {{-0.01f, -0.01f, 0}, {0.01f, -0.01f, 0}, {0.01f, 0.01f, 0},
                      {-0.01f, 0.01f, 0},  {0, 0, 0.02f},      {0, 0, 0.005f}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    scene.meshes = {mesh};
    scene.bodies[1].colliders[0].shape.mesh = 0;
    scene.bodies[1].com = Vec3(0, 0, 0.005);
  }
  World world(scene);
  world.run(1, 1e-3);
  EXPECT_NEAR(world[1].X_WB.p.z(), height, 1e-8);
  EXPECT_LT(world[1].linear_velocity.norm(), 1e-7);
  EXPECT_LT(world[1].X_WB.p.head<2>().norm(), 1e-7) << "it rolls away";
  EXPECT_GT(world.free->contacts().count, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, Resting,
    ::testing::Values(std::pair{ShapeKind::kBox, 0.0025}, std::pair{ShapeKind::kSphere, 0.01},
                      std::pair{ShapeKind::kCylinder, 0.01}, std::pair{ShapeKind::kCapsule, 0.02},
                      std::pair{ShapeKind::kCone, 0.01}, std::pair{ShapeKind::kEllipsoid, 0.006},
                      std::pair{ShapeKind::kMesh, 0.0}));

TEST(Contact, LyingCapsulesAndCylindersDoNotRollAway) {
  const Mat3 lying = Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitX()).toRotationMatrix();
  for (ShapeKind kind : {ShapeKind::kCapsule, ShapeKind::kCylinder}) {
    BodySpec body =
        loose_body(shape(kind, Vec3(0.001, 0.02, 0)), Vec3(0, 0, 0.003), Vec3(3e-6, 3e-6, 5e-8));
    body.X_WB.R = lying;
    World world(scene_of({ground(), body}));
    world.run(2, 1e-3);
    EXPECT_NEAR(world[1].X_WB.p.z(), 0.001, 1e-8);
    EXPECT_LT(world[1].X_WB.p.head<2>().norm(), 1e-6);
    EXPECT_LT(world[1].linear_velocity.norm(), 1e-6);
  }
}

/// A thin plate, turned by `yaw` about its normal, on a plane inclined by `angle` about y; distance
/// slid down the slope after 1 s.
double slide(double angle, double friction, bool effect, double dt, double yaw = 0) {
  const Mat3 R = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
  BodySpec plate = loose_body(shape(ShapeKind::kBox, Vec3(0.04, 0.04, 0.002)),
                              R * Vec3(0, 0, 0.001), Vec3(1.3e-5, 1.3e-5, 2.7e-5));
  plate.X_WB.R = R * Eigen::AngleAxisd(yaw, Vec3::UnitZ()).toRotationMatrix();
  plate.colliders[0].surface.friction = friction;
  Scene scene = scene_of({ground(R * Vec3::UnitZ()), plate});
  scene.effects.set(Effect::kFriction, effect);
  World world(scene);
  world.run(1, dt);
  return (R.transpose() * world[1].X_WB.p).x();
}

TEST(Contact, SlidingFollowsCoulomb) {
  const double angle = 0.5;
  for (double dt : {1e-3, 5e-3}) {
    EXPECT_NEAR(slide(angle, 0.3, false, dt), kG * std::sin(angle) / 2, 1e-6) << dt;
    const double a = kG * (std::sin(angle) - 0.3 * std::cos(angle));
    EXPECT_NEAR(slide(angle, 0.3, true, dt), a / 2, 1e-6) << dt;
  }
}

TEST(Contact, FrictionIsTheSameInAllDirections) {
  for (double yaw : {0.3, 0.785})
    EXPECT_NEAR(slide(0.5, 0.3, true, 1e-3, yaw), slide(0.5, 0.3, true, 1e-3), 1e-6) << yaw;
}

TEST(Contact, SticksBelowTheAngleOfFrictionAndSlidesAbove) {
  const double angle = std::atan(0.4);
  EXPECT_NEAR(slide(0.99 * angle, 0.4, true, 1e-3), 0, 1e-6);
  EXPECT_GT(slide(1.01 * angle, 0.4, true, 1e-3), 1e-3);
}

TEST(Contact, ABallRollsDownASlope) {
  // without slip: a = 5/7 g sin
  const double angle = 0.2;
  const Mat3 R = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
  World world(scene_of({ground(R * Vec3::UnitZ()), ball(0.01, R * Vec3(0, 0, 0.01))}));
  world.run(1, 1e-3);
  const double expected = 5.0 / 7 * kG * std::sin(angle) / 2;
  EXPECT_NEAR((R.transpose() * world[1].X_WB.p).x(), expected, 1e-3 * expected);
}

TEST(Contact, BitmasksDecideWhoTouches) {
  BodySpec body = cube(Vec3(0, 0, 0.02));
  body.colliders[0].surface.category_bitmask = 2;
  body.colliders[0].surface.collide_bitmask = 2;
  BodySpec floor = ground();
  floor.colliders[0].surface.category_bitmask = 1;
  floor.colliders[0].surface.collide_bitmask = 1;
  World through(scene_of({floor, body}));
  through.run(0.5, 1e-3);
  EXPECT_LT(through[1].X_WB.p.z(), -1);
  floor.colliders[0].surface.collide_bitmask = 3;
  World held(scene_of({floor, body}));
  held.run(0.5, 1e-3);
  EXPECT_NEAR(held[1].X_WB.p.z(), 0.01, 1e-6);
}

TEST(Contact, EachColliderOfABodyHasItsOwnMask) {
  // the lower of two boxes passes through the ground, the upper one lands on it
  BodySpec body = cube(Vec3(0, 0, 0.2));
  body.colliders.push_back(body.colliders[0]);
  body.colliders[1].X_BC.p = Vec3(0, 0, -0.05);
  body.colliders[1].surface.category_bitmask = body.colliders[1].surface.collide_bitmask = 2;
  BodySpec floor = ground();
  floor.colliders[0].surface.category_bitmask = floor.colliders[0].surface.collide_bitmask = 1;
  World world(scene_of({floor, body}));
  world.run(1, 1e-3);
  EXPECT_NEAR(world[1].X_WB.p.z(), 0.01, 1e-6);
}

TEST(Contact, WithoutTheContactEffectBodiesPassThroughEachOther) {
  Scene scene = scene_of({ground(), cube(Vec3(0, 0, 0.02))});
  scene.effects.set(Effect::kContact, false);
  World world(scene);
  world.run(1, 1e-3);
  EXPECT_NEAR(world[1].X_WB.p.z(), 0.02 - kG / 2, 1e-12);
  EXPECT_EQ(world.free->contacts().count, 0);
}

TEST(Contact, AMovingObstaclePushes) {
  BodySpec pusher;
  pusher.name = "pusher";
  pusher.X_WB.p = Vec3(-0.05, 0, 0.01);
  pusher.colliders = {collider(shape(ShapeKind::kBox, Vec3::Constant(0.02)))};
  Scene scene = scene_of({ground(), cube(Vec3(0, 0, 0.01)), pusher});
  JointSpec joint;  // somebody else moves the pusher
  joint.child = 2;
  scene.joints = {joint};
  World world(scene);
  const double speed = 0.2, dt = 1e-3;
  for (int i = 1; i <= 500; ++i) {
    world.motions[2].X_WB.p.x() = -0.05 + speed * i * dt;
    world.motions[2].linear_velocity = Vec3(speed, 0, 0);
    world.step(dt);
  }
  // it reached the cube, which then kept its distance of one edge
  EXPECT_NEAR(world[1].X_WB.p.x(), -0.05 + speed * 0.5 + 0.02, 1e-6);
  EXPECT_NEAR(world[1].linear_velocity.x(), speed, 1e-6);
  EXPECT_LT(std::abs(world[1].X_WB.p.y()), 1e-8);
}

TEST(Contact, AnObstacleThatStartsElsewhereThanInTheSceneHitsNobody) {
  // as after an initial static equilibrium: the plate is 3 cm lower than the scene says
  BodySpec plate;
  plate.name = "plate";
  plate.colliders = {collider(shape(ShapeKind::kBox, Vec3(0.1, 0.1, 0.01)))};
  Scene scene = scene_of({plate, cube(Vec3(0, 0, -0.015))});
  JointSpec joint;
  joint.child = 0;
  scene.joints = {joint};
  World world(scene);
  world.motions[0].X_WB.p.z() = -0.03;
  world.run(0.1, 1e-3);
  EXPECT_NEAR(world[1].X_WB.p.z(), -0.015, 1e-8);
  EXPECT_LT(world[1].linear_velocity.norm(), 1e-8);
}

TEST(Contact, ATurningDiscTakesACubeAlong) {
  BodySpec disc;
  disc.name = "disc";
  disc.X_WB.p = Vec3(0, 0, -0.005);
  disc.colliders = {collider(shape(ShapeKind::kCylinder, Vec3(0.1, 0.01, 0)))};
  Scene scene = scene_of({disc, cube(Vec3(0, 0, 0.01))});
  JointSpec joint;
  joint.child = 0;
  scene.joints = {joint};
  World world(scene);
  const double rate = 1, dt = 1e-3;
  for (int i = 1; i <= 1000; ++i) {
    world.motions[0].X_WB.R = Eigen::AngleAxisd(rate * i * dt, Vec3::UnitZ()).toRotationMatrix();
    world.motions[0].angular_velocity = Vec3(0, 0, rate);
    world.step(dt);
  }
  EXPECT_NEAR(world[1].angular_velocity.z(), rate, 1e-3);
  EXPECT_NEAR(std::atan2(world[1].X_WB.R(1, 0), world[1].X_WB.R(0, 0)), rate, 1e-2);
}

TEST(Contact, ElasticBallsExchangeTheirVelocities) {
  BodySpec left = ball(0.01, Vec3(-0.05, 0, 0)), right = ball(0.01, Vec3(0.05, 0, 0));
  left.colliders[0].surface.restitution = right.colliders[0].surface.restitution = 1;
  left.linear_velocity = Vec3(1, 0, 0);
  right.linear_velocity = Vec3(-0.4, 0, 0);
  Scene scene = scene_of({left, right});
  scene.effects.set(Effect::kGravity, false);
  World world(scene);
  world.run(0.15, 1e-3);
  EXPECT_NEAR(world[0].linear_velocity.x(), -0.4, 1e-9);
  EXPECT_NEAR(world[1].linear_velocity.x(), 1, 1e-9);
}

TEST(Contact, MomentumSurvivesAnObliqueCollision) {
  BodySpec left = ball(0.01, Vec3(-0.05, 0.004, 0)), right = ball(0.02, Vec3(0.05, 0, 0.003));
  left.linear_velocity = Vec3(1, 0, 0);
  right.mass = 0.3;
  left.colliders[0].surface.restitution = right.colliders[0].surface.restitution = 0.8;
  Scene scene = scene_of({left, right});
  scene.effects.set(Effect::kGravity, false);
  World world(scene);
  world.run(0.3, 1e-3);
  const Vec3 P = 0.1 * world[0].linear_velocity + 0.3 * world[1].linear_velocity;
  EXPECT_LT((P - Vec3(0.1, 0, 0)).norm(), 1e-12);
  EXPECT_GT(world[1].linear_velocity.x(), 0.1);
}

TEST(Contact, ABallOfRestitutionOneKeepsBouncing) {
  BodySpec floor = ground(), body = ball(0.01, Vec3(0, 0, 0.11));
  floor.colliders[0].surface.restitution = body.colliders[0].surface.restitution = 1;
  World world(scene_of({floor, body}));
  const double before = world.energy();
  world.run(3, 1e-3);  // ten bounces
  // each bounce changes the energy by about (g dt)²/2 with dt the substep, here 0.07 ms
  EXPECT_NEAR(world.energy(), before, 1e-4 * 0.1 * kG * 0.1);
}

TEST(Contact, RestitutionHalfBouncesToAQuarter) {
  BodySpec floor = ground(), body = ball(0.01, Vec3(0, 0, 0.11));
  floor.colliders[0].surface.restitution = 0.5;
  body.colliders[0].surface.restitution = 1;
  World world(scene_of({floor, body}));
  const double fall = std::sqrt(2 * 0.1 / kG);
  double highest = 0;
  while (world[1].X_WB.p.z() > 0.0105)
    world.step(1e-3);
  for (int i = 0; i < std::lround(fall / 1e-3); ++i) {
    world.step(1e-3);
    highest = std::max(highest, world[1].X_WB.p.z() - 0.01);
  }
  EXPECT_NEAR(highest, 0.025, 1e-3 * 0.1);
  world.run(3, 1e-3);
  EXPECT_NEAR(world[1].X_WB.p.z(), 0.01, 1e-6) << "it should have come to rest";
  EXPECT_LT(world[1].linear_velocity.norm(), 1e-6);
}

TEST(Contact, ABallLandsOnAMesh) {
  MeshSpec roof;  // two triangles, a square of edge 0.2 at z = 0.05
  roof.positions = {
      {-0.1f, -0.1f, 0.05f}, {0.1f, -0.1f, 0.05f}, {0.1f, 0.1f, 0.05f}, {-0.1f, 0.1f, 0.05f}};
  roof.triangles = {{0, 1, 2}, {0, 2, 3}};
  BodySpec table;
  table.name = "table";
  table.is_static = true;
  ShapeSpec mesh = shape(ShapeKind::kMesh, Vec3::Zero());
  mesh.mesh = 0;
  table.colliders = {collider(mesh)};
  for (const BodySpec& body : {ball(0.01, Vec3(0.02, -0.03, 0.1)), cube(Vec3(0.02, -0.03, 0.1))}) {
    Scene scene = scene_of({table, body});
    scene.meshes = {roof};
    World world(scene);
    world.run(1, 1e-3);
    EXPECT_NEAR(world[1].X_WB.p.z(), double(0.05f) + 0.01, 1e-6);
    EXPECT_LT(world[1].linear_velocity.norm(), 1e-6);
  }
}

TEST(Contact, AStackOfFiveCubesStands) {
  std::vector<BodySpec> bodies{ground()};
  for (int i = 0; i < 5; ++i)
    bodies.push_back(cube(Vec3(0, 0, 0.01 + 0.0205 * i)));
  World world(scene_of(bodies));
  world.run(2, 1e-3);
  for (std::size_t i = 1; i <= 5; ++i) {
    EXPECT_NEAR(world[i].X_WB.p.z(), 0.01 + 0.02 * static_cast<double>(i - 1), 1e-5);
    EXPECT_LT(world[i].X_WB.p.head<2>().norm(), 1e-5);
  }
}

TEST(Contact, AFastSmallBallDoesNotPassThroughAThinWall) {
  BodySpec wall;
  wall.name = "wall";
  wall.is_static = true;
  wall.colliders = {collider(shape(ShapeKind::kBox, Vec3(0.001, 0.2, 0.2)))};
  for (double speed : {0.5, 5.0, 20.0}) {
    BodySpec bullet = ball(0.001, Vec3(-0.0507, 0, 0));
    bullet.linear_velocity = Vec3(speed, 0, 0);
    World world(scene_of({wall, bullet}));
    world.run(0.15, 1e-3);
    EXPECT_LT(world[1].X_WB.p.x(), -0.0005) << speed;
  }
}

TEST(Contact, TwoWorldsAgreeToTheLastBit) {
  std::vector<BodySpec> bodies{ground()};
  for (int i = 0; i < 8; ++i) {
    BodySpec body = i % 2 == 0 ? cube(Vec3(0.003 * i, 0.001 * i, 0.02 + 0.03 * i))
                               : ball(0.01, Vec3(0.002 * i, 0, 0.02 + 0.03 * i));
    body.X_WB.R = Eigen::AngleAxisd(0.3 * i, Vec3(1, i, 2).normalized()).toRotationMatrix();
    bodies.push_back(body);
  }
  const Scene scene = scene_of(bodies);
  World a(scene), b(scene);
  for (int i = 0; i < 700; ++i) {
    a.step(1e-3);
    b.step(1e-3);
  }
  for (std::size_t k = 0; k < bodies.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(a[k].X_WB.p[i]),
                std::bit_cast<std::uint64_t>(b[k].X_WB.p[i]));
      EXPECT_EQ(std::bit_cast<std::uint64_t>(a[k].angular_velocity[i]),
                std::bit_cast<std::uint64_t>(b[k].angular_velocity[i]));
    }
}

TEST(Contact, AFreePlaneIsRefused) {
  BodySpec body = cube(Vec3::Zero());
  body.colliders = ground().colliders;
  EXPECT_THROW(World(scene_of({body})), std::invalid_argument);
  body = cube(Vec3::Zero());
  body.mass = 0;
  EXPECT_THROW(World(scene_of({body})), std::invalid_argument);
}

}  // namespace
}  // namespace cprsim
