// SPDX-License-Identifier: BSD-3-Clause
// The sections of a planar rod: what of them motion in the plane meets, and the unloaded shape.
#include <cmath>

#include "engine/rod/planar.h"

namespace cprsim {

double PlanarRod::about_normal(const Vec3& diagonal) const {
  const Vec3 normal = offset_.row(2);
  return normal.dot(diagonal.cwiseProduct(normal));
}

double PlanarRod::along_section(const Vec3& diagonal) const {
  const Vec3 across = offset_.row(1);
  return across.dot(diagonal.cwiseProduct(across));
}

PlanarRod::Own PlanarRod::own_of(const SectionProperties& section) const {
  Own own;
  own.K_b = about_normal(section.K_bt);
  own.K_v = {section.K_se.z(), along_section(section.K_se)};
  own.B_v.setZero();
  if (options_.damping) {
    own.B_b = about_normal(section.B_bt);
    own.B_v = {section.B_se.z(), along_section(section.B_se)};
  }
  own.rhoA = section.rhoA;
  own.weighing = section.weighing_mass();
  own.rhoI = about_normal(section.rhoJ);
  return own;
}

void PlanarRod::list_sections() {
  own_.assign(stages_.size(), own_of(section_));
  coefficients_.resize(stages_.size());
  const auto S = static_cast<std::size_t>(table_->stages);
  const Vec3 normal = offset_.row(2);
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const double from = grid_[j / S], to = grid_[j / S + 1],
                 s = from + (to - from) * table_->c[j % S];
    if (options_.along) {
      sections_.push_back(options_.along->at(s, 0.5 * (from + to)));
      own_[j] = own_of(sections_[j]);
    }
    own_[j].kappa_rest =
        normal.dot(options_.along ? options_.along->rest_curvature(s) : section_.u_rest);
  }
}

// Cell by cell, as the kernel has it where nothing acts.
void PlanarRod::set_unloaded(double theta, const Vec2& p) {
  PlanarNode state{};
  state.theta = theta;
  state.c = std::cos(theta);
  state.s = std::sin(theta);
  state.p[0] = p.x();
  state.p[1] = p.y();
  starts_.assign(1, state);
  segment_first_ = {0, static_cast<std::size_t>(cells_)};
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    stages_[j].kappa = own_[j].kappa_rest;
    stages_[j].v[0] = 1;
    stages_[j].v[1] = 0;
  }
  const auto S = static_cast<std::size_t>(table_->stages);
  nodes_[0] = state;
  for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) {
    const double h = (grid_[k + 1] - grid_[k]) * forcing_.length, from = state.theta;
    for (std::size_t j = 0; j < S; ++j) {
      double turned = from;
      for (std::size_t i = 0; i < S; ++i)
        turned += h * table_->a[j][i] * stages_[k * S + i].kappa;
      state.p[0] += h * table_->b[j] * std::cos(turned);
      state.p[1] += h * table_->b[j] * std::sin(turned);
      state.theta += h * table_->b[j] * stages_[k * S + j].kappa;
    }
    state.c = std::cos(state.theta);
    state.s = std::sin(state.theta);
    nodes_[k + 1] = state;
  }
  evaluated_ = false;
}

// rigid modes are zeros: shear and extension each only if the scene lists them
void PlanarRod::set_coefficients(const Own& own, PlanarSection& section) const {
  const double L = forcing_.length;
  section.C_b = 1 / (own.K_b + rates_.c_v * own.B_b);
  section.C_v[0] = options_.extension ? 1 / (own.K_v.x() + rates_.c_v * own.B_v.x()) : 0;
  section.C_v[1] = options_.shear ? 1 / (own.K_v.y() + rates_.c_v * own.B_v.y()) : 0;
  section.C_v[0] += forcing_.axial_softness * L * L / K_b_;
  section.k = own.rhoA * rates_.c_v * rates_.c_w + forcing_.relaxation;
  const bool rotary = options_.rotary_inertia && rates_.dynamic();
  section.k_J = rotary ? own.rhoI * rates_.c_v * rates_.c_w : 0;
}

}  // namespace cprsim
