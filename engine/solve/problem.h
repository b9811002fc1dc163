// SPDX-License-Identifier: BSD-3-Clause
// What a solver sees: rows that are to vanish, a Newton direction, and two dials that make a
// problem easier. It knows no robot. Every row is dimensionless.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace cprsim {

struct ProblemResidual {
  double merit = 0;    ///< half the sum of squared rows
  double largest = 0;  ///< largest row
  bool finite = true;
};

class Problem {
 public:
  virtual ~Problem() = default;

  /// Rows at the current unknowns.
  virtual ProblemResidual evaluate() = 0;

  /// Linearises at the point of the last evaluate() and finds the Newton direction; with mu > 0 the
  /// Levenberg-Marquardt direction instead. @return false if the linear system is singular or not
  /// finite.
  virtual bool find_direction(double mu) = 0;

  /// What the merit would be at the end of the last direction, were the rows linear: 0 for mu = 0.
  virtual double predicted_merit() const = 0;

  virtual void keep() = 0;              ///< remembers the unknowns
  virtual void move(double alpha) = 0;  ///< remembered unknowns plus alpha times the direction

  virtual void mark() = 0;  ///< remembers the unknowns for longer: the watchdog's way back
  virtual void return_to_mark() = 0;

  virtual void remember() = 0;  ///< the unknowns, for as long as a ladder's rung lasts
  virtual void recall() = 0;

  /// Fraction of loads applied and of initial assembly gaps closed; 1 is the problem itself.
  virtual void set_fraction(double fraction) = 0;
  /// Drag towards the unknowns at the time of the call, in units of the robot's own stiffness; 0 is
  /// none.
  virtual void set_relaxation(double drag) = 0;
  /// Extra softness where stiffness makes the start hard, in the problem's own units; 0 is the
  /// problem itself.
  virtual void set_softness(double softness) = 0;
  virtual bool wants_soft_start() const = 0;  ///< parts must first be brought together
  /// Leaves a start from which symmetry keeps every step.
  virtual void break_symmetry() = 0;
  /// Back to the unknowns the scene starts from.
  virtual void restart() = 0;

  /// Parts, unloaded, that can be brought to their places each by itself; what they have come to
  /// is where the problem goes on from put_together().
  virtual std::vector<std::unique_ptr<Problem>> take_apart() { return {}; }

  virtual void put_together() {}

  virtual std::string worst_row() const = 0;
  virtual double growth() const = 0;
  virtual long section_evaluations() const = 0;
  /// What was computed so far, in section evaluations or what costs as much: a measure that is the
  /// same on every machine.
  virtual long work() const = 0;
  virtual long factorizations() const = 0;
};

}  // namespace cprsim
