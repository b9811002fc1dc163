// SPDX-License-Identifier: BSD-3-Clause
// Between two snapshots, with θ = (t - t_a)/(t_b - t_a) and h = t_b - t_a:
//   (1) positions   p(θ) = H00 p_a + H10 h v_a + H01 p_b + H11 h v_b   (cubic Hermite)
//   (2) rotations   R(θ) = R_a exp(θ log(R_aᵀ R_b))                    (geodesic)
//   (3) the rest    linear
// A position whose velocity is exactly zero at both ends, as in a quasi-static run, goes linearly.
// Between the points of a rod, h being their distance along it, u and v its strains:
//   (4) rotation    R = R_a exp(psi), psi the cubic Hermite through psi_s = J_r(psi)^-1 u; and u of
//                   that rotation
//   (5) position    the quintic Hermite through p_s = R v, p_ss = R (u × v + v_s)
//   (6) moment      the cubic Hermite through m_s = -p_s × n
//   (7) force, velocity, v   the cubic Hermite with the slopes of parabolas through neighbours
// as far as the ends' strains fit to the way between them; otherwise (2), (1) and (3) with s for t.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/math/so3.h"
#include "engine/run/snapshot.h"

namespace cprsim {

namespace {

/// Where between two instants (or two points of a rod) to look.
struct Between {
  double theta = 0;     ///< 0 at a, 1 at b
  double interval = 0;  ///< b - a

  double operator()(double a, double b) const { return a + theta * (b - a); }

  Vec3 operator()(const Vec3& a, const Vec3& b) const { return a + theta * (b - a); }

  // (1)
  template <typename T>
  T hermite(const T& a, const T& a_rate, const T& b, const T& b_rate) const {
    const double t = theta, t2 = t * t, t3 = t2 * t;
    return T((2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * interval * a_rate +
             (3 * t2 - 2 * t3) * b + (t3 - t2) * interval * b_rate);
  }

  // (2)
  Mat3 rotation(const Mat3& a, const Mat3& b) const {
    return Quat(a).slerp(theta, Quat(b)).toRotationMatrix();
  }

  Vec3 moved(const Vec3& a, const Vec3& a_rate, const Vec3& b, const Vec3& b_rate) const {
    if (a_rate.isZero(0) && b_rate.isZero(0)) return (*this)(a, b);
    return hermite<Vec3>(a, a_rate, b, b_rate);
  }
};

BodySample body_between(const BodySample& a, const BodySample& b, const Between& at) {
  BodySample body;
  body.X_WB.p = at.moved(a.X_WB.p, a.linear_velocity, b.X_WB.p, b.linear_velocity);
  body.X_WB.R = at.rotation(a.X_WB.R, b.X_WB.R);
  body.linear_velocity = at(a.linear_velocity, b.linear_velocity);
  body.angular_velocity = at(a.angular_velocity, b.angular_velocity);
  return body;
}

JointSample joint_between(const JointSample& a, const JointSample& b, const Between& at) {
  JointSample joint;
  joint.position = at.moved(a.position, a.velocity, b.position, b.velocity);
  joint.velocity = at(a.velocity, b.velocity);
  joint.effort = at(a.effort, b.effort);
  joint.limit = at(a.limit, b.limit);
  return joint;
}

/// All of a rod point but its position and s.
RodPoint section_between(const RodPoint& a, const RodPoint& b, const Between& at) {
  RodPoint point;
  point.rotation = at.rotation(a.rotation, b.rotation);
  point.velocity = at(a.velocity, b.velocity);
  point.force = at(a.force, b.force);
  point.moment = at(a.moment, b.moment);
  point.curvature = at(a.curvature, b.curvature);
  point.shear_stretch = at(a.shear_stretch, b.shear_stretch);
  point.rest_curvature = b.rest_curvature;
  return point;
}

RodSample rod_between(const RodSample& a, const RodSample& b, const Between& at) {
  RodSample rod;
  rod.length = at(a.length, b.length);
  rod.radius = at(a.radius, b.radius);
  rod.points.reserve(b.points.size());
  const bool same_grid = a.points.size() == b.points.size();
  for (std::size_t i = 0; i < b.points.size(); ++i) {
    const RodPoint& end = b.points[i];
    const RodPoint begin = same_grid && a.points[i].s == end.s ? a.points[i] : point_at(a, end.s);
    RodPoint point = section_between(begin, end, at);
    point.s = end.s;
    point.position = at.moved(begin.position, begin.velocity, end.position, end.velocity);
    rod.points.push_back(point);
  }
  return rod;
}

EnergySample energy_between(const EnergySample& a, const EnergySample& b, const Between& at) {
  EnergySample energy;
  energy.kinetic = at(a.kinetic, b.kinetic);
  energy.elastic = at(a.elastic, b.elastic);
  energy.gravity = at(a.gravity, b.gravity);
  energy.magnetic = at(a.magnetic, b.magnetic);
  energy.dissipated = at(a.dissipated, b.dissipated);
  energy.work = at(a.work, b.work);
  energy.total = at(a.total, b.total);
  energy.balance = at(a.balance, b.balance);
  return energy;
}

/// How far the ends of a piece can be trusted to tell its course: 1 where what they say of the way
/// between them is off by little of `way`, 0 where it is not. Strains jump at loads and steps, and
/// a node knows one side of them, or the mean.
double trust(double off, double way) {
  constexpr double kLittle = 0.1;
  if (!(way > 0)) return 0;
  const double share = off / (kLittle * way);
  return 1 / (1 + std::pow(share, 4));
}

// (5)
Vec3 quintic(double t, double h, const Vec3 a[3], const Vec3 b[3]) {
  const double t2 = t * t, t3 = t2 * t, t4 = t3 * t, t5 = t4 * t;
  return (1 - 10 * t3 + 15 * t4 - 6 * t5) * a[0] + (t - 6 * t3 + 8 * t4 - 3 * t5) * h * a[1] +
         0.5 * (t2 - 3 * t3 + 3 * t4 - t5) * h * h * a[2] +
         0.5 * (t3 - 2 * t4 + t5) * h * h * b[2] + (7 * t4 - 4 * t3 - 3 * t5) * h * b[1] +
         (10 * t3 - 15 * t4 + 6 * t5) * b[0];
}

/// Of the parabola through a point and its neighbours; null beyond an end.
Vec3 rate_at(const RodPoint* before, const RodPoint& at, const RodPoint* after,
             Vec3 RodPoint::*value) {
  const auto rate = [&](const RodPoint& a, const RodPoint& b) {
    return Vec3((b.*value - a.*value) / (b.s - a.s));
  };
  if (!before || !after) return before ? rate(*before, at) : rate(at, *after);
  const double left = at.s - before->s, right = after->s - at.s;
  return (right * rate(*before, at) + left * rate(at, *after)) / (left + right);
}

// (7)
Vec3 by_neighbours(const RodSample& rod, std::size_t a, const Between& at, Vec3 RodPoint::*value) {
  const std::vector<RodPoint>& points = rod.points;
  const RodPoint &from = points[a], &to = points[a + 1];
  const double h = at.interval;
  const Vec3 chord = to.*value - from.*value;
  Vec3 rate_a = rate_at(a > 0 ? &points[a - 1] : nullptr, from, &to, value),
       rate_b = rate_at(&from, to, a + 2 < points.size() ? &points[a + 2] : nullptr, value);
  // beyond an end, as if that parabola went on
  if (a == 0) rate_a = 2 / h * chord - rate_b;
  if (a + 2 == points.size()) rate_b = 2 / h * chord - rate_a;
  const double trusted = trust((chord - 0.5 * h * (rate_a + rate_b)).norm(),
                               h * std::max(rate_a.norm(), rate_b.norm()));
  return trusted * at.hermite<Vec3>(from.*value, rate_a, to.*value, rate_b) +
         (1 - trusted) * at(from.*value, to.*value);
}

// (4) to (6)
void place_between(const RodPoint& a, const RodPoint& b, double length, const Between& along,
                   RodPoint& point) {
  const Between at{along.theta, along.interval * length};
  const double t = at.theta, h = at.interval;
  const Vec3 turn = log_so3(a.rotation.transpose() * b.rotation);
  const Vec3 rate_a = a.curvature, rate_b = right_jacobian_inverse(turn) * b.curvature;
  const double trusted = trust((turn - 0.5 * h * (rate_a + rate_b)).norm(),
                               h * std::max(rate_a.norm(), rate_b.norm()));
  const Vec3 bent = at.hermite<Vec3>(Vec3::Zero(), rate_a, turn, rate_b);
  const Vec3 rate =
      6 * t * (1 - t) / h * turn + (1 - t) * (1 - 3 * t) * rate_a + t * (3 * t - 2) * rate_b;
  point.rotation = a.rotation * exp_so3(trusted * bent + (1 - trusted) * t * turn);
  point.curvature = trusted * (right_jacobian(bent) * rate) + (1 - trusted) * point.curvature;
  const Vec3 p_a = a.rotation * a.shear_stretch, p_b = b.rotation * b.shear_stretch,
             stretching = (b.shear_stretch - a.shear_stretch) / h;
  const Vec3 from[3] = {a.position, p_a,
                        a.rotation * (a.curvature.cross(a.shear_stretch) + stretching)};
  const Vec3 to[3] = {b.position, p_b,
                      b.rotation * (b.curvature.cross(b.shear_stretch) + stretching)};
  point.position = trusted * quintic(t, h, from, to) +
                   (1 - trusted) * at.hermite<Vec3>(a.position, p_a, b.position, p_b);
  const Vec3 m_a = -p_a.cross(a.force), m_b = -p_b.cross(b.force);
  const double pulled = trust((b.moment - a.moment - 0.5 * h * (m_a + m_b)).norm(),
                              h * std::max(m_a.norm(), m_b.norm()));
  point.moment =
      pulled * at.hermite<Vec3>(a.moment, m_a, b.moment, m_b) + (1 - pulled) * point.moment;
}

}  // namespace

Snapshot interpolate(const Snapshot& a, const Snapshot& b, double t) {
  if (t <= a.time) return a;
  if (t >= b.time) return b;
  const Between at{(t - a.time) / (b.time - a.time), b.time - a.time};
  Snapshot result;
  result.time = t;
  for (std::size_t i = 0; i < b.bodies.size(); ++i) {
    result.bodies.push_back(body_between(a.bodies.at(i), b.bodies[i], at));
  }
  for (std::size_t i = 0; i < b.joints.size(); ++i) {
    result.joints.push_back(joint_between(a.joints.at(i), b.joints[i], at));
  }
  for (std::size_t i = 0; i < b.rods.size(); ++i) {
    result.rods.push_back(rod_between(a.rods.at(i), b.rods[i], at));
  }
  for (std::size_t i = 0; i < b.tendons.size(); ++i) {
    const TendonSample &from = a.tendons.at(i), &to = b.tendons[i];
    result.tendons.push_back({at(from.tension, to.tension), at(from.displacement, to.displacement),
                              at(from.end_tension, to.end_tension)});
  }
  result.energy = energy_between(a.energy, b.energy, at);
  // counts belong to the step that ends at b
  result.solver = b.solver;
  result.contact = b.contact;
  return result;
}

RodPoint point_at(const RodSample& rod, double s) {
  if (rod.points.empty()) throw std::invalid_argument("a rod sample without points");
  if (s <= rod.points.front().s) return rod.points.front();
  if (s >= rod.points.back().s) return rod.points.back();
  const auto above = std::upper_bound(rod.points.begin(), rod.points.end(), s,
                                      [](double v, const RodPoint& point) { return v < point.s; });
  const RodPoint& a = *(above - 1);
  const RodPoint& b = *above;
  if (s == a.s) return a;
  const Between at{(s - a.s) / (b.s - a.s), b.s - a.s};
  RodPoint point = section_between(a, b, at);
  point.s = s;
  place_between(a, b, rod.length, at, point);
  const auto index = static_cast<std::size_t>(above - rod.points.begin()) - 1;
  for (Vec3 RodPoint::*value : {&RodPoint::force, &RodPoint::velocity, &RodPoint::shear_stretch})
    point.*value = by_neighbours(rod, index, at, value);
  return point;
}

}  // namespace cprsim
