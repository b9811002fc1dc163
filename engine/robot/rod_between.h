// SPDX-License-Identifier: BSD-3-Clause
// A rod alone between two bodies that stay where they are. Of its two-port (engine/rod/rod_model.h)
// T z + t = 0 is left, so that whatever the other rods of a robot do cannot hold it up.
#pragma once

#include <string>

#include "engine/robot/robot.h"
#include "engine/solve/problem.h"

namespace cprsim {

/// What it costs to linearise and eliminate a rod, in evaluations of sections.
long direction_work(const RodModel& rod);

class RodBetween final : public Problem {
 public:
  /// @param whole       what the rod is a part of, whose work() counts
  /// @param eliminating where the work of eliminating it is added up
  /// @param rod         prepared for the instant; its model ends where the solver leaves it
  RodBetween(const Problem& whole, long& eliminating, const Robot& robot, RobotRod& rod,
             const StageRates& rates);

  ProblemResidual evaluate() override;
  bool find_direction(double mu) override;

  double predicted_merit() const override { return predicted_merit_; }

  void keep() override { rod_.model->keep(); }

  void move(double alpha) override { rod_.model->move(alpha); }

  void mark() override { mark_ = rod_.model->unknowns(); }

  void return_to_mark() override { rod_.model->set_unknowns(mark_); }

  void remember() override { remembered_ = rod_.model->unknowns(); }

  void recall() override { rod_.model->set_unknowns(remembered_); }

  void set_fraction(double fraction) override;
  void set_relaxation(double drag) override;
  void set_softness(double softness) override;

  bool wants_soft_start() const override { return true; }

  void break_symmetry() override { rod_.model->bow(base_, tip_); }

  void restart() override;

  std::string worst_row() const override { return rod_.model->row_name(worst_row_); }

  double growth() const override { return growth_; }

  long section_evaluations() const override { return rod_.model->section_evaluations(); }

  long work() const override { return whole_.work(); }

  long factorizations() const override { return factorizations_; }

 private:
  void prepare();

  const Problem& whole_;
  long& eliminating_;
  RobotRod& rod_;
  const StageRates& rates_;
  Port base_, tip_;
  Eigen::Index freedoms_;
  RodForcing forcing_;
  RodModel::Unknowns start_, mark_, remembered_;
  bool gap_captured_ = false;
  int worst_row_ = 0;
  long factorizations_ = 0;
  double growth_ = 0, predicted_merit_ = 0;
};

}  // namespace cprsim
