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
                       const std::vector<AskedSection>& sections, double EI,
                       const std::vector<double>& stations)
    : tendons_(std::move(tendons)), EI_(EI), asked_(sections), tensions_(tendons_.size(), 0.0) {
  const std::size_t n = tendons_.size();
  stretch_.assign(n * sections.size(), 0);
  directions_.assign(3 * n * sections.size(), 0);
  weights_.resize(sections.size());
  places_.resize(n * sections.size());
  for (std::size_t i = 0; i < sections.size(); ++i) {
    TendonSection section;
    section.count = static_cast<int>(n);
    section.places = places_.data() + n * i;
    section.tensions = tensions_.data();
    section.stretch = stretch_.data() + n * i;
    section.directions = directions_.data() + 3 * n * i;
    sections_.push_back(section);
  }
  for (std::vector<double>* of : {&unloaded_, &reach_, &slackness_, &units_, &x_})
    of->assign(n, 0);
  unloaded_stretch_.resize(n * sections.size());
  paid_out_.resize(n * sections.size());
  for (std::size_t k = 0; k < n; ++k) {
    if (tendons_[k].friction() == 0) continue;
    frictions_.push_back(
        {k, TendonFriction(tendons_[k].friction(), tendons_[k].end(), k, sections, stations)});
    friction_unknowns_ += frictions_.back().law.unknowns();
  }
  lie_along(length);
  for (std::size_t i = 0; i < sections.size(); ++i)
    evaluate(i, sections[i].rest, Vec3::UnitZ());
  prescribed_ = unloaded_;
  track_.resize(static_cast<Eigen::Index>(n));
  if (frictions_.empty()) return;
  curvatures_.assign(sections.size(), Vec3::Zero());
  spread_.assign(n * sections.size(), 0);
  for (std::size_t i = 0; i < sections.size(); ++i)
    sections_[i].tensions = spread_.data() + n * i;
}

// Everything that depends on the rod's length and on nothing else. Of the unloaded rod g = a + b /
// L with a = v_rest + u_rest × r and b = dr / d(s / L): L |g| grows with L by t·a.
void RodTendons::lie_along(double length) {
  length_ = length;
  const std::size_t n = tendons_.size();
  std::fill(unloaded_.begin(), unloaded_.end(), 0.0);
  std::fill(reach_.begin(), reach_.end(), 1e-6 * length * length);
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    weights_[i] = asked_[i].weight * length;
    for (std::size_t k = 0; k < n; ++k) {
      TendonPlace& place = places_[n * i + k];
      place = tendons_[k].at(asked_[i].s, asked_[i].inside, length);
      const Vec3 r = Eigen::Map<const Vec3>(place.r), a = Vec3::UnitZ() + asked_[i].rest.cross(r),
                 g = a + Eigen::Map<const Vec3>(place.r_s);
      reach_[k] = std::max(reach_[k], r.squaredNorm());
      unloaded_stretch_[n * i + k] = place.there ? g.norm() : 0;
      paid_out_[n * i + k] = place.there ? asked_[i].weight * g.normalized().dot(a) : 0;
      unloaded_[k] += weights_[i] * unloaded_stretch_[n * i + k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    // of the size of what a newton displaces
    slackness_[k] = length * reach_[k] / EI_;
    units_[k] = EI_ / (length * std::sqrt(reach_[k]));
  }
  for (Friction& friction : frictions_)
    friction.law.lie_along(length, unloaded_stretch_.data() + friction.tendon, n);
}

const TendonFriction* RodTendons::friction_of(std::size_t tendon) const {
  for (const Friction& friction : frictions_)
    if (friction.tendon == tendon) return &friction.law;
  return nullptr;
}

// Tensions at the sections follow from those at the motors.
void RodTendons::spread_tensions() {
  if (frictions_.empty()) return;
  const std::size_t n = tendons_.size();
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    std::copy_n(tensions_.data(), n, &spread_[n * i]);
    for (const Friction& friction : frictions_)
      spread_[n * i + friction.tendon] *= friction.law.factor(i);
  }
}

void RodTendons::engage_friction() {
  for (Friction& friction : frictions_)
    friction.law.engage();
}

void RodTendons::accept() {
  for (Friction& friction : frictions_)
    friction.law.accept();
}

void RodTendons::set(const std::vector<TendonPull>& pulls, double length) {
  assert(pulls.size() == tensions_.size());
  if (length != length_) lie_along(length);
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
  spread_tensions();
}

VecX RodTendons::values() const {
  VecX x(unknowns());
  Eigen::Index k = 0;
  for (const std::size_t i : unknown_)
    x[k++] = x_[i];
  for (const Friction& friction : frictions_) {
    x.segment(k, friction.law.unknowns()) = friction.law.values();
    k += friction.law.unknowns();
  }
  return x;
}

void RodTendons::set_values(const VecX& x) {
  Eigen::Index k = 0;
  for (const std::size_t i : unknown_) {
    x_[i] = x[k++];
    tensions_[i] = std::max(x_[i], 0.0);
  }
  for (Friction& friction : frictions_) {
    friction.law.set_values(x.segment(k, friction.law.unknowns()));
    k += friction.law.unknowns();
  }
  spread_tensions();
}

// (1)
const VecX& RodTendons::gaps() {
  gaps_.resize(unknowns());
  Eigen::Index k = 0;
  for (const std::size_t i : unknown_)
    gaps_[k++] = (length_of(i) - prescribed_[i] - slackness_[i] * std::min(x_[i], 0.0)) / length_;
  for (Friction& friction : frictions_) {
    friction.law.gaps(sections_, curvatures_, gaps_.segment(k, friction.law.unknowns()));
    k += friction.law.unknowns();
  }
  return gaps_;
}

double RodTendons::gap_by_own(Eigen::Index unknown) const {
  const auto k = static_cast<std::size_t>(unknown);
  if (k >= unknown_.size()) return -1;
  const std::size_t i = unknown_[k];
  return x_[i] < 0 ? -slackness_[i] / length_ : 0;
}

// |g| by (u, v): (r × t, t)
Vec6 RodTendons::stretch_by_strain(const TendonSection& section, std::size_t tendon) const {
  const Vec3 t = Eigen::Map<const Vec3>(section.directions + 3 * tendon);
  Vec6 by;
  by << Eigen::Map<const Vec3>(section.places[tendon].r).cross(t), t;
  return by;
}

void RodTendons::gap_rates(const std::vector<Vec6>& strain_rates, Eigen::Ref<VecX> rates) const {
  rates.setZero();
  for (std::size_t i = 0; i < sections_.size(); ++i)
    for (std::size_t k = 0; k < unknown_.size(); ++k)
      rates[static_cast<Eigen::Index>(k)] +=
          weights_[i] / length_ * stretch_by_strain(sections_[i], unknown_[k]).dot(strain_rates[i]);
  auto k = static_cast<Eigen::Index>(unknown_.size());
  for (const Friction& friction : frictions_) {
    friction.law.rates(sections_, strain_rates, rates.segment(k, friction.law.unknowns()));
    k += friction.law.unknowns();
  }
}

double RodTendons::feed_power() const {
  double power = 0;
  const std::size_t n = tendons_.size();
  for (std::size_t i = 0; i < sections_.size(); ++i)
    for (std::size_t k = 0; k < n; ++k)
      power += sections_[i].tensions[k] * paid_out_[n * i + k];
  return power;
}

Vec6 RodTendons::per_unknown(Eigen::Index unknown, std::size_t section) const {
  auto k = unknown - static_cast<Eigen::Index>(unknown_.size());
  if (k < 0) {
    const std::size_t i = unknown_[static_cast<std::size_t>(unknown)];
    if (x_[i] < 0) return Vec6::Zero();
    const TendonFriction* friction = friction_of(i);
    return (friction ? friction->factor(section) : 1) * stretch_by_strain(sections_[section], i);
  }
  for (const Friction& friction : frictions_) {
    if (k < friction.law.unknowns())
      return tensions_[friction.tendon] * friction.law.factor_by(k, section) *
             stretch_by_strain(sections_[section], friction.tendon);
    k -= friction.law.unknowns();
  }
  return Vec6::Zero();
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

double RodTendons::length_of(std::size_t tendon) const {
  double sum = 0;
  for (std::size_t i = 0; i < sections_.size(); ++i)
    sum += weights_[i] * sections_[i].stretch[tendon];
  return sum;
}

std::vector<TendonSample> RodTendons::observe() const {
  std::vector<TendonSample> samples;
  for (std::size_t k = 0; k < tendons_.size(); ++k) {
    TendonSample& sample = samples.emplace_back();
    sample.tension = sample.end_tension = tensions_[k];
    sample.displacement = unloaded_[k] - length_of(k);
    sample.rate = track_.v[static_cast<Eigen::Index>(k)];
    const TendonFriction* friction = friction_of(k);
    if (!friction) continue;
    sample.end_tension *= friction->factor_at(tendons_[k].end(), tendons_[k].end());
    for (std::size_t i = 0; i < sections_.size(); ++i)
      if (sections_[i].places[k].there)
        sample.along.emplace_back(friction->factor(i), shortening(i, k));
  }
  return samples;
}

void RodTendons::fill_track() {
  for (std::size_t k = 0; k < tendons_.size(); ++k)
    track_.x[static_cast<Eigen::Index>(k)] = unloaded_[k] - length_of(k);
}

void RodTendons::start_track() {
  fill_track();
  track_.set_start(VecX(track_.x), VecX::Zero(track_.x.size()));
}

void RodTendons::start_track_moving(const std::vector<Vec6>& strain_rates) {
  fill_track();
  VecX v = VecX::Zero(track_.x.size());
  for (std::size_t i = 0; i < sections_.size(); ++i)
    for (std::size_t k = 0; k < tendons_.size(); ++k)
      v[static_cast<Eigen::Index>(k)] -=
          weights_[i] * stretch_by_strain(sections_[i], k).dot(strain_rates[i]);
  track_.set_start(VecX(track_.x), v);
}

void RodTendons::visit(Archive& archive) {
  archive.doubles(tensions_);
  archive.doubles(x_);
  archive.doubles(stretch_);
  archive.doubles(directions_);
  // what they pulled with: a power of a step's begin is made of it
  for (TendonSection& section : sections_)
    for (int i = 0; i < 3; ++i) {
      archive(section.moment[i]);
      archive(section.force[i]);
    }
  for (Friction& friction : frictions_)
    friction.law.visit(archive);
  spread_tensions();
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
  std::vector<double> tensions = tensions_;
  for (const Friction& friction : frictions_)
    tensions[friction.tendon] *= friction.law.factor_at(s, inside);
  section.tensions = tensions.data();
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
