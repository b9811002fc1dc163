// SPDX-License-Identifier: BSD-3-Clause
// Contacts along a rod of splines: loads between its pieces (engine/rod/nodal_contacts.h).
#include <algorithm>

#include "engine/rod/collocation.h"

namespace cprsim {

void CollocationRod::update_touch_nodes() {
  touch_nodes_.resize(touch_grid_.size());
  for (std::size_t k = 0; k < touch_nodes_.size(); ++k)
    touch_nodes_[k] = state_of(control_[control_at(k)]);
}

// As ShootingRod::contact_scale().
ContactScale CollocationRod::scale_of_contacts() const {
  const double weight = section_.weighing_mass() * forcing_.gravity.norm() * scale_.length;
  return {scale_.length, std::max(scale_.force, weight),
          rates_.dynamic() ? rates_.c_v * scale_.length : scale_.length,
          options_.extension ? 0 : scale_.length / elements_ / section_.K_se.z()};
}

NodalContacts::ByForces CollocationRod::contact_loads(std::size_t node) const {
  // before a node's load and beyond it the section is the same
  return touch_->load_by_forces(node, rotation_of(Vec4(control_[control_at(node)].head<4>())));
}

// Rows of the base and of the joins, by the forces.
void CollocationRod::assemble_contacts(const ConditionRows& base_rows) {
  const int d = static_cast<int>(space_.freedoms()), forces = force_columns();
  const auto put_in = [&](int row, const MatX& by_forces) {
    for (int r = 0; r < by_forces.rows(); ++r)
      for (int c = 0; c < forces; ++c)
        system_.dense(row + r, affine() + 1 + c) = by_forces(r, c);
  };
  put_in(0, base_rows.by_state.rightCols<6>() * contact_loads(0));
  int row = d + 1;
  for (std::size_t g = 0; g < pieces_.size(); ++g) {
    if (g > 0) {
      // of the section before, which the rows of the join make the one beyond
      const std::size_t before = control_at(g) - 1;
      MatX by_fields = MatX::Zero(13, forces);
      by_fields.bottomRows<6>() =
          touch_->load_by_forces(g, rotation_of(Vec4(control_[before].head<4>())));
      put_in(row, rows_ * by_fields);
      row += width();
    }
    row += width() * pieces_[g].points;
  }
}

void CollocationRod::describe_contacts(TensionPorts* tensions) {
  // the base's increment is zeta_A's dense column only where it moves
  MatX w = MatX::Zero(given(), last_.cols());
  w.rightCols(given()).setIdentity();
  const MatX x = system_.substitute(last_, w);
  const Vec13 units = increment_units();
  std::vector<MatX> moves(touch_nodes_.size());
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(control_at(k)) * width();
    moves[k] =
        (units.asDiagonal() * MatX(increments_ * x.middleRows(at, width()))).middleRows<6>(1);
  }
  touch_->describe_motions(moves, tensions ? &tensions->motions : nullptr);
}

}  // namespace cprsim
