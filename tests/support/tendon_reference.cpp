// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/tendon_reference.h"

#include <cmath>
#include <numbers>

namespace cprsim {
namespace {

Mat3 skew(const Vec3& a) {
  Mat3 A;
  A << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return A;
}

struct State {
  Vec3 p = Vec3::Zero();
  Mat3 R = Mat3::Identity();  // its nine entries: the steps are small enough
  Vec3 u, v;
  VecX tensions;
};

State plus(const State& a, double h, const State& rate) {
  return {a.p + h * rate.p, a.R + h * rate.R, a.u + h * rate.u, a.v + h * rate.v,
          a.tensions + h * rate.tensions};
}

struct Way {
  Vec3 r, r_s, r_ss;
};

Way way(const ReferenceTendon& tendon, double s, double length) {
  const double w = 2 * std::numbers::pi * tendon.turns / length, a = tendon.angle + w * s;
  const Vec3 out(tendon.radius * std::cos(a), tendon.radius * std::sin(a), 0),
      around(-out.y(), out.x(), 0);
  return {out, w * around, -w * w * out};
}

const Vec3 kStraight(0, 0, 1);

State rate(const PulledReferenceRod& rod, double s, const State& y) {
  const Vec3 n = rod.K_se.cwiseProduct(y.v - kStraight), m = rod.K_bt.cwiseProduct(y.u);
  // rows n', m'; columns v', u'
  Mat6 A = Mat6::Zero();
  A.topLeftCorner<3, 3>() = rod.K_se.asDiagonal();
  A.bottomRightCorner<3, 3>() = rod.K_bt.asDiagonal();
  Vec6 b;
  b << y.u.cross(n) + y.R.transpose() * rod.load, y.u.cross(m) + y.v.cross(n);

  struct Pull {
    Way at;
    Vec3 t, known;  ///< tau t' without what u', v' make of it
    Mat3 P;
  };

  std::vector<Pull> pulls;
  for (std::size_t k = 0; k < rod.tendons.size(); ++k) {
    const double tension = y.tensions[static_cast<Eigen::Index>(k)];
    const Way at = way(rod.tendons[k], s, rod.length);
    const Vec3 g = y.u.cross(at.r) + at.r_s + y.v, t = g.normalized();
    const Mat3 P = tension / g.norm() * (Mat3::Identity() - t * t.transpose());
    // (tau t)' in section axes: P (v' + u' × r + known) + u × tau t + tau' t
    const Vec3 known = P * (y.u.cross(at.r_s) + at.r_ss) + tension * y.u.cross(t);
    pulls.push_back({at, t, known, P});
    A.topLeftCorner<3, 3>() += P;
    A.topRightCorner<3, 3>() -= P * skew(at.r);
    A.bottomLeftCorner<3, 3>() += skew(at.r) * P;
    A.bottomRightCorner<3, 3>() -= skew(at.r) * P * skew(at.r);
    b.head<3>() += known;
    b.tail<3>() += at.r.cross(known);
  }
  const Eigen::FullPivLU<Mat6> lu(A);
  Vec6 x = lu.solve(-b);
  VecX losses = VecX::Zero(y.tensions.size());
  for (int pass = 0; pass < 60 && rod.rubs(); ++pass) {
    Vec6 all = b;
    for (std::size_t k = 0; k < pulls.size(); ++k) {
      const Pull& pull = pulls[k];
      const Vec3 turned = pull.P * (x.head<3>() + x.tail<3>().cross(pull.at.r)) + pull.known;
      const double loss = -rod.tendons[k].mu * turned.norm();
      losses[static_cast<Eigen::Index>(k)] = loss;
      all.head<3>() += loss * pull.t;
      all.tail<3>() += loss * pull.at.r.cross(pull.t);
    }
    x = lu.solve(-all);
  }
  return {y.R * y.v, y.R * skew(y.u), x.tail<3>(), x.head<3>(), losses};
}

// The boundary condition at the tip is the law of an end section: solved by repeated substitution,
// which contracts as tension over stiffness.
State tip(const PulledReferenceRod& rod) {
  State y;
  y.u = Vec3::Zero();
  y.v = kStraight;
  y.tensions.resize(static_cast<Eigen::Index>(rod.tendons.size()));
  for (std::size_t k = 0; k < rod.tendons.size(); ++k)
    y.tensions[static_cast<Eigen::Index>(k)] = rod.tendons[k].tension;
  for (int k = 0; k < 500; ++k) {
    Vec3 n = rod.force, m = Vec3::Zero();
    for (const ReferenceTendon& tendon : rod.tendons) {
      const Way at = way(tendon, rod.length, rod.length);
      const Vec3 t = (y.u.cross(at.r) + at.r_s + y.v).normalized();
      n -= tendon.tension * t;
      m -= tendon.tension * at.r.cross(t);
    }
    y.v = kStraight + n.cwiseQuotient(rod.K_se);
    y.u = m.cwiseQuotient(rod.K_bt);
  }
  return y;
}

}  // namespace

ReferenceBase solve_tendon_rod(const PulledReferenceRod& rod, int steps) {
  State y = tip(rod);
  const double h = -rod.length / steps;
  for (int k = 0; k < steps; ++k) {
    const double s = rod.length + h * k;
    const State a = rate(rod, s, y), b = rate(rod, s + h / 2, plus(y, h / 2, a)),
                c = rate(rod, s + h / 2, plus(y, h / 2, b)), d = rate(rod, s + h, plus(y, h, c));
    y = plus(plus(plus(plus(y, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
  }
  return {{y.R, y.p}, y.u, y.v, y.tensions};
}

}  // namespace cprsim
