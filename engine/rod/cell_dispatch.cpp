// SPDX-License-Identifier: BSD-3-Clause
// Picks the copy of the cell kernel that suits the machine; every copy gives the same bits.
#include "engine/rod/cell.h"

namespace cprsim {

const CellKernel& cell_kernel_baseline(int stages, CellLaw law);
const CellKernel& unloaded_kernel_baseline(int stages, bool extensible);
#ifdef CPRSIM_X86_KERNELS
const CellKernel& cell_kernel_avx2(int stages, CellLaw law);
const CellKernel& cell_kernel_avx512(int stages, CellLaw law);
const CellKernel& unloaded_kernel_avx2(int stages, bool extensible);
const CellKernel& unloaded_kernel_avx512(int stages, bool extensible);
#endif

namespace {

const CellKernel& unloaded_kernel(int stages, bool extensible) {
#ifdef CPRSIM_X86_KERNELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
    return unloaded_kernel_avx512(stages, extensible);
  if (__builtin_cpu_supports("avx2")) return unloaded_kernel_avx2(stages, extensible);
#endif
  return unloaded_kernel_baseline(stages, extensible);
}

}  // namespace

const char* law_name(CellLaw law) {
  switch (law) {
    case CellLaw::kKirchhoff:
      return "inextensible";
    case CellLaw::kExtensibleStatic:
      return "extensible, at rest";
    case CellLaw::kExtensible:
      return "extensible";
    case CellLaw::kKirchhoffGeneral:
      return "inextensible, varying or with rotary inertia";
    case CellLaw::kExtensibleGeneral:
      return "extensible, varying or with rotary inertia";
    case CellLaw::kKirchhoffFluid:
      return "inextensible, with what surrounds it";
    case CellLaw::kExtensibleFluid:
      return "extensible, with what surrounds it";
    case CellLaw::kTendons:
      return "with tendons";
    case CellLaw::kTendonsFluid:
      return "with tendons and what surrounds it";
    case CellLaw::kUnloaded:
      return "inextensible, unloaded";
    case CellLaw::kUnloadedExtensible:
      return "extensible, unloaded";
  }
  return "";
}

const CellKernel& cell_kernel(int stages, CellLaw law) {
  if (is_unloaded(law)) return unloaded_kernel(stages, law == CellLaw::kUnloadedExtensible);
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
