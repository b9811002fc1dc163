// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/rod_tendons.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/section/tendon_law.h"

namespace cprsim {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

V3 plain(const Vec3& x) {
  return {x.x(), x.y(), x.z()};
}

}  // namespace

RodTendons::RodTendons(std::vector<Tendon> tendons, double length,
                       const std::vector<AskedSection>& sections, double EI)
    : tendons_(std::move(tendons)), length_(length), tensions_(tendons_.size(), 0.0) {
  const std::size_t n = tendons_.size();
  stretch_.assign(n * sections.size(), 0);
  directions_.assign(3 * n * sections.size(), 0);
  for (const AskedSection& section : sections) {
    weights_.push_back(section.weight * length);
    for (const Tendon& tendon : tendons_)
      places_.push_back(tendon.at(section.s, section.inside, length));
  }
  for (std::size_t i = 0; i < sections.size(); ++i) {
    TendonSection section;
    section.count = static_cast<int>(n);
    section.places = places_.data() + n * i;
    section.tensions = tensions_.data();
    section.stretch = stretch_.data() + n * i;
    section.directions = directions_.data() + 3 * n * i;
    sections_.push_back(section);
  }
  for (std::size_t i = 0; i < sections.size(); ++i)
    evaluate(i, sections[i].rest, Vec3::UnitZ());
  unloaded_ = lengths();
  // of the size of what a newton displaces
  for (std::size_t k = 0; k < n; ++k) {
    double squared = 1e-6 * length * length;
    for (std::size_t i = 0; i < sections.size(); ++i)
      squared = std::max(squared, Eigen::Map<const Vec3>(places_[n * i + k].r).squaredNorm());
    slackness_.push_back(length * squared / EI);
    units_.push_back(EI / (length * std::sqrt(squared)));
  }
  x_.assign(n, 0);
  prescribed_ = unloaded_;
}

void RodTendons::set(const std::vector<TendonPull>& pulls) {
  assert(pulls.size() == tensions_.size());
  unknown_.clear();
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    if (pulls[i].displaces) {
      unknown_.push_back(i);
      prescribed_[i] = unloaded_[i] - pulls[i].value;
    } else {
      x_[i] = pulls[i].value;
    }
    tensions_[i] = std::max(x_[i], 0.0);
  }
}

VecX RodTendons::values() const {
  VecX x(unknowns());
  for (Eigen::Index k = 0; k < x.size(); ++k)
    x[k] = x_[unknown_[static_cast<std::size_t>(k)]];
  return x;
}

void RodTendons::set_values(const VecX& x) {
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const std::size_t i = unknown_[static_cast<std::size_t>(k)];
    x_[i] = x[k];
    tensions_[i] = std::max(x[k], 0.0);
  }
}

// (1)
VecX RodTendons::gaps() const {
  const std::vector<double> now = lengths();
  VecX gap(unknowns());
  for (Eigen::Index k = 0; k < gap.size(); ++k) {
    const std::size_t i = unknown_[static_cast<std::size_t>(k)];
    gap[k] = (now[i] - prescribed_[i] - slackness_[i] * std::min(x_[i], 0.0)) / length_;
  }
  return gap;
}

VecX RodTendons::gaps_by_tension() const {
  VecX by(unknowns());
  for (Eigen::Index k = 0; k < by.size(); ++k) {
    const std::size_t i = unknown_[static_cast<std::size_t>(k)];
    by[k] = x_[i] < 0 ? -slackness_[i] / length_ : 0;
  }
  return by;
}

// |g| by (u, v): (r × t, t)
Vec6 RodTendons::stretch_by_strain(const TendonSection& section, std::size_t tendon) const {
  const Vec3 t = Eigen::Map<const Vec3>(section.directions + 3 * tendon);
  Vec6 by;
  by << Eigen::Map<const Vec3>(section.places[tendon].r).cross(t), t;
  return by;
}

VecX RodTendons::gap_rates(const std::vector<Vec6>& strain_rates) const {
  VecX rates = VecX::Zero(unknowns());
  for (std::size_t i = 0; i < sections_.size(); ++i)
    for (Eigen::Index k = 0; k < rates.size(); ++k)
      rates[k] += weights_[i] / length_ *
                  stretch_by_strain(sections_[i], unknown_[static_cast<std::size_t>(k)])
                      .dot(strain_rates[i]);
  return rates;
}

Vec6 RodTendons::per_tension(Eigen::Index unknown, std::size_t section) const {
  const std::size_t i = unknown_[static_cast<std::size_t>(unknown)];
  if (x_[i] < 0) return Vec6::Zero();
  return stretch_by_strain(sections_[section], i);
}

MatX RodTendons::locked(const TendonSection& section) const {
  MatX by(6, 0);
  for (std::size_t i : unknown_) {
    if (x_[i] < 0) continue;
    by.conservativeResize(Eigen::NoChange, by.cols() + 1);
    by.rightCols<1>() = stretch_by_strain(section, i);
  }
  return by;
}

void RodTendons::evaluate(std::size_t section, const Vec3& u, const Vec3& v) {
  evaluate_tendons(sections_[section], plain(u), plain(v));
}

std::vector<double> RodTendons::lengths() const {
  std::vector<double> sum(tendons_.size(), 0.0);
  for (std::size_t i = 0; i < sections_.size(); ++i)
    for (std::size_t k = 0; k < sum.size(); ++k)
      sum[k] += weights_[i] * sections_[i].stretch[k];
  return sum;
}

std::vector<TendonSample> RodTendons::observe() const {
  const std::vector<double> now = lengths();
  std::vector<TendonSample> samples;
  for (std::size_t k = 0; k < now.size(); ++k)
    samples.push_back({tensions_[k], unloaded_[k] - now[k]});
  return samples;
}

void RodTendons::visit(Archive& archive) {
  archive.doubles(tensions_);
  archive.doubles(x_);
  archive.doubles(stretch_);
  archive.doubles(directions_);
}

Mat6 RodTendons::stiffness(double s, double inside, const Vec3& u, const Vec3& v,
                           MatX* locked_here) const {
  std::vector<TendonPlace> places;
  for (const Tendon& tendon : tendons_)
    places.push_back(tendon.at(s, inside, length_));
  std::vector<double> stretch(tendons_.size()), directions(3 * tendons_.size());
  TendonSection section;
  section.count = static_cast<int>(tendons_.size());
  section.places = places.data();
  section.tensions = tensions_.data();
  section.stretch = stretch.data();
  section.directions = directions.data();
  evaluate_tendons(section, plain(u), plain(v));
  if (locked_here) *locked_here = locked(section);
  return stiffness_of(section);
}

Mat6 stiffness_of(const TendonSection& section) {
  const RowMatrix moment_v = Eigen::Map<const RowMatrix>(section.moment_v);
  Mat6 K;
  K << Eigen::Map<const RowMatrix>(section.moment_u), moment_v, moment_v.transpose(),
      Eigen::Map<const RowMatrix>(section.force_v);
  return K;
}

}  // namespace cprsim
