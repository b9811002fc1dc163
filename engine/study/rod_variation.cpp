// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/rod_variation.h"

#include <cmath>

#include "engine/math/so3.h"

namespace cprsim {
namespace {

using Rows3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Coordinates: phi and d at the base, then per point psi and the free components of e.
struct Layout {
  std::vector<int> strains;  ///< components of e that are free
  int per_point = 3;

  explicit Layout(const RodField& field) {
    for (int i = 0; i < 3; ++i)
      if (field.K_se[i] > 0) strains.push_back(i);
    per_point += static_cast<int>(strains.size());
  }

  Eigen::Index at(std::size_t point) const {
    return 6 + static_cast<Eigen::Index>(point) * per_point;
  }
};

/// Motion at one place as rows over all coordinates.
struct Motion {
  Rows3 phi, d;
};

/// Changes of (u, v) at a point by its coordinates.
MatX strain_changes(const RodField& field, const Layout& layout, std::size_t point) {
  MatX by_coordinates = MatX::Zero(6, layout.per_point);
  by_coordinates.topLeftCorner<3, 3>() = field.points[point].R.transpose();
  for (std::size_t e = 0; e < layout.strains.size(); ++e)
    by_coordinates(3 + layout.strains[e], 3 + static_cast<Eigen::Index>(e)) = 1;
  return by_coordinates;
}

}  // namespace

MatX planar_motions(const RodField& field, const Vec3& normal) {
  const Layout layout(field);
  const Eigen::Index n = layout.at(field.points.size());
  Vec3 e1 = normal.unitOrthogonal();
  MatX basis = MatX::Zero(n, n);
  Eigen::Index count = 0;
  const auto add = [&](Eigen::Index at, const Vec3& direction) {
    basis.block<3, 1>(at, count++) = direction;
  };
  add(0, normal);
  add(3, e1);
  add(3, normal.cross(e1));
  for (std::size_t j = 0; j < field.points.size(); ++j) {
    add(layout.at(j), normal);
    for (std::size_t e = 0; e < layout.strains.size(); ++e)
      // one of the section's axes is the normal
      if (std::abs(field.points[j].R.col(layout.strains[e]).dot(normal)) < 0.5)
        basis(layout.at(j) + 3 + static_cast<Eigen::Index>(e), count++) = 1;
  }
  return basis.leftCols(count);
}

RodVariation rod_variation(const RodField& field, bool rotary) {
  const Layout layout(field);
  const ArcTableau& table = *field.table;
  const auto S = static_cast<std::size_t>(table.stages);
  const Eigen::Index n = layout.at(field.points.size());
  RodVariation out;
  out.K = MatX::Zero(n, n);
  out.M = MatX::Zero(n, n);
  out.held = MatX::Zero(field.locked.empty() ? 0 : field.locked[0].cols(), n);
  out.nodes.resize(6 * static_cast<Eigen::Index>(field.cells.size() + 1), n);
  Motion node{Rows3::Zero(3, n), Rows3::Zero(3, n)};
  node.phi.leftCols<3>().setIdentity();
  node.d.middleCols<3>(3).setIdentity();
  out.base.resize(6, n);
  out.base << node.phi, node.d;
  out.nodes.topRows<6>() = out.base;
  std::vector<Rows3> d_s(S, Rows3::Zero(3, n));
  for (std::size_t c = 0; c < field.cells.size(); ++c) {
    const double h = field.cells[c];
    // coordinates from here on do not matter yet: work on the columns up to this cell's end
    const Eigen::Index active = layout.at((c + 1) * S);
    std::vector<Rows3> phi(S);
    // of one cell, stacked: full matrices are passed over once a cell
    const auto rows = 3 * static_cast<Eigen::Index>(S);
    MatX phi_all(rows, active), half_all(rows, active), d_all(rows, active), dw_all(rows, active);
    for (std::size_t j = 0; j < S; ++j) {
      const std::size_t at = c * S + j;
      const FieldPoint& point = field.points[at];
      phi[j] = node.phi.leftCols(active);
      for (std::size_t k = 0; k < S; ++k)
        phi[j].middleCols<3>(layout.at(c * S + k)).diagonal().array() += h * table.a[j][k];
      d_s[j] = -hat(point.tau) * phi[j];
      for (std::size_t e = 0; e < layout.strains.size(); ++e)
        d_s[j].col(layout.at(at) + 3 + static_cast<Eigen::Index>(e)) +=
            point.R.col(layout.strains[e]);
    }
    for (std::size_t j = 0; j < S; ++j) {
      const std::size_t at = c * S + j;
      const FieldPoint& point = field.points[at];
      const double w = h * table.b[j];
      const SectionProperties* own = field.sections.empty() ? nullptr : &field.sections[at];
      const Vec3 &K_bt = own ? own->K_bt : field.K_bt, &K_se = own ? own->K_se : field.K_se,
                 &rhoJ = own ? own->rhoJ : field.rhoJ;
      const double rhoA = own ? own->rhoA : field.rhoA,
                   added_mass = own ? own->fluid.added_mass : field.added_mass;
      Rows3 d = node.d.leftCols(active);
      for (std::size_t k = 0; k < S; ++k)
        d += h * table.a[j][k] * d_s[k];
      // (1); a product a·B b enters as half of itself, its transpose in the end
      auto K = out.K.topLeftCorner(active, active);
      const Eigen::Index psi = layout.at(at);
      K.block<3, 3>(psi, psi) += 0.5 * w * point.R * K_bt.asDiagonal() * point.R.transpose();
      K.middleRows<3>(psi) += 0.5 * w * (hat(point.m).transpose() * phi[j]);  // rows of psi
      for (std::size_t e = 0; e < layout.strains.size(); ++e) {
        const Eigen::Index i = psi + 3 + static_cast<Eigen::Index>(e);
        K(i, i) += 0.5 * w * K_se[layout.strains[e]];
      }
      if (!field.tendons.empty()) {
        // tendons are one more law of the section
        const MatX by = strain_changes(field, layout, at);
        K.block(psi, psi, layout.per_point, layout.per_point) +=
            0.5 * w * by.transpose() * field.tendons[at] * by;
        out.held.middleCols(psi, layout.per_point) += w * field.locked[at].transpose() * by;
      }
      if (!field.magnetic.empty()) {
        MatX moved(6, active);
        moved << phi[j], d;
        K.noalias() += 0.5 * w * moved.transpose() * field.magnetic[at] * moved;
      }
      const Mat3 outer = point.tau * point.n.transpose();
      const Mat3 B = 0.5 * (outer + outer.transpose()) - point.n.dot(point.tau) * Mat3::Identity();
      const auto row = 3 * static_cast<Eigen::Index>(j);
      phi_all.middleRows<3>(row) = phi[j];
      half_all.middleRows<3>(row) = w * (0.5 * B * phi[j] + hat(point.n) * d_s[j]);
      d_all.middleRows<3>(row) = d;
      dw_all.middleRows<3>(row) = (w * rhoA) * d;
      if (added_mass > 0) {
        const Vec3 t = point.R.col(2);
        dw_all.middleRows<3>(row) += (w * added_mass) * (d - t * (t.transpose() * d));
      }
      if (rotary) {
        const Rows3 spin = point.R.transpose() * phi[j];
        const Rows3 weighted = w * rhoJ.asDiagonal() * spin;
        out.M.topLeftCorner(active, active).noalias() += spin.transpose() * weighted;
      }
    }
    out.K.topLeftCorner(active, active).noalias() += phi_all.transpose() * half_all;
    out.M.topLeftCorner(active, active).noalias() += d_all.transpose() * dw_all;
    for (std::size_t k = 0; k < S; ++k) {
      node.d.leftCols(active) += h * table.b[k] * d_s[k];
      node.phi.middleCols<3>(layout.at(c * S + k)).diagonal().array() += h * table.b[k];
    }
    for (const FieldDisk& disk : field.disks) {
      if (disk.cells != c + 1) continue;
      const Rows3 d = node.d.leftCols(active);
      out.M.topLeftCorner(active, active).noalias() += disk.mass * (d.transpose() * d);
      if (!rotary) continue;
      const Rows3 spin = disk.R.transpose() * node.phi.leftCols(active);
      out.M.topLeftCorner(active, active).noalias() +=
          spin.transpose() * disk.J.asDiagonal() * spin;
    }
    const Eigen::Index row = 6 * static_cast<Eigen::Index>(c + 1);
    out.nodes.middleRows<3>(row) = node.phi;
    out.nodes.middleRows<3>(row + 3) = node.d;
  }
  out.K += MatX(out.K.transpose());
  out.tip.resize(6, n);
  out.tip << node.phi, node.d;
  return out;
}

}  // namespace cprsim
