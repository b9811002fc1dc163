// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/planar.h"

namespace cprsim {

RodField PlanarRod::field() const {
  RodField f;
  f.table = table_;
  for (std::size_t c = 0; c < static_cast<std::size_t>(cells_); ++c)
    f.cells.push_back((grid_[c + 1] - grid_[c]) * forcing_.length);
  const auto rotation = [&](double c, double s) -> Mat3 {
    Mat3 turn = Mat3::Identity();
    turn.topLeftCorner<2, 2>() << c, -s, s, c;
    return plane_ * turn * offset_;
  };
  const auto in_world = [&](const double* v) -> Vec3 { return plane_ * Vec3(v[0], v[1], 0); };
  for (const PlanarStage& stage : stages_)
    f.points.push_back({rotation(stage.c, stage.s), in_world(stage.tau), in_world(stage.n),
                        stage.m * plane_.col(2)});
  if (tendons_) describe_tendons(f);
  for (std::size_t j = 0; around_ && around_->in_space().field() && j < stages_.size(); ++j) {
    const std::size_t cell = j / static_cast<std::size_t>(table_->stages);
    f.magnetic.push_back(
        around_->outer_stiffness(0.5 * (grid_[cell] + grid_[cell + 1]), stages_[j]));
  }
  const auto end_state = [&](const PlanarNode& node) {
    NodeState state{};
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(state.R) = rotation(node.c, node.s);
    Eigen::Map<Vec3>(state.p) = plane_ * Vec3(node.p[0], node.p[1], height_);
    Eigen::Map<Vec3>(state.n) = in_world(node.n);
    Eigen::Map<Vec3>(state.m) = node.m * plane_.col(2);
    return state;
  };
  for (std::size_t d = 0; d < disks_.size(); ++d) {
    const PlanarNode& node = nodes_[disks_[d].node];
    f.disks.push_back({disks_[d].node, disks_[d].mass, disk_inertia(options_.disks[d]),
                       rotation(node.c, node.s)});
  }
  f.base = end_state(starts_.front());
  f.tip = end_state(nodes_.back());
  f.sections = sections_;
  describe_section(f, section_, options_.shear, options_.extension);
  return f;
}

}  // namespace cprsim
