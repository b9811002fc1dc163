// SPDX-License-Identifier: BSD-3-Clause
// What a strain-basis rod holds and exchanges.
#include <cmath>

#include "engine/rod/strain_basis.h"

namespace cprsim {

// The polynomials are orthonormal.
void StrainRod::add_strain_energy(RodEnergy& energy) const {
  const double* rate = track_.v.data() + position_coordinates();
  for (std::size_t e = 0; e < elements(); ++e)
    for (Eigen::Index k = 0; k < rule_.functions(); ++k)
      for (std::size_t a = 0; a < modes_.size(); ++a) {
        const double q = q_[e](static_cast<Eigen::Index>(a), k);
        if (modes_[a].listed) energy.elastic += 0.5 * length_of(e) * modes_[a].K * q * q;
        if (!options_.damping) continue;
        energy.damping_power += length_of(e) * modes_[a].damping * *rate * *rate;
        ++rate;
      }
}

void StrainRod::add_varying_strain_energy(RodEnergy& energy) const {
  const Eigen::Index G = rule_.points();
  const double* rate = track_.v.data() + position_coordinates();
  for (std::size_t e = 0; e < elements(); ++e) {
    const Eigen::Map<const MatX> q_t(rate, q_[e].rows(), options_.damping ? q_[e].cols() : 0);
    if (options_.damping) rate += q_[e].size();
    for (Eigen::Index i = 0; i < G; ++i) {
      const std::size_t at = e * static_cast<std::size_t>(G) + static_cast<std::size_t>(i);
      const double weight = length_of(e) * rule_.gauss.weights[i];
      for (std::size_t a = 0; a < modes_.size(); ++a) {
        const auto row = static_cast<Eigen::Index>(a);
        const double strained = q_[e].row(row).dot(rule_.phi.col(i));
        if (modes_[a].listed)
          energy.elastic += 0.5 * weight * stiffness(modes_[a], at) * strained * strained;
        if (!options_.damping) continue;
        const double strain_t = q_t.row(row).dot(rule_.phi.col(i));
        energy.damping_power += weight * damping(modes_[a], at) * strain_t * strain_t;
      }
    }
  }
}

double StrainRod::weight_of(std::size_t point) const {
  const auto G = static_cast<std::size_t>(rule_.points());
  return length_of(point / G) * rule_.gauss.weights[static_cast<Eigen::Index>(point % G)];
}

double StrainRod::magnetic_energy(const MagneticSources& sources) const {
  if (options_.magnets.empty()) return 0;
  const MagneticField field = view_of(sources);
  double energy = 0;
  for (std::size_t j = 0; j < points_.size(); ++j)
    energy += weight_of(j) * fluid_.magnetic_energy(j, points_[j].R, points_[j].p, field);
  return energy;
}

ThermalEffort StrainRod::thermal_effort() const {
  ThermalEffort effort;
  for (std::size_t j = 0; j < points_.size(); ++j) {
    const std::size_t e = j / static_cast<std::size_t>(rule_.points());
    const auto i = static_cast<Eigen::Index>(j % static_cast<std::size_t>(rule_.points()));
    const Vec3 bent = points_[j].u - rest_curvature(e, rule_.phi.col(i));
    effort.add(weight_of(j), section(j), bent, points_[j].v.z() - 1 - forcing_.heat.stretch,
               options_.extension);
  }
  return effort;
}

RodEnergy StrainRod::energy() const {
  RodEnergy energy;
  double carried = 0;
  for (std::size_t j = 0; j < points_.size(); ++j) {
    const double weight = weight_of(j);
    energy.kinetic += weight * 0.5 * section(j).rhoA *
                      track_.v.segment<3>(static_cast<Eigen::Index>(3 * j)).squaredNorm();
    energy.gravity -= weight * section(j).weighing_mass() * forcing_.gravity.dot(points_[j].p);
    const StrainPoint& at = points_[j];
    carried +=
        weight * own_work(at.R, at.m, at.n, at.u, at.v, tendons_ ? &tendons_->at(j) : nullptr);
    if (options_.drag || options_.line_loads)
      fluid_.add_power(j, points_[j].R.col(2), weight, track_, energy);
    if (rotary_.empty()) continue;
    const Vec3 omega = Eigen::Map<const Vec3>(rotary_[j].omega);
    energy.kinetic += weight * 0.5 * omega.dot(section(j).rhoJ.cwiseProduct(omega));
  }
  if (sections_.empty())
    add_strain_energy(energy);
  else
    add_varying_strain_energy(energy);
  energy.magnetic = magnetic_energy(forcing_.field);
  energy.set_feed_power(carried, forcing_.length, tendons_.get());
  if (disks_) disks_->add_energy(track_, energy);
  if (touch_) energy.damping_power += touch_->friction_power();
  return energy;
}

}  // namespace cprsim
