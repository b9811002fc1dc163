// SPDX-License-Identifier: BSD-3-Clause
// Coulomb friction between a tendon and its channel. Where the direction t of the tendon turns by
// kappa per length of the rod its tension tau falls, towards the end that lags behind, as a belt's
// does:
//   tau_s = -mu phi kappa tau,    kappa = |t_s + u × t|  (section axes),    phi in [-1, 1]      (1)
// (Euler and Eytelwein; for continuum robots Kato and others, IEEE/ASME Trans. Mechatronics 20
// (2015) 2252-2263; Rao and others, Front. Robot. AI 7 (2021) 630245). Bends of its way and jumps
// of the strain turn it at once: a factor exp(-mu phi angle).
//
// phi = 1: it slips towards its motor, or is about to: equilibria at the start and in statics,
// which do not know how they were reached. From then on phi follows what the tendon does, by return
// mapping from the end of the last step as in engine/robot/axis_law.h: with y(s) the length of
// tendon that has passed s towards the motor, by which its way beyond s is shorter than along the
// unloaded rod,
//   phi = clamp(phi_0 + (y - y_0) / y_stick, -1, 1)                                            (2)
// so that it sticks, turns over when it is paid out, and takes energy either way. (2) holds as long
// as the tendon is taut beyond s.
//
// (1) makes the law of a section depend on all sections before it. In between stand coefficients c,
// unknowns of the rod: the turning of each span between stations as Legendre polynomials, fitted to
// phi kappa at its n sections, n / 3 of them and at most 2 sqrt(n); and one angle for each station,
//   tau(s) = tau_0 exp(-mu Theta(s)),    Theta = sum c_a B_a(s),    c = C(strains)             (3)
// Derivatives are exact for (3), which is (1) in the limit of fine rods: with the order of the
// polynomials where kappa is smooth, with the first power of n where it passes through 0.
#pragma once

#include <vector>

#include "engine/math/archive.h"
#include "engine/math/types.h"

namespace cprsim {

struct AskedSection;
struct TendonSection;

class TendonFriction {
 public:
  /// Of tendon `index` of all sections. @param stations s where spans end, in any order
  TendonFriction(double mu, double end, std::size_t index,
                 const std::vector<AskedSection>& sections, std::vector<double> stations);

  /// A rod of this length. @param unloaded |g| there, of each section, so far apart
  void lie_along(double length, const double* unloaded, std::size_t apart);

  Eigen::Index unknowns() const { return c_.size(); }

  const VecX& values() const { return c_; }

  void set_values(const VecX& c);

  /// Tension at a section over that at the motor.
  double factor(std::size_t section) const { return factors_[static_cast<Eigen::Index>(section)]; }

  double factor_at(double s, double inside) const;
  /// Of factor() by an unknown.
  double factor_by(Eigen::Index unknown, std::size_t section) const;

  /// C - c of (3), sections being evaluated. @param u curvatures
  void gaps(const std::vector<TendonSection>& sections, const std::vector<Vec3>& u,
            Eigen::Ref<VecX> gap);
  /// Of C at rates of (u, v), after gaps().
  void rates(const std::vector<TendonSection>& sections, const std::vector<Vec6>& strain_rates,
             Eigen::Ref<VecX> rate) const;

  /// From here on (2).
  void engage() { engaged_ = true; }

  /// The end of a step, after gaps().
  void accept();
  void visit(Archive& archive);

 private:
  /// Some sections with a weight each: a derivative or a value beside them.
  struct Stencil {
    std::size_t first = 0;
    std::vector<double> weights;

    template <class Values>
    Vec3 of(const Values& values) const {
      Vec3 sum = Vec3::Zero();
      for (std::size_t i = 0; i < weights.size(); ++i)
        sum += weights[i] * values[first + i];
      return sum;
    }
  };

  struct Span {
    double from = 0, to = 0;  ///< s
    std::size_t first = 0, count = 0;
    Eigen::Index unknown = 0, degrees = 0;
    MatX fit;  ///< coefficients, over the rod's length, by phi kappa at its sections
  };

  /// Between two spans.
  struct Bend {
    Eigen::Index unknown = 0;
    std::size_t before = 0;  ///< section
    Stencil left, right;     ///< t there, from either side
  };

  /// How a bend's angle follows from the directions beside it.
  struct Turn {
    double angle = 0;
    Vec3 by_left = Vec3::Zero(), by_right = Vec3::Zero();
  };

  void add_span(double from, double to, const std::vector<AskedSection>& sections);
  Eigen::RowVectorXd basis(double s, double inside) const;
  static Turn turn(const Vec3& left, const Vec3& right);
  Vec3 direction(const TendonSection& section) const;
  void find_passed(const std::vector<TendonSection>& sections);
  /// What polynomials fitted to the last turning add to coefficients.
  void add_fitted(Eigen::Ref<VecX> sum) const;

  /// y_stick of (2).
  double stick() const;

  double mu_ = 0, length_ = 1;
  std::size_t index_ = 0, count_ = 0;  ///< sections that it passes are the first `count_`
  std::vector<Span> spans_;
  std::vector<Bend> bends_;
  std::vector<Stencil> slopes_;  ///< of t at the sections, by s over the length
  std::vector<double> weights_;  ///< fractions of the length
  VecX unloaded_;                ///< |g| of the unloaded rod
  MatX basis_;                   ///< B of (3): sections × unknowns
  VecX c_, factors_;

  // what the last gaps() found
  std::vector<Vec3> t_, u_, heading_;  ///< heading: of the turning, a unit vector or 0
  VecX kappa_, phi_, passed_;          ///< passed: y of (2)
  std::vector<char> slips_;

  /// What rates() writes on its way.
  struct Scratch {
    std::vector<Vec3> dt;
    VecX stretched, turned, dphi;
  };

  mutable Scratch scratch_;

  bool engaged_ = false;
  VecX phi_before_, passed_before_;  ///< at the end of the last step
};

}  // namespace cprsim
