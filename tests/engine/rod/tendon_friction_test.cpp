// SPDX-License-Identifier: BSD-3-Clause
// Friction of tendons on given strains: its sums against closed forms, its derivatives against
// differences where tendons slip and where they stick.
#include "engine/rod/tendon_friction.h"

#include <gtest/gtest.h>

#include "engine/rod/rod_tendons.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.8, kMu = 0.4;
constexpr int kCells = 8;

struct Strains {
  std::vector<Vec3> u, v;
};

std::vector<AskedSection> gauss_sections() {
  const double x[] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
  const double w[] = {5. / 18, 4. / 9, 5. / 18};
  std::vector<AskedSection> sections;
  for (int c = 0; c < kCells; ++c)
    for (int j = 0; j < 3; ++j)
      sections.push_back({(c + x[j]) / kCells, (c + 0.5) / kCells, w[j] / kCells, Vec3::Zero()});
  return sections;
}

RodTendons winding_tendons(bool straight_way = false) {
  TendonSpec spec;
  spec.route = TendonRoute::kHelical;
  spec.radius = 0.02;
  spec.angle = 0.4;
  spec.turns = straight_way ? 0 : 0.7;
  spec.friction = kMu;
  TendonSpec bent = spec;
  bent.route = TendonRoute::kPoints;
  bent.points = {{0, 0.03, 0}, {0.5, 0.01, 0.02}, {1, 0.02, -0.01}};
  bent.termination = 0.75;
  return RodTendons({Tendon(spec, true), Tendon(bent, true)}, kLength, gauss_sections(), 0.2,
                    {0.5, 0.75});
}

Strains wavy(double phase) {
  Strains at;
  for (const AskedSection& section : gauss_sections()) {
    const double a = 4 * section.s + phase;
    at.u.emplace_back(2 + std::sin(a), 1.5 * std::cos(2 * a), 0.8 * std::sin(a + 1));
    at.v.emplace_back(0.02 * std::sin(a), 0.01 * std::cos(a), 1 + 0.02 * std::sin(3 * a));
  }
  return at;
}

Strains beside(const Strains& at, double step, const std::vector<Vec6>& direction) {
  Strains moved = at;
  for (std::size_t i = 0; i < at.u.size(); ++i) {
    moved.u[i] += step * direction[i].head<3>();
    moved.v[i] += step * direction[i].tail<3>();
  }
  return moved;
}

VecX gaps(RodTendons& tendons, const Strains& at) {
  for (std::size_t i = 0; i < at.u.size(); ++i) {
    tendons.evaluate(i, at.u[i], at.v[i]);
    tendons.set_curvature(i, at.u[i]);
  }
  return tendons.gaps();
}

/// Largest difference between the rates and central differences, over the largest rate.
double rate_error(RodTendons& tendons, const Strains& at, const std::vector<Vec6>& direction,
                  double step) {
  const VecX difference =
      (gaps(tendons, beside(at, step, direction)) - gaps(tendons, beside(at, -step, direction))) /
      (2 * step);
  gaps(tendons, at);
  VecX rates(tendons.unknowns());
  tendons.gap_rates(direction, rates);
  return (rates - difference).cwiseAbs().maxCoeff() / rates.cwiseAbs().maxCoeff();
}

std::vector<Vec6> some_direction() {
  std::vector<Vec6> direction;
  for (const AskedSection& section : gauss_sections()) {
    Vec6 d;
    d << std::sin(3 * section.s), 1 - section.s, std::cos(5 * section.s), 0.2 * section.s,
        0.1 * std::sin(section.s), 0.3 * std::cos(2 * section.s);
    direction.push_back(d);
  }
  return direction;
}

TEST(TendonFriction, HasExactDerivativesWhereTendonsSlip) {
  RodTendons tendons = winding_tendons();
  tendons.set({{5, false}, {7, false}}, kLength);
  EXPECT_LT(rate_error(tendons, wavy(0.3), some_direction(), 1e-6), 1e-8);
}

TEST(TendonFriction, HasExactDerivativesWhereTendonsStick) {
  RodTendons tendons = winding_tendons();
  tendons.set({{5, false}, {7, false}}, kLength);
  const Strains at = wavy(0.3);
  gaps(tendons, at);
  tendons.accept();
  tendons.engage_friction();
  // paid out by less than the range in which they stick
  std::vector<Vec6> out(at.u.size(), Vec6::Unit(5));
  const Strains inside = beside(at, 4e-5, out);
  ASSERT_LT(gaps(tendons, inside).norm(), gaps(tendons, at).norm());
  EXPECT_LT(rate_error(tendons, inside, some_direction(), 1e-8), 1e-5);
}

// A rod of another length has the tendons of one that was made with it, whatever it was before.
TEST(TendonFriction, KnowsRodsThatGrow) {
  RodTendons grown = winding_tendons();
  const Strains at = wavy(0.3);
  VecX first;
  for (const double length : {kLength, 1.3 * kLength, 0.7 * kLength, kLength}) {
    grown.set({{5, false}, {7, true}}, length);
    const VecX now = gaps(grown, at);
    if (length == kLength && first.size() > 0) {
      EXPECT_EQ(now, first);
    }
    if (first.size() == 0) first = now;
    EXPECT_LT(rate_error(grown, at, some_direction(), 1e-6), 1e-8);
  }
}

// What the unloaded rod's tendons are longer by on a longer rod.
TEST(TendonFriction, TakesTautTendonInAsARodIsFed) {
  RodTendons tendons = winding_tendons();
  const auto unloaded = [&](double length) {
    tendons.set({{5, false}, {7, false}}, length);
    for (std::size_t i = 0; i < gauss_sections().size(); ++i)
      tendons.evaluate(i, Vec3::Zero(), Vec3::UnitZ());
    double energy = 0;
    const std::vector<TendonSample> now = tendons.observe();
    for (const TendonSample& tendon : now)
      EXPECT_NEAR(tendon.displacement, 0, 1e-15);
    // of the helix and of the polygon that ends at 0.75
    energy += 5 * std::hypot(length, 2 * std::numbers::pi * 0.7 * 0.02);
    const double a = std::hypot(0.5 * length, std::hypot(0.02, 0.02)),
                 b = 0.5 * std::hypot(0.5 * length, std::hypot(0.01, 0.03));
    return energy + 7 * (a + b);
  };
  const double h = 1e-5, slope = (unloaded(kLength + h) - unloaded(kLength - h)) / (2 * h);
  unloaded(kLength);
  EXPECT_NEAR(tendons.feed_power(), slope, 1e-8);
}

// Tensions by their unknowns, as Newton's method takes them.
TEST(TendonFriction, ChangesTensionsAsItsUnknownsSay) {
  RodTendons tendons = winding_tendons();
  tendons.set({{5, false}, {7, false}}, kLength);
  const Strains at = wavy(0.1);
  gaps(tendons, at);
  VecX x = VecX::LinSpaced(tendons.unknowns(), 0.1, -0.05);
  tendons.set_values(x);
  const auto wrench = [&](std::size_t i) {
    tendons.evaluate(i, at.u[i], at.v[i]);
    Vec6 w;
    w << Eigen::Map<const Vec3>(tendons.at(i).moment), Eigen::Map<const Vec3>(tendons.at(i).force);
    return w;
  };
  for (Eigen::Index k = 0; k < x.size(); ++k)
    for (const std::size_t i : {2, 13, 23}) {
      tendons.set_values(x);
      wrench(i);
      const Vec6 expected = tendons.per_unknown(k, i);
      const double h = 1e-5;
      tendons.set_values(x + h * VecX::Unit(x.size(), k));
      const Vec6 more = wrench(i);
      tendons.set_values(x - h * VecX::Unit(x.size(), k));
      EXPECT_LT((expected - (more - wrench(i)) / (2 * h)).norm(), 1e-8) << k << ", " << i;
    }
}

// Taken back within a step nothing has happened; only a step that is over is remembered.
TEST(TendonFriction, RemembersStepsAlone) {
  RodTendons tendons = winding_tendons();
  tendons.set({{5, false}, {7, false}}, kLength);
  const Strains at = wavy(0.3), away = wavy(0.5);
  gaps(tendons, at);
  tendons.accept();
  tendons.engage_friction();
  const VecX before = gaps(tendons, at);
  gaps(tendons, away);
  EXPECT_EQ((gaps(tendons, at) - before).norm(), 0);
  gaps(tendons, away);
  tendons.accept();
  EXPECT_GT((gaps(tendons, at) - before).norm(), 1e-3);
}

}  // namespace
}  // namespace cprsim
