// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/tendon_friction.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/rod/rod_tendons.h"

namespace cprsim {
namespace {

constexpr std::size_t kSlopePoints = 7, kEdgePoints = 4;
constexpr Eigen::Index kSectionsPerUnknown = 3;
// y_stick of (2) over the rod's length: small against what motors pull in, and still soft enough
// for Newton's method, to which a tendon that sticks is a spring.
constexpr double kStickRange = 1e-4;
// Turning per length of the rod below which it has no direction.
constexpr double kStraight = 1e-10;

/// Legendre polynomials on [0, 1] and their integrals from 0, of degrees 0 .. n - 1.
void legendre(double x, Eigen::Index n, VecX& P, VecX& I) {
  const double xi = 2 * x - 1;
  VecX all(n + 1);
  all[0] = 1;
  all[1] = xi;
  for (Eigen::Index k = 1; k < n; ++k)
    all[k + 1] = (double(2 * k + 1) * xi * all[k] - double(k) * all[k - 1]) / double(k + 1);
  P = all.head(n);
  I.resize(n);
  I[0] = x;
  for (Eigen::Index k = 1; k < n; ++k)
    I[k] = (all[k + 1] - all[k - 1]) / double(2 * (2 * k + 1));
}

/// Weights of the values at `x` in the value or the slope at z of the polynomial through them.
std::vector<double> interpolation(const std::vector<double>& x, double z, bool slope) {
  std::vector<double> weights(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    double value = 1, rate = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (k == i) continue;
      rate = rate * (z - x[k]) / (x[i] - x[k]) + value / (x[i] - x[k]);
      value *= (z - x[k]) / (x[i] - x[k]);
    }
    weights[i] = slope ? rate : value;
  }
  return weights;
}

}  // namespace

TendonFriction::TendonFriction(double mu, double end, std::size_t index,
                               const std::vector<AskedSection>& sections,
                               std::vector<double> stations)
    : mu_(mu), index_(index) {
  stations.push_back(end);
  std::sort(stations.begin(), stations.end());
  double from = 0;
  for (const double s : stations) {
    if (s < from + 1e-9 || s > end) continue;
    add_span(from, s, sections);
    from = s;
  }
  for (std::size_t k = 1; k < spans_.size(); ++k) {
    const Span &a = spans_[k - 1], &b = spans_[k];
    const auto edge = [&](const Span& span, bool last) {
      const std::size_t n = std::min(kEdgePoints, span.count);
      Stencil stencil{last ? span.first + span.count - n : span.first, {}};
      std::vector<double> x;
      for (std::size_t i = 0; i < n; ++i)
        x.push_back(sections[stencil.first + i].s);
      stencil.weights = interpolation(x, last ? span.to : span.from, false);
      return stencil;
    };
    bends_.push_back(
        {spans_.back().unknown + spans_.back().degrees + static_cast<Eigen::Index>(bends_.size()),
         b.first - 1, edge(a, true), edge(b, false)});
  }
  c_ = VecX::Zero(spans_.back().unknown + spans_.back().degrees +
                  static_cast<Eigen::Index>(bends_.size()));
  const auto n = static_cast<Eigen::Index>(count_);
  basis_.resize(n, c_.size());
  for (std::size_t j = 0; j < count_; ++j) {
    weights_.push_back(sections[j].weight);
    basis_.row(static_cast<Eigen::Index>(j)) = basis(sections[j].s, sections[j].inside);
  }
  factors_ = VecX::Ones(static_cast<Eigen::Index>(sections.size()));
  t_.assign(count_, Vec3::Zero());
  u_ = heading_ = t_;
  kappa_ = passed_ = passed_before_ = unloaded_ = VecX::Zero(n);
  phi_ = phi_before_ = VecX::Ones(n);
  slips_.assign(count_, 1);
  scratch_.dt = t_;
  scratch_.stretched = scratch_.turned = scratch_.dphi = phi_;
}

void TendonFriction::lie_along(double length, const double* unloaded, std::size_t apart) {
  length_ = length;
  for (Eigen::Index i = 0; i < unloaded_.size(); ++i)
    unloaded_[i] = unloaded[apart * static_cast<std::size_t>(i)];
}

double TendonFriction::stick() const {
  return kStickRange * length_;
}

void TendonFriction::add_span(double from, double to, const std::vector<AskedSection>& sections) {
  Span span{from, to, count_, 0, 0, 0, {}};
  while (count_ < sections.size() && sections[count_].inside < to) {
    ++count_;
    ++span.count;
  }
  if (span.count == 0) return;
  const auto n = static_cast<Eigen::Index>(span.count);
  if (!spans_.empty()) span.unknown = spans_.back().unknown + spans_.back().degrees;
  // a polynomial that is fitted to even points is stable up to about the root of their number
  const auto stable = static_cast<Eigen::Index>(2 * std::sqrt(static_cast<double>(n)));
  span.degrees = std::max<Eigen::Index>(1, std::min(n / kSectionsPerUnknown, stable));
  MatX P(span.degrees, n);
  VecX weights(n), column, integral;
  std::vector<double> s;
  for (Eigen::Index i = 0; i < n; ++i) {
    const AskedSection& at = sections[span.first + static_cast<std::size_t>(i)];
    legendre((at.s - from) / (to - from), span.degrees, column, integral);
    P.col(i) = column;
    weights[i] = at.weight;
    s.push_back(at.s);
  }
  const MatX PW = P * weights.asDiagonal();
  span.fit = (to - from) * MatX(PW * P.transpose()).fullPivLu().solve(PW);
  for (std::size_t i = 0, begin = 0, end = 0; i < span.count; ++i) {
    // pieces of splines have a section each where they meet: slopes are those of one piece
    if (i == end) {
      begin = end++;
      while (end < span.count && s[end] > s[end - 1])
        ++end;
    }
    const std::size_t m = std::min(kSlopePoints, end - begin);
    const std::size_t first = std::min(i - std::min(i - begin, m / 2), end - m);
    const std::vector<double> x(s.begin() + static_cast<std::ptrdiff_t>(first),
                                s.begin() + static_cast<std::ptrdiff_t>(first + m));
    slopes_.push_back({span.first + first, interpolation(x, s[i], true)});
  }
  spans_.push_back(span);
}

Eigen::RowVectorXd TendonFriction::basis(double s, double inside) const {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(c_.size());
  for (std::size_t k = 0; k < spans_.size(); ++k) {
    const Span& span = spans_[k];
    if (k > 0 && inside > span.from) row[bends_[k - 1].unknown] = 1;
    if (inside > span.to) {
      row[span.unknown] = 1;
    } else if (inside > span.from) {
      VecX values, integrals;
      legendre((s - span.from) / (span.to - span.from), span.degrees, values, integrals);
      row.segment(span.unknown, span.degrees) = integrals.transpose();
    }
  }
  return row;
}

void TendonFriction::set_values(const VecX& c) {
  c_ = c;
  scratch_.turned.noalias() = basis_ * c_;
  factors_.head(basis_.rows()) = (-mu_ * scratch_.turned).array().exp();
}

double TendonFriction::factor_at(double s, double inside) const {
  return std::exp(-mu_ * basis(s, inside).dot(c_));
}

double TendonFriction::factor_by(Eigen::Index unknown, std::size_t section) const {
  if (section >= count_) return 0;
  return -mu_ * factor(section) * basis_(static_cast<Eigen::Index>(section), unknown);
}

Vec3 TendonFriction::direction(const TendonSection& section) const {
  return Eigen::Map<const Vec3>(section.directions + 3 * index_);
}

// The angle between a and b by the chord between their unit vectors, which is exact where there is
// none, too.
TendonFriction::Turn TendonFriction::turn(const Vec3& left, const Vec3& right) {
  const Vec3 a = left.normalized(), b = right.normalized(), chord = b - a;
  const double length = std::min(chord.norm(), 1.9);
  Turn turn;
  turn.angle = 2 * std::asin(0.5 * length);
  if (length < kStraight) return turn;
  const Vec3 e = chord.normalized() / std::sqrt(1 - 0.25 * length * length);
  turn.by_left = -(e - a * a.dot(e)) / left.norm();
  turn.by_right = (e - b * b.dot(e)) / right.norm();
  return turn;
}

// From the middle of a section to its end.
void TendonFriction::find_passed(const std::vector<TendonSection>& sections) {
  double beyond = 0;
  for (std::size_t j = count_; j-- > 0;) {
    const auto i = static_cast<Eigen::Index>(j);
    const double here = 0.5 * weights_[j] * length_ * (unloaded_[i] - sections[j].stretch[index_]);
    passed_[i] = beyond + here;
    beyond += 2 * here;
  }
}

void TendonFriction::gaps(const std::vector<TendonSection>& sections, const std::vector<Vec3>& u,
                          Eigen::Ref<VecX> gap) {
  for (std::size_t j = 0; j < count_; ++j) {
    t_[j] = direction(sections[j]);
    u_[j] = u[j];
  }
  find_passed(sections);
  for (std::size_t j = 0; j < count_; ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    const Vec3 turning = slopes_[j].of(t_) / length_ + u_[j].cross(t_[j]);
    kappa_[i] = turning.norm();
    heading_[j] = kappa_[i] * length_ > kStraight ? Vec3(turning / kappa_[i]) : Vec3(Vec3::Zero());
    const double trial =
        engaged_ ? phi_before_[i] + (passed_[i] - passed_before_[i]) / stick() : 1.0;
    phi_[i] = std::clamp(trial, -1.0, 1.0);
    slips_[j] = !engaged_ || std::abs(trial) > 1;  // to begin with it sticks
  }
  gap = -c_;
  scratch_.turned = length_ * phi_.cwiseProduct(kappa_);
  add_fitted(gap);
  for (const Bend& bend : bends_)
    gap[bend.unknown] += phi_[static_cast<Eigen::Index>(bend.before)] *
                         turn(bend.left.of(t_), bend.right.of(t_)).angle;
}

void TendonFriction::add_fitted(Eigen::Ref<VecX> sum) const {
  for (const Span& span : spans_)
    sum.segment(span.unknown, span.degrees).noalias() +=
        span.fit.lazyProduct(scratch_.turned.segment(static_cast<Eigen::Index>(span.first),
                                                     static_cast<Eigen::Index>(span.count)));
}

void TendonFriction::rates(const std::vector<TendonSection>& sections,
                           const std::vector<Vec6>& strain_rates, Eigen::Ref<VecX> rate) const {
  std::vector<Vec3>& dt = scratch_.dt;
  VecX &stretched = scratch_.stretched, &dphi = scratch_.dphi, &turned = scratch_.turned;
  for (std::size_t j = 0; j < count_; ++j) {
    const Vec3 r = Eigen::Map<const Vec3>(sections[j].places[index_].r);
    const Vec3 dg = strain_rates[j].tail<3>() + strain_rates[j].head<3>().cross(r);
    const double along = t_[j].dot(dg);
    stretched[static_cast<Eigen::Index>(j)] = along;
    dt[j] = (dg - along * t_[j]) / sections[j].stretch[index_];
  }
  dphi.setZero();
  double beyond = 0;
  for (std::size_t j = count_; j-- > 0;) {
    const auto i = static_cast<Eigen::Index>(j);
    const double here = 0.5 * weights_[j] * length_ * stretched[i];
    if (!slips_[j]) dphi[i] = -(beyond + here) / stick();
    beyond += 2 * here;
    const double dkappa = heading_[j].dot(
        slopes_[j].of(dt) / length_ + strain_rates[j].head<3>().cross(t_[j]) + u_[j].cross(dt[j]));
    turned[i] = length_ * (phi_[i] * dkappa + dphi[i] * kappa_[i]);
  }
  rate.setZero();
  add_fitted(rate);
  for (const Bend& bend : bends_) {
    const auto i = static_cast<Eigen::Index>(bend.before);
    const Turn at = turn(bend.left.of(t_), bend.right.of(t_));
    rate[bend.unknown] += dphi[i] * at.angle + phi_[i] * (at.by_left.dot(bend.left.of(dt)) +
                                                          at.by_right.dot(bend.right.of(dt)));
  }
}

void TendonFriction::accept() {
  phi_before_ = phi_;
  passed_before_ = passed_;
}

void TendonFriction::visit(Archive& archive) {
  VecX c = c_;
  archive(c);
  if (archive.reading()) set_values(c);
  archive(phi_before_);
  archive(passed_before_);
  archive(phi_);
  archive(passed_);
  archive(engaged_);
}

}  // namespace cprsim
