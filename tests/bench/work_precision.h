// SPDX-License-Identifier: BSD-3-Clause
// Accuracy against time for the released rod: what is run, what is found, and how it is written
// down.
#pragma once

#include <string>
#include <vector>

#include "engine/model/solver_spec.h"

namespace cprsim {

/// One way of solving the released rod.
struct Setting {
  SchemeKind scheme = SchemeKind::kEsdirk32;
  double alpha = -0.4;   ///< bdf_alpha
  double step = 0;       ///< s, or 0: adaptive
  double tolerance = 0;  ///< adaptive: relative local error
  int cells = 6;

  std::string scheme_name() const;  ///< as in a scene, with its parameter
};

struct Outcome {
  Setting setting;
  double error = 0;          ///< largest tip error at the ends of steps, m
  double error_between = 0;  ///< the same within steps, where the film and the CSV look, m
  double error_later = 0;    ///< at the ends of steps after the first 50 ms, m
  double cpu_seconds = 0;    ///< build, static start and all steps; best of the repetitions
  long steps = 0, retried = 0, iterations = 0, section_evaluations = 0;
  std::string failure;  ///< empty: done

  double worst() const { return error > error_between ? error : error_between; }
};

/// How well the reference trajectory itself is known.
struct ReferenceFacts {
  double tolerance = 0, coarser_tolerance = 0;
  int cells = 0, fewer_cells = 0;
  double to_independent_tip = 0;    ///< m, at 1 s, from an independent solution
  double to_coarser_tolerance = 0;  ///< m, largest over the second
  double to_fewer_cells = 0;        ///< m, largest over the second
};

struct Study {
  ReferenceFacts reference;
  std::vector<Outcome> outcomes;
};

/// Writes released_rod.csv and released_rod.md into the folder.
/// Throws std::runtime_error if that cannot be done.
void write_study(const Study& study, const std::string& folder);

}  // namespace cprsim
