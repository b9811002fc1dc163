// SPDX-License-Identifier: BSD-3-Clause
// Picks the copy of the planar kernel that suits the machine; every copy gives the same bits.
#include "engine/rod/planar_cell.h"

namespace cprsim {

const PlanarKernel& planar_kernel_baseline(int stages, CellLaw law);
#ifdef CPRSIM_X86_KERNELS
const PlanarKernel& planar_kernel_avx2(int stages, CellLaw law);
const PlanarKernel& planar_kernel_avx512(int stages, CellLaw law);
#endif

int planar_kernel_copies() {
#ifdef CPRSIM_X86_KERNELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) return 3;
  if (__builtin_cpu_supports("avx2")) return 2;
#endif
  return 1;
}

PlanarKernel planar_kernel_copy([[maybe_unused]] int copy, int stages, CellLaw law) {
  const auto of = [&] {
#ifdef CPRSIM_X86_KERNELS
    if (copy == 2) return planar_kernel_avx512(stages, law);
    if (copy == 1) return planar_kernel_avx2(stages, law);
#endif
    return planar_kernel_baseline(stages, law);
  };
  PlanarKernel kernel = of();
  kernel.evaluate = planar_evaluate(stages, law);
  return kernel;
}

PlanarKernel planar_kernel(int stages, CellLaw law) {
  return planar_kernel_copy(planar_kernel_copies() - 1, stages, law);
}

}  // namespace cprsim
