// SPDX-License-Identifier: BSD-3-Clause
#include "engine/solve/phase_clock.h"

namespace cprsim {

const char* to_string(Phase phase) {
  switch (phase) {
    case Phase::kSections:
      return "sections";
    case Phase::kElimination:
      return "elimination";
    case Phase::kSystem:
      return "system";
    case Phase::kContact:
      return "contact";
    case Phase::kFreeBodies:
      return "free_bodies";
    case Phase::kObservation:
      return "observation";
    case Phase::kRecording:
      return "recording";
    case Phase::kPictures:
      break;
  }
  return "pictures";
}

void PhaseClock::add(Phase phase, Time begin, Time end) {
  Sum& sum = sums_[static_cast<std::size_t>(phase)];
  sum.seconds += std::chrono::duration<double>(end - begin).count();
  ++sum.count;
  if (listener_) listener_(phase, since(begin), since(end));
}

}  // namespace cprsim
