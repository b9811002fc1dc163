// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/shooting.h"

namespace cprsim {

RodField ShootingRod::field() const {
  RodField f;
  f.table = table_;
  for (std::size_t c = 0; c < static_cast<std::size_t>(cells_); ++c)
    f.cells.push_back((grid_[c + 1] - grid_[c]) * forcing_.length);
  const auto vec = [](const double* x) { return Vec3(x[0], x[1], x[2]); };
  for (const CellStage& stage : stages_) {
    FieldPoint point;
    point.R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(stage.R);
    point.tau = vec(stage.tau);
    point.n = vec(stage.n);
    point.m = vec(stage.m);
    f.points.push_back(point);
  }
  for (std::size_t j = 0; tendons_ && j < stages_.size(); ++j)
    f.add_tendons(stiffness_of(tendons_->at(j)), tendons_->locked_at(j));
  for (std::size_t j = 0; fluid_.field() && j < stages_.size(); ++j) {
    const std::size_t cell = j / static_cast<std::size_t>(table_->stages);
    f.magnetic.push_back(fluid_.outer_stiffness(0.5 * (grid_[cell] + grid_[cell + 1]),
                                                   f.points[j].R, vec(stages_[j].p)));
  }
  f.base = starts_.front();
  f.tip = nodes_.back();
  f.sections = sections_;
  if (disks_) disks_->describe(1, f);
  describe_section(f, section_, options_.shear, options_.extension);
  return f;
}

}  // namespace cprsim
