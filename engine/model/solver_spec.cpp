// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/solver_spec.h"

namespace cprsim {

const char* method_name(Method method) {
  for (const MethodWord& each : kMethodWords)
    if (each.method == method) return each.word;
  return "";
}

}  // namespace cprsim
