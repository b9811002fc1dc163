// SPDX-License-Identifier: BSD-3-Clause
// Picks the copy of the planar kernel that suits the machine; every copy gives the same bits.
#include "engine/rod/planar_cell.h"

namespace cprsim {

const PlanarKernel& planar_kernel_baseline(int stages, CellLaw law);
#ifdef CPRSIM_X86_KERNELS
const PlanarKernel& planar_kernel_avx2(int stages, CellLaw law);
const PlanarKernel& planar_kernel_avx512(int stages, CellLaw law);
#endif

const PlanarKernel& planar_kernel(int stages, CellLaw law) {
#ifdef CPRSIM_X86_KERNELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
    return planar_kernel_avx512(stages, law);
  if (__builtin_cpu_supports("avx2")) return planar_kernel_avx2(stages, law);
#endif
  return planar_kernel_baseline(stages, law);
}

}  // namespace cprsim
