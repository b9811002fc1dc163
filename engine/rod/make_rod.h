// SPDX-License-Identifier: BSD-3-Clause
// From a rod of the scene to a discretised one: the only place that knows all methods. A new method
// adds its files and a case in make_rod.cpp.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/model/rod_spec.h"
#include "engine/model/solver_spec.h"
#include "engine/rod/rod_model.h"
#include "engine/section/along.h"
#include "engine/section/section.h"
#include "engine/section/tendon.h"

namespace cprsim {

/// Everything that any discretisation is made from.
struct RodPlan {
  const RodSpec* spec = nullptr;
  Pose X_WBase, X_WTip;       ///< joint frames; of the tip only if it is held
  std::optional<Mat3> plane;  ///< of a planar scene: e1, e2 and the normal as columns, world
  SectionProperties section;  ///< of the base, if they vary
  std::shared_ptr<const SectionsAlong> along;  ///< null: the same all along
  double length = 0;
  double limpness = 0;  ///< w L³ / EI of a rod whose both ends are held; 0 without gravity
  bool extension = false, shear = false;  ///< effects that change the law
  bool rotary_inertia = false, damping = false, drag = false;
  bool line_loads = false;       ///< whether anything is spread along it: loads, magnets
  bool magnetic = false;         ///< whether the rod's magnets count
  bool touches = false;          ///< whether it may touch something
  bool tied = false;             ///< to another rod, at stations
  std::vector<double> stations;  ///< s / L of point loads, then of breaks: tendons, lines, disks
  std::vector<Tendon> tendons;
  const SolverSpec* solver = nullptr;  ///< resolution, accuracy
};

/// Unloaded, from its base frame.
/// @throws std::invalid_argument for what the method cannot do.
std::unique_ptr<RodModel> make_rod(Method method, const RodPlan& plan);

}  // namespace cprsim
