// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/solver_spec.h"

namespace cprsim {

const char* method_name(Method method) {
  switch (method) {
    case Method::kAuto:
      return "auto";
    case Method::kShooting:
      return "shooting";
    case Method::kStrain:
      return "strain";
    case Method::kCollocation:
      return "collocation";
  }
  return "";
}

}  // namespace cprsim
