// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/rod_model.h"
#include "engine/rod/rod_tendons.h"

namespace cprsim {

void RodEnergy::set_feed_power(double carried, double length, const RodTendons* tendons) {
  feed_power = (kinetic + elastic + gravity + magnetic - carried) / length;
  if (tendons) feed_power -= tendons->feed_power();
}

double own_work(const Mat3& R, const Vec3& m, const Vec3& n, const Vec3& u, const Vec3& v,
                const TendonSection* tendons) {
  Vec3 own_m = R.transpose() * m, own_n = R.transpose() * n;
  if (tendons) {
    own_m -= Eigen::Map<const Vec3>(tendons->moment);
    own_n -= Eigen::Map<const Vec3>(tendons->force);
  }
  return own_m.dot(u) + own_n.dot(v);
}

}  // namespace cprsim
