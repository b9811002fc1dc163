// SPDX-License-Identifier: BSD-3-Clause
// Every discretisation of a rod, for tests that hold for all of them.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "engine/model/scene.h"

namespace cprsim {

inline constexpr Method kEveryMethod[] = {Method::kShooting, Method::kStrain, Method::kCollocation};

/// The name of a test that is done with each.
inline std::string test_name(const ::testing::TestParamInfo<Method>& of) {
  return method_name(of.param);
}

/// The scene with rods cut so finely, by this method, that 1e-9 of their length is left of errors
/// where they bend by a few radians.
inline Scene finely(Scene scene, Method method) {
  scene.solver.method = method;
  if (method == Method::kShooting) scene.solver.points = 30;
  if (method == Method::kStrain) {
    scene.solver.order = 8;
    scene.solver.elements = 2;
  }
  if (method == Method::kCollocation) {
    scene.solver.degree = 8;
    scene.solver.elements = 24;
  }
  return scene;
}

}  // namespace cprsim
