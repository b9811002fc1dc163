// SPDX-License-Identifier: BSD-3-Clause
#include "engine/run/continuous_drives.h"

#include <algorithm>

namespace cprsim {
namespace {

void make_continuous(ProfileTerm& term, double duration) {
  if (term.shape == ShapeOfTime::kStep) {
    term.shape = ShapeOfTime::kRamp;
    term.end = term.start + duration;
    return;
  }
  if (term.shape != ShapeOfTime::kKeyframes || term.interpolation != Interpolation::kStep) return;
  std::vector<double> times, values;
  for (std::size_t i = 0; i < term.times.size(); ++i) {
    if (i > 0 && term.values[i] != term.values[i - 1]) {
      times.push_back(term.times[i]);
      values.push_back(term.values[i - 1]);
      // the next key may come sooner than the jump is done
      const bool last = i + 1 == term.times.size();
      const double room = last ? duration : 0.5 * (term.times[i + 1] - term.times[i]);
      times.push_back(term.times[i] + std::min(duration, room));
    } else {
      times.push_back(term.times[i]);
    }
    values.push_back(term.values[i]);
  }
  term.times = std::move(times);
  term.values = std::move(values);
  term.interpolation = Interpolation::kLinear;
  finish_keyframes(term);
}

}  // namespace

Scene with_continuous_drives(Scene scene) {
  if (scene.simulation.mode != Mode::kDynamic) return scene;
  for (DriveSpec& drive : scene.drives) {
    if (drive.quantity != DriveQuantity::kPosition && drive.quantity != DriveQuantity::kLength &&
        drive.quantity != DriveQuantity::kDisplacement)
      continue;
    for (ProfileTerm& term : drive.profile.terms)
      make_continuous(term, scene.max_step_size);
  }
  return scene;
}

}  // namespace cprsim
