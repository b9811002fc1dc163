// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/planar_tendons.h"

#include "engine/rod/planar.h"

namespace cprsim {

PlanarTendons::PlanarTendons(std::vector<Tendon> tendons, double length,
                             const std::vector<AskedSection>& sections, double EI,
                             const std::vector<double>& stations, const Mat3& offset)
    : tendons_(std::move(tendons), length, sections, EI, stations), pulls_(sections.size()) {
  strains_.setZero();
  strains_.block<3, 1>(0, 0) = offset.row(2).transpose();
  strains_.block<3, 2>(3, 1) = offset.topRows<2>().transpose();
}

void PlanarTendons::evaluate(std::size_t stage, const PlanarStage& at) {
  const Vec6 strain = strains_ * Vec3(at.kappa, at.v[0], at.v[1]);
  tendons_.evaluate(stage, strain.head<3>(), strain.tail<3>());
  tendons_.set_curvature(stage, strain.head<3>());
  const TendonSection& section = tendons_.at(stage);
  Vec6 Lambda;
  Lambda << Eigen::Map<const Vec3>(section.moment), Eigen::Map<const Vec3>(section.force);
  const Vec3 pull = strains_.transpose() * Lambda;
  const Mat3 K = strains_.transpose() * stiffness_of(section) * strains_;
  PlanarPull& out = pulls_[stage];
  Eigen::Map<Vec3>(out.value) = pull;
  Eigen::Map<Mat3>(out.by) = K;  // symmetric
}

// A rod by shooting with tendons.
void PlanarRod::place_tendons() {
  std::vector<AskedSection> sections;
  for (std::size_t c = 0; c < static_cast<std::size_t>(cells_); ++c)
    for (int j = 0; j < table_->stages; ++j) {
      const double from = grid_[c], h = grid_[c + 1] - from;
      sections.push_back({from + h * table_->c[j], from + 0.5 * h, h * table_->b[j], Vec3::Zero()});
    }
  tendons_ = std::make_unique<PlanarTendons>(options_.tendons, forcing_.length, sections, K_b_,
                                             options_.stations, offset_);
}

bool PlanarRod::linearize(const Port& base, const Port& tip, CondensedRod& out) {
  return finds_tensions() ? border_.linearize(*this, tendons_->in_space(), base, tip, out)
                          : linearize_given(base, tip, out);
}

void PlanarRod::set_direction(const Vec6& z, const Vec6& zeta_A) {
  if (finds_tensions())
    take_direction(border_.direction(z, zeta_A));
  else
    find_direction(z, zeta_A);
}

VecX PlanarRod::direction_given(const Vec6& z, const Vec6& zeta_A) {
  find_direction(z, zeta_A);
  return found_direction();
}

// Starts of segments, lifted unknowns.
VecX PlanarRod::found_direction() const {
  const auto starts = static_cast<Eigen::Index>(6 * start_direction_.size()),
             lifted = static_cast<Eigen::Index>(lifted_direction_.size());
  VecX all(starts + lifted);
  for (std::size_t g = 0; g < start_direction_.size(); ++g)
    all.segment<6>(static_cast<Eigen::Index>(6 * g)) = start_direction_[g];
  all.tail(lifted) = Eigen::Map<const VecX>(lifted_direction_.data(), lifted);
  return all;
}

void PlanarRod::take_direction(const VecX& all) {
  start_direction_.resize(starts_.size());
  lifted_direction_.resize(static_cast<std::size_t>(cells_ * kernel_.lifted));
  const double* from = all.data();
  for (Vec6& start : start_direction_) {
    start = Eigen::Map<const Vec6>(from);
    from += 6;
  }
  std::copy_n(from, lifted_direction_.size(), lifted_direction_.begin());
  tension_direction_ = all.tail(tendons_->in_space().unknowns());
}

void PlanarRod::add_tension(Eigen::Index unknown, bool add) {
  if (!add) {
    stages_ = kept_stages_;
    return;
  }
  kept_stages_ = stages_;
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const Vec3 Lambda =
        tendons_->strains().transpose() * tendons_->in_space().per_unknown(unknown, j);
    stages_[j].residual_kappa += model_.C_b * Lambda[0];
    for (int i = 0; i < 2; ++i)
      stages_[j].residual_v[i] += model_.C_v[i] * Lambda[1 + i];
  }
}

std::vector<Vec6> PlanarRod::strain_rates(const VecX& direction) const {
  const auto S = static_cast<std::size_t>(table_->stages);
  std::vector<Vec6> rates(stages_.size());
  const double* d = direction.data() + 6 * starts_.size();
  for (std::size_t c = 0; c < static_cast<std::size_t>(cells_); ++c, d += kernel_.lifted)
    for (std::size_t j = 0; j < S; ++j)
      rates[c * S + j] = tendons_->strains() * Vec3(d[j], d[S + 2 * j], d[S + 2 * j + 1]);
  return rates;
}

std::vector<Track*> PlanarRod::tracks() {
  std::vector<Track*> all{&track_};
  if (tendons_) all.push_back(tendons_->in_space().track());
  return all;
}

void PlanarRod::describe_tendons(RodField& field) const {
  for (std::size_t j = 0; j < stages_.size(); ++j)
    field.add_tendons(stiffness_of(tendons_->in_space().at(j)), tendons_->in_space().locked_at(j));
}

}  // namespace cprsim
