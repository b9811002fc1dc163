// SPDX-License-Identifier: BSD-3-Clause
#include "collision/flight.h"

#include <cmath>

#include "engine/math/so3.h"

namespace cprsim {

void fly_centre(RigidMotion& motion, const Vec3& a, double c, double t) {
  // E and (t - E)/c; the series up to c² where their difference would cancel
  const bool series = c * t < 1e-4;
  const double ct = c * t;
  const double E = series ? t * (1 - ct / 2 + ct * ct / 6) : -std::expm1(-ct) / c;
  const double F = series ? t * t * (0.5 - ct / 6 + ct * ct / 24) : (t - E) / c;
  motion.X.p += motion.v * E + a * F;
  motion.v = motion.v * std::exp(-ct) + a * E;
}

void fly_axes(RigidMotion& motion, const Vec3& inertia, double d, double t) {
  const double decay = std::exp(-d * t);
  const double h = d * t < 1e-12 ? t : -std::expm1(-d * t) / d;
  if (inertia.minCoeff() <= 0) {
    motion.X.R = exp_so3(motion.w * h) * motion.X.R;
    motion.w *= decay;
    return;
  }
  const Mat3 R = motion.X.R;
  const Vec3 w = R.transpose() * motion.w;
  const Vec3 L = R * inertia.cwiseProduct(w);
  const auto rate = [&](const Mat3& at) -> Vec3 {
    return (at.transpose() * L).cwiseQuotient(inertia);
  };
  const Vec3 k1 = rate(R);
  const Mat3 R2 = R * exp_so3(h / 2 * k1);
  const Vec3 k2 = rate(R2);
  const Vec3 k3 = rate(R * exp_so3(h / 2 * k2));
  const Vec3 k4 = rate(R2 * exp_so3(h * (k3 - k1 / 2)));
  // round-off in the product would otherwise turn into a drift of L
  motion.X.R = orthonormalized(R * exp_so3(h / 12 * (3 * k1 + 2 * k2 + 2 * k3 - k4)) *
                               exp_so3(h / 12 * (-k1 + 2 * k2 + 2 * k3 + 3 * k4)));
  motion.w = decay * (motion.X.R * rate(motion.X.R));
}

}  // namespace cprsim
