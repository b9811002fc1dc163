// SPDX-License-Identifier: BSD-3-Clause
// Where energy comes from and goes: kinetic, elastic and potential energy of everything, the work
// of loads (trapezoidal in the displacement, which is exact for dead loads), of magnetic fields and
// temperatures that change (trapezoidal in the change) and of the other drives (their power, by the
// time scheme's own quadrature), and what damping has taken out.
#pragma once

#include <vector>

#include "engine/math/archive.h"
#include "engine/robot/free_bodies.h"
#include "engine/robot/robot.h"
#include "engine/run/snapshot.h"

namespace cprsim {

class EnergyLedger {
 public:
  EnergyLedger(const Robot& robot, const FreeBodies* free_bodies)
      : robot_(robot), free_bodies_(free_bodies) {}

  /// The balance counts from here.
  void open();

  /// Loads as they are from t on: after a jump they differ from what close_step saw.
  void begin_step(double t);

  /// Whether a prescribed speed jumped where the step began.
  bool speeds_jumped() const;

  /// What a step that ends at t has exchanged, J: taken out by damping, put in by drives.
  /// @param cushioned what is lost besides counts as taken by an impact
  void close_step(double t, double damping_loss, double drive_work, bool cushioned = false);

  /// Power that damping takes out now, W.
  double damping_power() const;

  /// Power that drives of joints and of rod lengths put in at time t in the present state, W.
  double drive_power(double t, bool before) const;

  /// Work of effort drives since begin_step, trapezoidal in the displacement: for quasi-statics,
  /// where nothing has a rate.
  double effort_work(double t) const;

  const EnergySample& sample() const { return sample_; }

  /// Between steps.
  void visit(Archive& archive);

 private:
  struct Point {
    Vec3 force, moment, position;
    Mat3 rotation;
  };

  /// A jump of a prescribed speed at the beginning of a step.
  struct Jump {
    double half = 0;    ///< half of it, m/s or rad/s
    double effort = 0;  ///< of the drive before it
  };

  void collect(double t, bool before);
  void collect_lines(const RobotRod& rod, double t, bool before);
  void collect_current(const RobotRod& rod);
  double exerted(const JointDrive& drive, double rate) const;
  void note_jumps(double t);
  double friction_energy() const;
  void sum_up();

  const Robot& robot_;
  const FreeBodies* free_bodies_;
  std::vector<Point> points_, points_before_;
  EnergySample sample_;
  double joint_effort(const JointDrive& drive, double t, bool before) const;

  std::vector<std::vector<TendonSample>> tendons_now(double t, bool before) const;

  /// What tendons have exchanged since begin_step, trapezoidal in the displacement: where nothing
  /// has a rate.
  struct TendonWork {
    double motors = 0;    ///< put in
    double friction = 0;  ///< taken out
  };

  TendonWork tendon_work(double t) const;

  /// Whether a tendon's motor has a power: it prescribes how fast it pulls.
  bool displaces(const RobotTendon& tendon) const {
    return tendon.drive && tendon.drive->quantity == DriveQuantity::kDisplacement &&
           robot_.scene->simulation.mode == Mode::kDynamic;
  }

  double pulling_power(const RobotRod& rod, double t, bool before) const;

  /// What a rod's energy depends on beside its state, and its derivatives by that.
  struct OnCourse {
    Vec4 strain = Vec4::Zero(), effort = Vec4::Zero();  ///< heat's part; by it
    std::vector<double> strengths, energies;  ///< of magnetic fields: factors, energies at 1
  };

  std::vector<OnCourse> course_now(double t, bool before) const;
  void note_course(double t);
  double course_work(double t) const;

  std::vector<Vec3> friction_before_, q_before_;           ///< of joints
  std::vector<std::vector<TendonSample>> tendons_before_;  ///< of rods
  std::vector<Jump> jumps_;                                ///< of joint drives
  std::vector<OnCourse> course_before_;                    ///< of rods
  double jump_work_ = 0;                                   ///< where the step began
  double begun_ = 0;
  double friction_energy_before_ = 0;
  double start_ = 0;
  double free_energy_ = 0;
  bool free_energy_known_ = false;
};

}  // namespace cprsim
