// SPDX-License-Identifier: BSD-3-Clause
// Shared by the planar kernels, which are compiled for several vector widths: in the including
// file's anonymous namespace, as engine/section/small_vector.h.
#pragma once

#include "engine/rod/planar_cell.h"

namespace cprsim {
namespace {  // NOLINT: on purpose, see above

// A Runge-Kutta table times the cell's length.
template <int S>
struct Steps {
  double a[S][S], b[S];

  explicit Steps(const PlanarModel& M) {
    for (int j = 0; j < S; ++j) {
      b[j] = M.h * M.table->b[j];
      for (int k = 0; k < S; ++k)
        a[j][k] = M.h * M.table->a[j][k];
    }
  }
};

}  // namespace
}  // namespace cprsim
