// SPDX-License-Identifier: BSD-3-Clause
// Picks the copy of the cell kernel that suits the machine; every copy gives the same bits.
#include "engine/rod/cell.h"

namespace cprsim {

const CellKernel& cell_kernel_baseline(int stages, CellLaw law);
#ifdef CPRSIM_X86_KERNELS
const CellKernel& cell_kernel_avx2(int stages, CellLaw law);
const CellKernel& cell_kernel_avx512(int stages, CellLaw law);
#endif

const CellKernel& cell_kernel(int stages, CellLaw law) {
#ifdef CPRSIM_X86_KERNELS
  // fluids and tendons have no copy of this width: it gains a fifth and takes time to compile
  const bool plain = !immersed(law) && !has_tendons(law);
  if (plain && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
    return cell_kernel_avx512(stages, law);
  if (__builtin_cpu_supports("avx2")) return cell_kernel_avx2(stages, law);
#endif
  return cell_kernel_baseline(stages, law);
}

}  // namespace cprsim
