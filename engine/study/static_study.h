// SPDX-License-Identifier: BSD-3-Clause
// A robot at rest whose drives and loads are numbers that can be changed: what inverse problems,
// workspaces, continuation and identification solve again and again.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/robot/contacts.h"
#include "engine/robot/equations.h"
#include "engine/robot/robot.h"
#include "engine/run/snapshot.h"
#include "engine/solve/report.h"

namespace cprsim {

/// A number of the scene that a study may change: a drive's value, or one component of a load.
struct Parameter {
  enum class Kind { kDrive, kForce, kTorque } kind = Kind::kDrive;
  int index = 0;      ///< into Scene::drives or Scene::loads
  int component = 0;  ///< of a load: x, y, z
  std::string name;   ///< e.g. "robot::leg_1.length", "robot::motor.position"
  std::string unit;   ///< m, rad, N, N m
};

/// A wrench (moment, force) that a study adds to a link, world axes, at the frame's origin.
struct ProbeWrench {
  FrameRef at;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};

class StaticStudy {
 public:
  /// Every drive and load is held at its value at the time `at`: the left limit, as an initial
  /// equilibrium sees it. @param probes wrenches in addition to the scene's own.
  /// @param touching whether rods may touch something: solve() finds that equilibrium then, and
  /// nothing else is to be asked.
  /// @throws std::invalid_argument for a scene that the engine cannot simulate
  explicit StaticStudy(Scene scene, double at = 0, const std::vector<ProbeWrench>& probes = {},
                       bool touching = false);

  /// Whether rods or bodies may touch something.
  bool touches() const { return contacts_ && contacts_->any(); }

  const Scene& scene() const { return *scene_; }

  const Robot& robot() const { return *robot_; }

  /// One per drive of the scene, in its order.
  const std::vector<Parameter>& drives() const { return drives_; }

  /// The three forces, then the three torques of probe i.
  std::vector<Parameter> probe(std::size_t i) const;

  double value(const Parameter& parameter) const;
  /// Takes effect with the next solve.
  void set(const Parameter& parameter, double value);

  /// From the scene alone, as if just loaded.
  SolveReport solve();

  /// From the present shape. A change that is too far for Newton's method in one step is taken in
  /// smaller ones. On failure the last shape found, with its values, is restored.
  SolveReport follow();

  /// One Newton step from the present shape after parameters changed a little: where the solution
  /// moves, to second order in the change. The parameters stay changed.
  /// @return false if the equilibrium is singular
  bool step();

  /// Shape and parameter values, to return to.
  struct State {
    RobotUnknowns unknowns;
    std::vector<double> drives;
    std::vector<Vec3> forces, torques;  ///< of loads
  };

  State state() const;
  void restore(const State& state);
  /// Returns to an equilibrium found before; follow() goes on from there, whatever was solved
  /// since.
  void adopt(const State& equilibrium);

  /// The present shape and values, found in equilibrium by other means, are where follow() starts.
  void adopt();

  Snapshot snapshot() const;

  Equations& equations() { return *equations_; }

  double tolerance() const { return tolerance_; }

 private:
  void build();
  void prepare();
  SolveReport touch();
  SolveReport polish();

  std::unique_ptr<Scene> scene_;  // the robot points into it
  std::unique_ptr<Robot> robot_;
  std::unique_ptr<RodContacts> contacts_;  ///< where they are not refused
  std::unique_ptr<Equations> equations_;
  std::vector<Parameter> drives_;
  std::size_t first_probe_ = 0;
  double tolerance_;
  State solved_;
  bool has_solved_ = false, contacts_given_ = false;
};

}  // namespace cprsim
