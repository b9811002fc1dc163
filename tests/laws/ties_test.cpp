// SPDX-License-Identifier: BSD-3-Clause
// Rods that are tied side by side: against small deflections by hand, against one rod of the same
// stiffness, against the composite section that many ties make of two rods, and method against
// method.
#include <gtest/gtest.h>

#include "engine/study/modes.h"
#include "tests/support/end_of.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"
#include "tests/support/tendons.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 1e-3, kApart = 0.01;

/// Two equal rods, the second beside the first along y, tied at the given places.
Scene pair(const std::vector<double>& places, double apart = kApart) {
  Scene scene;
  switch_on(scene, {Effect::kExtension});
  scene.rods.assign(2, steel_rod(kLength, kRadius));
  scene.rods[1].name = "other";
  scene.rods[1].base.at.X_BF.p = {0, apart, 0};
  TieSpec tie;
  tie.name = "tie";
  tie.rod = 0;
  tie.other = 1;
  tie.s = tie.other_s = places;
  scene.ties = {tie};
  return scene;
}

Scene released(Scene scene) {
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.02;
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = 1e-3;
  return scene;
}

class Ties : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, Ties, ::testing::ValuesIn(kEveryMethod), test_name);

// Tied at the tip, to an arm of length d: with the tie's forces V across and N along on the second
// rod, beams bend and stretch by
//   w_1 = (F - V) L^3 / 3EI + d N L^2 / 2EI,   w_1' = (F - V) L^2 / 2EI + d N L / EI
//   w_2 = V L^3 / 3EI,   u_1 = -N L / EA,   u_2 = N L / EA
// and w_1 = w_2, u_1 - d w_1' = u_2.
TEST_P(Ties, ShareASmallLoadAsBeamsDo) {
  constexpr double F = 1e-6;
  Scene scene = finely(pair({1}), GetParam());
  add_load(scene, 1, {0, F, 0});
  const Equilibrium found(scene, 1e-14);
  ASSERT_TRUE(found.report.converged()) << found.report.worst_row;
  const SectionProperties section = section_properties(scene.rods[0]);
  const double EI = section.K_bt.x(), EA = section.K_se.z(), L = kLength, d = kApart;
  Eigen::Matrix2d A;
  Vec2 b;
  A << 2 * L * L * L / (3 * EI), -d * L * L / (2 * EI),  // V, N
      -d * L * L / (2 * EI), 2 * L / EA + d * d * L / EI;
  b << F * L * L * L / (3 * EI), -d * F * L * L / (2 * EI);
  const Vec2 VN = A.inverse() * b;
  const double w = VN[0] * L * L * L / (3 * EI);
  const RodPoint tip = found.rod(1).points.back();
  EXPECT_NEAR(tip.position.y() - d, w, 1e-6 * w);
  // the force in a section is that of the part beyond it on the part before
  const RodPoint base = found.rod(1).points.front();
  EXPECT_NEAR(base.force.y(), VN[0], 1e-4 * F);
  EXPECT_NEAR(base.force.z(), VN[1], 1e-4 * std::abs(VN[1]));
}

// A rod that is fed in to another length and tied at its tip is a rod of that length.
TEST_P(Ties, HoldTheTipOfARodThatIsFedIn) {
  constexpr double kFed = 0.37;
  Scene fed = finely(pair({1}), GetParam());
  fed.ties[0].offset = Vec3(0, kApart, 0);
  add_load(fed, 1, {0.2, 0.1, 0});
  Scene cut = fed;
  cut.rods[0].length = kFed;
  DriveSpec drive;
  drive.rod = 0;
  drive.quantity = DriveQuantity::kLength;
  ProfileTerm term;
  term.value = kFed;
  drive.profile.terms.push_back(term);
  fed.drives.push_back(drive);
  const Equilibrium a(fed, 1e-13), b(cut, 1e-13);
  ASSERT_TRUE(a.report.converged() && b.report.converged());
  EXPECT_GT((b.rod().points.back().position - Vec3(0, 0, kFed)).norm(), 0.01);
  for (const std::size_t rod : {0U, 1U})
    for (std::size_t k = 0; k < b.rod(rod).points.size(); ++k)
      EXPECT_LT((a.rod(rod).points[k].position - b.rod(rod).points[k].position).norm(),
                1e-9 * kLength)
          << rod << ", " << k;
}

/// Stiffnesses and mass of a steel rod, multiplied.
RodSpec multiple(double by) {
  RodSpec rod = steel_rod(kLength, kRadius);
  rod.material->density *= by;
  rod.material->youngs_modulus *= by;
  rod.material->shear_modulus *= by;
  return rod;
}

// One in the other, of stiffnesses 0.3 and 0.7 all: they take their parts of every load that acts
// where they are tied and stay together all along.
TEST_P(Ties, OfConcentricRodsMakeOneOfTheSum) {
  Scene two = finely(pair({1}, 0), GetParam());
  two.rods[0] = multiple(0.3);
  two.rods[1] = multiple(0.7);
  two.rods[1].name = "other";
  Scene one = two;
  one.ties.clear();
  one.rods = {multiple(1)};
  for (Scene* scene : {&one, &two})
    add_load(*scene, 1, {1, 0.5, -0.3}, Vec3::Zero(), true);
  const Equilibrium a(one, 1e-13), b(two, 1e-13);
  ASSERT_TRUE(a.report.converged() && b.report.converged());
  EXPECT_GT(a.rod().points.back().position.x(), 0.1);
  for (std::size_t k = 0; k < a.rod().points.size(); ++k)
    for (std::size_t rod : {0U, 1U})
      EXPECT_LT((a.rod().points[k].position - b.rod(rod).points[k].position).norm(),
                1e-10 * kLength)
          << k;
  const RodPoint alone = end_of(released(one)).rods.at(0).points.back(),
                 tied = end_of(released(two)).rods.at(1).points.back();
  EXPECT_GT(alone.velocity.norm(), 0.5);
  EXPECT_LT((alone.position - tied.position).norm(), 1e-8 * kLength);
  EXPECT_LT((alone.velocity - tied.velocity).norm(), 1e-6 * alone.velocity.norm());
}

/// The tip's deflection over that of the composite section.
double composite(Method method, int ties) {
  constexpr double F = 1e-4;
  std::vector<double> places;
  for (int k = 1; k <= ties; ++k)
    places.push_back(static_cast<double>(k) / ties);
  Scene scene = pair(places);
  scene.solver.method = method;
  scene.solver.points = ties;
  scene.solver.order = 3;
  scene.solver.elements = ties;
  scene.solver.degree = 4;
  add_load(scene, 1, {0, F, 0});
  const Equilibrium found(scene, 1e-14);
  EXPECT_TRUE(found.report.converged()) << found.report.worst_row;
  const SectionProperties section = section_properties(scene.rods[0]);
  const double EI = 2 * section.K_bt.x() + section.K_se.z() * kApart * kApart / 2;
  return found.rod().points.back().position.y() / (F * std::pow(kLength, 3) / (3 * EI));
}

// Many ties let nothing slide along: EI of both and the parallel axes' EA d^2 / 2 besides. Between
// them the rods bend by themselves, like the posts of a frame: that goes with the square of the
// distance.
TEST_P(Ties, InNumbersMakeACompositeSection) {
  const double few = composite(GetParam(), 20) - 1, many = composite(GetParam(), 40) - 1;
  EXPECT_LT(many, 0.04);
  EXPECT_NEAR(few / many, 4, 0.2);
}

// Nothing is lost in ties: what the sum of energies lacks is what steps do to waves along
// the rods that they are too long for.
TEST(TiedRods, KeepTheirEnergy) {
  const auto lack = [](double step) {
    Scene scene = released(finely(pair({0.3, 0.6, 1}), Method::kShooting));
    switch_on(scene, {Effect::kGravity, Effect::kShear, Effect::kRotaryInertia});
    scene.ties[0].offset = Vec3(0, 0.6 * kApart, 0);  // bent from the beginning
    scene.simulation.duration = 0.02;
    scene.solver.step = step;
    add_load(scene, 0.8, {0.5, 0.3, 0}, Vec3::Zero(), true);
    const Snapshot end = end_of(scene);
    EXPECT_GT(end.rods[0].points.back().velocity.norm(), 0.05);
    const RodPoint &a = end.rods[0].points.back(), &b = end.rods[1].points.back();
    EXPECT_LT((a.position + a.rotation * Vec3(0, 0.6 * kApart, 0) - b.position).norm(), 1e-9);
    return std::abs(end.energy.balance) / end.energy.kinetic;
  };
  const double coarse = lack(4e-4), fine = lack(1e-4);
  EXPECT_LT(fine, 1e-4);
  EXPECT_LT(fine, 0.25 * coarse);
}

TEST(TiedRods, MoveAlikeByEveryMethod) {
  std::vector<Vec3> tips;
  for (const Method method : kEveryMethod) {
    Scene scene = released(finely(pair({0.3, 0.6, 1}), method));
    switch_on(scene, {Effect::kGravity, Effect::kShear, Effect::kDamping});
    for (RodSpec& rod : scene.rods)
      damp(rod, 1e-3);
    add_load(scene, 0.8, {0.5, 0.3, 0}, Vec3::Zero(), true);
    tips.push_back(end_of(scene).rods.at(1).points.back().position);
  }
  EXPECT_GT((tips[0] - Vec3(0, kApart, kLength)).norm(), 0.005);
  EXPECT_LT((tips[1] - tips[0]).norm(), 1e-7 * kLength);
  EXPECT_LT((tips[2] - tips[0]).norm(), 1e-7 * kLength);
}

}  // namespace
}  // namespace cprsim
