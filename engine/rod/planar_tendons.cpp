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
      sections.push_back(
          {from + h * table_->c[j], from + 0.5 * h, h * table_->b[j],
           own_[c * static_cast<std::size_t>(table_->stages) + static_cast<std::size_t>(j)]
                   .kappa_rest *
               offset_.row(2).transpose()});
    }
  tendons_ = std::make_unique<PlanarTendons>(options_.tendons, forcing_.length, sections, K_b_,
                                             options_.stations, offset_);
}

bool PlanarRod::linearize(const Port& base, const Port& tip, CondensedRod& out) {
  return finds_tensions() ? border_.linearize(*this, tendons_->in_space(), base, tip, out)
                          : condense(base, tip, out, nullptr);
}

void PlanarRod::set_direction(const Vec6& z, const Vec6& zeta_A) {
  if (finds_tensions()) {
    find_direction_in_case(border_.complete(z, zeta_A, VecX(0)).col(0));
    tension_direction_ = border_.tensions(tendons_->in_space());
  } else {
    find_direction(z.head<3>(), zeta_A.head<3>(), 1);
  }
}

void PlanarRod::find_direction_in_case(const Eigen::Ref<const VecX>& column) {
  pulled_.weights.setZero(PulledColumns::kUsed * static_cast<Eigen::Index>(pulled_.blocks.size()));
  pulled_.weights.head(tendon_unknowns()) = column.tail(tendon_unknowns());
  find_direction(column.head<3>(), column.segment<3>(3), column[6]);
}

// Of all lifted unknowns: strains follow from them.
void PlanarRod::find_directions(const MatX& cases, MatX& directions) {
  directions.resize(cells_ * kernel_.lifted, cases.cols());
  for (Eigen::Index c = 0; c < cases.cols(); ++c) {
    find_direction_in_case(cases.col(c));
    directions.col(c) = Eigen::Map<const VecX>(lifted_direction_.data(), directions.rows());
  }
}

// Columns of the tendons' unknowns begin as zeros and enter with the laws of the sections.
void PlanarRod::begin_pulled_columns() {
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto lifted = static_cast<std::size_t>(kernel_.lifted),
             cells = static_cast<std::size_t>(cells_);
  const Eigen::Index m = tendon_unknowns();
  const auto blocks =
      static_cast<std::size_t>((m + PulledColumns::kUsed - 1) / PulledColumns::kUsed);
  pulled_.blocks.assign(blocks, PulledColumns::Block::Zero());
  pulled_.at_segment.resize(static_cast<std::size_t>(segments()));
  pulled_.G.resize(static_cast<std::size_t>(segments()));
  for (auto& G : pulled_.G)
    G.clear();
  pulled_.directions.resize(blocks * cells * lifted * kPlanarWide);
  pulled_.sources.assign(pulled_.directions.size(), 0);
  const RodTendons& tendons = tendons_->in_space();
  for (Eigen::Index k = 0; k < m; ++k) {
    const auto block = static_cast<std::size_t>(k / PulledColumns::kUsed),
               column = static_cast<std::size_t>(k % PulledColumns::kUsed);
    for (std::size_t j = 0; j < stages_.size(); ++j) {
      const Vec3 Lambda =
          tendons.unit(k) * (tendons_->strains().transpose() * tendons.per_unknown(k, j));
      double* rows = &pulled_.sources[(block * cells + j / S) * lifted * kPlanarWide] + column;
      const PlanarSection& at = coefficients_[j];
      rows[(j % S) * kPlanarWide] = at.C_b * Lambda[0];
      for (std::size_t i = 0; i < 2; ++i)
        rows[(S + 2 * (j % S) + i) * kPlanarWide] =
            at.C_v[i] * Lambda[1 + static_cast<Eigen::Index>(i)];
    }
  }
}

bool PlanarRod::sweep_pulled_columns(std::size_t cell) {
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto lifted = static_cast<std::size_t>(kernel_.lifted),
             cells = static_cast<std::size_t>(cells_);
  for (std::size_t b = 0; b < pulled_.blocks.size(); ++b) {
    PulledColumns::Block& block = pulled_.blocks[b];
    const std::size_t at = (b * cells + cell) * lifted * kPlanarWide;
    model_.sources = &pulled_.sources[at];
    const bool regular =
        kernel_.linearize_wide(model_, &stages_[cell * S], block.data(), &pulled_.directions[at]);
    model_.sources = nullptr;
    if (!regular) return false;
    // the affine part is in the other columns already
    block.rightCols<kPlanarWide - PulledColumns::kUsed>().setZero();
    apply_load_columns(cell + 1, nodes_[cell + 1], block.data(), kPlanarWide);
  }
  return true;
}

void PlanarRod::add_pulled_direction() {
  const std::size_t n = lifted_direction_.size();
  for (std::size_t b = 0; b < pulled_.blocks.size(); ++b) {
    const Vec6 w = pulled_.weights_of(b);
    if (w.isZero(0)) continue;
    for (std::size_t g = 0; g < start_direction_.size(); ++g)
      start_direction_[g] += pulled_.at_segment[g][b].leftCols<PulledColumns::kUsed>() * w;
    for (std::size_t i = 0; i < n; ++i)
      lifted_direction_[i] +=
          Eigen::Map<const Vec6>(&pulled_.directions[(b * n + i) * kPlanarWide]).dot(w);
  }
}

/// Tip rows and wrenches by the tendons' unknowns, as close_tip() and close_base() have them by z.
void PlanarRod::close_pulled(const TipRows& rows, const Mat3& by_z_of_base, TensionPorts& ports) {
  const Eigen::Index m = tendon_unknowns();
  for (MatX* by_x : {&ports.T, &ports.WA, &ports.WB})
    by_x->setZero(3, m);
  for (std::size_t b = 0; b < pulled_.blocks.size(); ++b) {
    const Eigen::Matrix<double, 6, PulledColumns::kUsed> Y =
        pulled_.blocks[b].leftCols<PulledColumns::kUsed>();
    Eigen::Matrix<double, 3, PulledColumns::kUsed> Z =
        Eigen::Matrix<double, 3, PulledColumns::kUsed>::Zero();
    for (int g = segments() - 2; g >= 0; --g) {
      const auto k = static_cast<std::size_t>(g);
      Z -= pulled_.G[k][b];
      recombinations_[k].R.triangularView<Eigen::Upper>().solveInPlace(Z);
    }
    const Eigen::Index first = PulledColumns::kUsed * static_cast<Eigen::Index>(b);
    for (Eigen::Index c = 0; c < PulledColumns::kUsed && first + c < m; ++c) {
      ports.T.col(first + c) = rows.T * Y.col(c);
      ports.WB.col(first + c) = rows.W * Y.col(c);
      ports.WA.col(first + c) = by_z_of_base * Z.col(c);
    }
  }
}

void PlanarRod::strain_rates(const Eigen::Ref<const VecX>& direction,
                             std::vector<Vec6>& rates) const {
  const auto S = static_cast<std::size_t>(table_->stages);
  rates.resize(stages_.size());
  const double* d = direction.data();
  for (std::size_t c = 0; c < static_cast<std::size_t>(cells_); ++c, d += kernel_.lifted)
    for (std::size_t j = 0; j < S; ++j)
      rates[c * S + j] = tendons_->strains() * Vec3(d[j], d[S + 2 * j], d[S + 2 * j + 1]);
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
