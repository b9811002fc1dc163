// SPDX-License-Identifier: BSD-3-Clause
// The law of the sections and its modes, whether they vary along the rod or not.
#include "engine/rod/arc_grid.h"
#include "engine/rod/strain_basis.h"

namespace cprsim {

void StrainRod::place_tendons() {
  std::vector<AskedSection> sections;
  for (std::size_t e = 0; e < elements(); ++e)
    for (Eigen::Index i = 0; i < rule_.points(); ++i) {
      const double s = grid_[e] + (grid_[e + 1] - grid_[e]) * rule_.gauss.points[i];
      sections.push_back({s, s, (grid_[e + 1] - grid_[e]) * rule_.gauss.weights[i],
                          rest_curvature(e, rule_.phi.col(i))});
    }
  tendons_ = std::make_unique<RodTendons>(options_.tendons, forcing_.length, sections,
                                          section_.K_bt.head<2>().maxCoeff(),
                                          all_stations(options_.stations, options_.along.get()));
}

const VecX& StrainRod::tendon_gaps() {
  for (std::size_t j = 0; tendons_->rub() && j < points_.size(); ++j)
    tendons_->set_curvature(j, points_[j].u);
  return tendons_->gaps();
}

void StrainRod::list_sections() {
  const SectionsAlong& along = *options_.along;
  for (std::size_t e = 0; e < elements(); ++e) {
    const double from = grid_[e], h = grid_[e + 1] - from;
    Rows3 rest = Rows3::Zero(3, rule_.functions());
    for (Eigen::Index i = 0; i < rule_.points(); ++i) {
      const double s = from + h * rule_.gauss.points[i];
      sections_.push_back(along.at(s, from + 0.5 * h));
      rest += rule_.gauss.weights[i] * along.rest_curvature(s) * rule_.phi.col(i).transpose();
    }
    rest_.push_back(rest);
  }
}

// In a plane a section bends about its axis along the normal, which is a principal one or all are
// alike.
void StrainRod::list_modes(const Mat3& R_WBase) {
  const auto add = [&](const Vec3& axis, bool turns, bool listed) {
    const Vec3 &K = turns ? section_.K_bt : section_.K_se,
               &B = turns ? section_.B_bt : section_.B_se;
    modes_.push_back({axis, turns, axis.dot(K.cwiseProduct(axis)),
                      options_.damping ? axis.dot(B.cwiseProduct(axis)) : 0, listed});
  };
  if (space_.freedoms() == 3) {
    Vec3 normal = R_WBase.transpose() * Vec3(space_.motion.block<3, 1>(0, 0));
    normal.z() = 0;
    normal.normalize();
    add(normal, true, true);
    if (options_.shear) add(Vec3::UnitZ().cross(normal), false, true);
  } else {
    for (int i = 0; i < 3; ++i)
      add(Vec3::Unit(i), true, true);
    for (int i = 0; i < 2 && options_.shear; ++i)
      add(Vec3::Unit(i), false, true);
  }
  add(Vec3::UnitZ(), false, options_.extension);
  for (std::size_t a = 0; a < modes_.size(); ++a)
    if (modes_[a].listed) free_modes_.push_back(a);
}

double StrainRod::compliance(const StrainMode& mode) const {
  double C = mode.listed ? 1 / (mode.K + rates_.c_v * mode.damping) : 0;
  if (!mode.turns && mode.axis.z() != 0)
    C += forcing_.axial_softness * forcing_.length * forcing_.length /
         section_.K_bt.head<2>().maxCoeff();
  return C;
}

double StrainRod::stiffness(const StrainMode& mode, std::size_t point) const {
  const SectionProperties& own = section(point);
  return mode.axis.dot((mode.turns ? own.K_bt : own.K_se).cwiseProduct(mode.axis));
}

double StrainRod::damping(const StrainMode& mode, std::size_t point) const {
  const SectionProperties& own = section(point);
  if (!options_.damping) return 0;
  return mode.axis.dot((mode.turns ? own.B_bt : own.B_se).cwiseProduct(mode.axis));
}

double StrainRod::compliance(const StrainMode& mode, std::size_t point) const {
  const double base = compliance(mode);
  if (sections_.empty() || !mode.listed) return base;
  return base + 1 / (stiffness(mode, point) + rates_.c_v * damping(mode, point)) -
         1 / (mode.K + rates_.c_v * mode.damping);
}

/// ∫ Phi^T C B Phi q ds of one mode in an element, per its length.
Eigen::RowVectorXd StrainRod::weighted_by_damping(const StrainMode& mode, std::size_t element,
                                                  const Eigen::RowVectorXd& q) const {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(q.size());
  for (Eigen::Index i = 0; i < rule_.points(); ++i) {
    const std::size_t at =
        element * static_cast<std::size_t>(rule_.points()) + static_cast<std::size_t>(i);
    sum += rule_.gauss.weights[i] * compliance(mode, at) * damping(mode, at) *
           q.dot(rule_.phi.col(i)) * rule_.phi.col(i).transpose();
  }
  return sum;
}

}  // namespace cprsim
