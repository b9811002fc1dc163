// SPDX-License-Identifier: BSD-3-Clause
// The time schemes that are tested, and the order each has.
#pragma once

#include "engine/time/scheme.h"

namespace cprsim {

constexpr SchemeKind kAllSchemes[] = {SchemeKind::kBackwardEuler, SchemeKind::kBdf2,
                                      SchemeKind::kBdfAlpha,      SchemeKind::kGeneralizedAlpha,
                                      SchemeKind::kTrBdf2,        SchemeKind::kEsdirk32,
                                      SchemeKind::kEsdirk43,      SchemeKind::kRadau5};

inline int order_of(SchemeKind kind) {
  switch (kind) {
    case SchemeKind::kBackwardEuler:
      return 1;
    case SchemeKind::kEsdirk32:
      return 3;
    case SchemeKind::kEsdirk43:
      return 4;
    case SchemeKind::kRadau5:
      return 5;
    default:
      return 2;
  }
}

}  // namespace cprsim
