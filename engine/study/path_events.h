// SPDX-License-Identifier: BSD-3-Clause
// Events between two neighbouring points of a path.
#pragma once

#include <vector>

#include "engine/study/path.h"

namespace cprsim {

/// Judges a station. Stiffnesses that cannot be told from zero keep the sign they had at `before`
/// (none: positive), so that a neutral motion makes no events.
PathPoint judged_point(StaticStudy& study, PathStation& at, const PathStation* before);

/// Events between two judged stations, in the order of the path. Where several things happen, the
/// way is halved.
std::vector<PathEvent> events_between(PathSystem& system, const PathStation& from,
                                      const PathStation& to);

}  // namespace cprsim
