// SPDX-License-Identifier: BSD-3-Clause
// What a robot reaches: many equilibria, each from the scene alone, of drives given or of poses
// wanted, and what is to be known of each of them.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/study/inverse.h"
#include "engine/study/stability.h"
#include "engine/study/static_study.h"

namespace cprsim {

/// One number that is varied: a drive's value, or a freedom of the frame.
struct WorkspaceAxis {
  std::string name;  ///< of the drive, or x, y, z, roll, pitch, yaw
  std::string unit;  ///< m, rad, N, N m
  double low = 0, high = 0;
  int count = 11;    ///< values in a grid, ends included; 1: the middle
  int drive = -1;    ///< index into the scene's drives, or
  int freedom = -1;  ///< 0 to 5: x, y, z, roll, pitch, yaw
};

/// A freedom of the frame that is not varied when poses are wanted.
struct HeldFreedom {
  bool held = false;         ///< else what follows from the others
  std::optional<double> at;  ///< else where the scene's own equilibrium has it
};

struct WorkspaceQuestion {
  std::vector<WorkspaceAxis> axes;
  FrameRef frame;      ///< whose pose is told, and wanted if `poses`
  bool poses = false;  ///< the axes are freedoms of the frame; all drives are free to reach them
  std::array<HeldFreedom, 6> others;
  /// Allowed |effort| per drive of the scene, beside the limits of its joints.
  std::vector<double> max_effort;
};

/// Where a point's equilibrium came from.
enum class PointOrigin {
  kNone,     ///< there is none
  kForward,  ///< solved from the scene alone, see WorkspacePoint::stage
  kInverse   ///< followed from the scene's own equilibrium to the pose
};

struct WorkspacePoint {
  std::size_t index = 0;
  std::vector<double> asked;  ///< one number per axis
  PointOrigin origin = PointOrigin::kNone;
  std::string why;  ///< a sentence if there is no equilibrium
  SolveStage stage = SolveStage::kNewton;
  int iterations = 0;   ///< of Newton's method over all rungs; of the inverse problem: its own
  double residual = 0;  ///< largest scaled row of the equilibrium, dimensionless
  StabilityVerdict verdict = StabilityVerdict::kStable;
  int unstable = 0;                     ///< directions
  std::vector<double> drives, efforts;  ///< per drive of the scene: value, and what it must exert
  std::vector<std::string> broken;      ///< names of limits that are not kept
  bool positions_kept = true, efforts_kept = true;
  Vec3 position = Vec3::Zero(), angles = Vec3::Zero();  ///< of the frame; roll, pitch, yaw

  bool reached() const { return origin != PointOrigin::kNone; }
};

/// Every combination of the axes' values, the last axis fastest.
std::vector<std::vector<double>> grid_points(const std::vector<WorkspaceAxis>& axes);

/// Evenly distributed in the box; the same numbers for a seed on every machine.
std::vector<std::vector<double>> random_points(const std::vector<WorkspaceAxis>& axes,
                                               std::size_t count, unsigned seed);

/// What each drive of the scene must exert, N or N m: on its joint beside springs; to feed a rod,
/// the derivative of energy by the length fed (so that a bent rod pushes its guide, too).
std::vector<double> drive_efforts(const StaticStudy& study);

/// Answers for one point after another. An answer depends on scene, question and point alone, not
/// on the points before it.
class WorkspaceSolver {
 public:
  /// @throws std::invalid_argument for a scene that cannot be simulated
  WorkspaceSolver(const Scene& scene, const WorkspaceQuestion& question);

  WorkspacePoint solve(std::size_t index, const std::vector<double>& asked);

 private:
  void forward(WorkspacePoint& point);
  void inverse(WorkspacePoint& point);
  void tell(WorkspacePoint& point);
  void check_limits(WorkspacePoint& point) const;

  WorkspaceQuestion question_;
  StaticStudy study_;
  StaticStudy::State home_;
  SolveReport at_home_;  ///< if poses are wanted
  Vec6 home_pose_ = Vec6::Zero();
};

/// Solves the points of the given indices on `jobs` threads. `done` is called for each point, by
/// one thread at a time, in any order; no new point is begun once `stop` says so.
void solve_points(const Scene& scene, const WorkspaceQuestion& question,
                  const std::vector<std::vector<double>>& points,
                  const std::vector<std::size_t>& indices, int jobs,
                  const std::function<void(const WorkspacePoint&)>& done,
                  const std::function<bool()>& stop);

}  // namespace cprsim
