// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/planar_immersion.h"

#include "engine/section/line_load.h"

namespace cprsim {
namespace {

using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

PlanarImmersion::PlanarImmersion(std::size_t count, const Mat3& plane, const Mat3& offset,
                                 double height)
    : plane_(plane), offset_(offset), height_(height), fluid_(count), around_(count) {}

VecX PlanarImmersion::lifted(const VecX& in_plane, double along_normal) const {
  const auto n = static_cast<Eigen::Index>(around_.size());
  VecX all(3 * n);
  for (Eigen::Index i = 0; i < n; ++i)
    all.segment<3>(3 * i) = plane_ * Vec3(in_plane[2 * i], in_plane[2 * i + 1], along_normal);
  return all;
}

// Along the normal nothing moves: x_t = c_v x + x_h = 0 and x_tt = c_w x_t + ... = 0 there.
void PlanarImmersion::prepare(const SectionProperties& section, const StageRates& rates,
                              const RodForcing& forcing, const Track& in_plane,
                              const std::vector<SectionProperties>& sections) {
  rates_ = rates;
  Track track;
  if (rates.dynamic()) {
    track.x_h = lifted(in_plane.x_h, -rates.c_v * height_);
    track.v_h = lifted(in_plane.v_h, 0);
  }
  fluid_.prepare(section, sections, rates, forcing, track);
}

Mat3 PlanarImmersion::rotation(const PlanarStage& at) const {
  Mat3 turn = Mat3::Identity();
  turn.topLeftCorner<2, 2>() << at.c, -at.s, at.s, at.c;
  return plane_ * turn * offset_;
}

Vec3 PlanarImmersion::position(const PlanarStage& at) const {
  return plane_ * Vec3(at.p[0], at.p[1], height_);
}

void PlanarImmersion::evaluate(std::size_t place, const PlanarStage& at) {
  FluidSection& in_space = *fluid_.at(place);
  const RowMat3 R = rotation(at);
  const Vec3 p = position(at), normal = plane_.col(2);
  evaluate_surroundings(rates_.c_v, rates_.c_w, load(p.data()), load_matrix(R.data()),
                        fluid_.field(), in_space);
  PlanarAround& around = around_[place];
  const Eigen::Matrix<double, 3, 2> P = plane_.leftCols<2>();
  const Eigen::Map<const RowMat3> by_p(in_space.force_p), by_phi(in_space.force_phi);
  Eigen::Map<Vec2>(around.n) = P.transpose() * Eigen::Map<const Vec3>(in_space.force);
  Eigen::Map<Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>(around.n_p) = P.transpose() * by_p * P;
  Eigen::Map<Vec2>(around.n_theta) = P.transpose() * (by_phi * normal);
  around.m = around.m_theta = 0;
  Eigen::Map<Vec2>(around.m_p).setZero();
  if (!fluid_.loaded()) return;
  around.m = normal.dot(Eigen::Map<const Vec3>(in_space.moment));
  around.m_theta = normal.dot(Eigen::Map<const RowMat3>(in_space.moment_phi) * normal);
  if (fluid_.field_varies() && in_space.magnetic != 0)
    Eigen::Map<Vec2>(around.m_p) =
        P.transpose() * (Eigen::Map<const RowMat3>(in_space.moment_p).transpose() * normal);
}

void PlanarImmersion::add_powers(const std::vector<double>& weights,
                                 const std::vector<PlanarStage>& stages, const Track& in_plane,
                                 RodEnergy& energy) const {
  if (!rates_.dynamic()) return;
  Track track;
  track.v = lifted(in_plane.v, 0);
  track.a = lifted(in_plane.a, 0);
  for (std::size_t j = 0; j < stages.size(); ++j)
    fluid_.add_power(j, rotation(stages[j]).col(2), weights[j], track, energy);
}

double PlanarImmersion::magnetic_energy(std::size_t place, const PlanarStage& at,
                                        const MagneticField& field) const {
  return fluid_.magnetic_energy(place, rotation(at), position(at), field);
}

Mat6 PlanarImmersion::outer_stiffness(double inside, const PlanarStage& at) const {
  return fluid_.outer_stiffness(inside, rotation(at), position(at));
}

}  // namespace cprsim
