// SPDX-License-Identifier: BSD-3-Clause
// A number that a hard case measures, and the most it may be: checked here, and left in the test's
// record, from which page.py makes docs/stability.md, method by method.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "engine/model/scene.h"

namespace cprsim {

/// The scene, its rods solved by the method that the environment names in CPRSIM_TEST_METHOD, if
/// any, as finely as is usual. Where the test asks for cells there are as many elements of splines
/// instead, or polynomials of degree 12.
inline Scene by_method(Scene scene) {
  constexpr int kFineOrder = 12;
  const char* word = std::getenv("CPRSIM_TEST_METHOD");
  if (word == nullptr) return scene;
  SolverSpec& solver = scene.solver;
  for (const MethodWord& known : kMethodWords)
    if (std::string(known.word) == word) solver.method = known.method;
  if (solver.method == Method::kShooting || !solver.points) return scene;
  if (solver.method == Method::kStrain)
    solver.order = kFineOrder;
  else
    solver.elements = solver.points;
  solver.points.reset();
  solver.integrator.reset();
  return scene;
}

inline void measure(const std::string& what, double value, double limit) {
  EXPECT_LE(value, limit) << what;
  char text[64];
  std::snprintf(text, sizeof text, "%.2g %.2g", value, limit);
  ::testing::Test::RecordProperty(what, text);
}

}  // namespace cprsim
