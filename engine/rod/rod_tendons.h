// SPDX-License-Identifier: BSD-3-Clause
// The tendons of one rod at all the sections that its discretisation asks. Only rods with tendons
// have one.
#pragma once

#include <memory>
#include <vector>

#include "engine/math/types.h"
#include "engine/rod/rod_model.h"
#include "engine/rod/tendon_friction.h"
#include "engine/section/tendon.h"
#include "engine/time/scheme.h"

namespace cprsim {

/// A section that a discretisation asks, and its share of the length: weights add up to 1.
struct AskedSection {
  double s = 0, inside = 0;  ///< as Tendon::at
  double weight = 0;
  Vec3 rest = Vec3::Zero();  ///< curvature of the unloaded rod, section axes
};

/// Tensions are given, or unknown where the displacement is: then x is the tension as long as the
/// tendon is taut, and with x < 0 it hangs slack by c |x|, so that one row says both,
///   gap = (length - prescribed length - c min(x, 0)) / L = 0,   tension = max(x, 0)            (1)
/// Behind them stand the unknowns of friction (engine/rod/tendon_friction.h), with their own rows.
/// A rod that is fed keeps its tendons at the same fractions of its length: as it grows they run
/// straighter, and what their motors have pulled in is counted from the unloaded rod of the length
/// that it now has.
class RodTendons {
 public:
  /// @param EI that makes c a compliance @param stations where strains may jump, s
  RodTendons(std::vector<Tendon> tendons, double length, const std::vector<AskedSection>& sections,
             double EI, const std::vector<double>& stations);

  RodTendons(const RodTendons&) = delete;
  RodTendons& operator=(const RodTendons&) = delete;

  void set(const std::vector<TendonPull>& pulls, double length);

  /// The law at section i, as asked; what is found there stays until the next time.
  TendonSection& at(std::size_t i) { return sections_[i]; }

  const TendonSection& at(std::size_t i) const { return sections_[i]; }

  void evaluate(std::size_t section, const Vec3& u, const Vec3& v);

  /// After all sections have been evaluated.
  std::vector<TendonSample> observe() const;

  void visit(Archive& archive);

  /// Displacements, and with friction also those of single sections, which the time scheme
  /// integrates for the sake of their rates.
  Track* track() { return &track_; }

  void fill_track();
  void start_track();
  /// With rates of (u, v), one of every section.
  void start_track_moving(const std::vector<Vec6>& strain_rates);

  /// What tendons add to the stiffness (u, v) of any section with these strains, section axes.
  /// @param locked if not null: as locked_at()
  Mat6 stiffness(double s, double inside, const Vec3& u, const Vec3& v, MatX* locked) const;

  /// Whether any has friction: gaps() then asks for curvatures.
  bool rub() const { return !frictions_.empty(); }

  void set_curvature(std::size_t section, const Vec3& u) {
    if (rub()) curvatures_[section] = u;
  }

  /// From here on friction remembers; accept() ends a step.
  void engage_friction();
  void accept();

  // unknown tensions
  Eigen::Index unknowns() const {
    return static_cast<Eigen::Index>(unknown_.size()) + friction_unknowns_;
  }

  VecX values() const;
  void set_values(const VecX& x);

  /// Remembers the unknowns; move() then sets them to the remembered ones plus alpha x.
  void keep() { kept_ = values(); }

  void move(double alpha, const VecX& x) { set_values(kept_ + alpha * x); }

  double unit(Eigen::Index unknown) const {  ///< N, of a tension that bends the rod; 1 of others
    const auto k = static_cast<std::size_t>(unknown);
    return k < unknown_.size() ? units_[unknown_[k]] : 1;
  }

  const VecX& gaps();  ///< (1)

  /// By the last gaps().
  const VecX& gaps_found() const { return gaps_; }

  /// By its own x, where it hangs slack; by friction's own.
  double gap_by_own(Eigen::Index unknown) const;
  /// Rates of (1) at rates of (u, v), one of every section.
  void gap_rates(const std::vector<Vec6>& strain_rates, Eigen::Ref<VecX> rates) const;
  /// (Lambda_m, Lambda_n) at a section per unit of an unknown; 0 where it hangs slack.
  Vec6 per_unknown(Eigen::Index unknown, std::size_t section) const;

  /// W for each m/s of feed that it takes to bring in as much taut tendon as the unloaded rod grows
  /// by.
  double feed_power() const;

  /// The stretch of tendons whose length is held, by (u, v): 6 × number of taut unknown ones.
  MatX locked_at(std::size_t section) const { return locked(sections_[section]); }

 private:
  struct Friction {
    std::size_t tendon;
    TendonFriction law;
  };

  const TendonFriction* friction_of(std::size_t tendon) const;
  void spread_tensions();

  /// Of a tendon's way at a section, against the unloaded rod.
  double shortening(std::size_t section, std::size_t tendon) const {
    return weights_[section] * (unloaded_stretch_[section * tendons_.size() + tendon] -
                                sections_[section].stretch[tendon]);
  }

  void lie_along(double length);
  double length_of(std::size_t tendon) const;
  MatX locked(const TendonSection& section) const;
  Vec6 stretch_by_strain(const TendonSection& section, std::size_t tendon) const;

  std::vector<Tendon> tendons_;
  double length_ = 0, EI_ = 0;
  std::vector<AskedSection> asked_;
  std::vector<double> weights_;      ///< m, of the sections
  std::vector<double> tensions_;     ///< N, at the motor
  std::vector<TendonPlace> places_;  ///< sections × tendons
  std::vector<double> stretch_, directions_;
  std::vector<TendonSection> sections_;
  std::vector<double> unloaded_;  ///< lengths along the unloaded rod, by the same quadrature
  std::vector<double> unloaded_stretch_,
      paid_out_;                        ///< of |g| there; of lengths by the rod's length
  std::vector<double> reach_;           ///< largest r² along it, m²
  std::vector<double> slackness_;       ///< c of (1), m/N
  std::vector<double> units_;           ///< EI / (L r), N
  std::vector<std::size_t> unknown_;    ///< tendons with unknown tension
  std::vector<double> x_, prescribed_;  ///< of all tendons: unknowns, and lengths (m)
  VecX kept_, gaps_;
  Track track_;
  std::vector<Friction> frictions_;
  Eigen::Index friction_unknowns_ = 0;
  std::vector<double> spread_;    ///< with friction: tensions, sections × tendons
  std::vector<Vec3> curvatures_;  ///< with friction: of the sections
};

/// By (u, v), of an evaluated section.
Mat6 stiffness_of(const TendonSection& section);

}  // namespace cprsim
