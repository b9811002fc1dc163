// SPDX-License-Identifier: BSD-3-Clause
// A made-up run without an engine: one body on a parabola, one straight rod.
#pragma once

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"

namespace cprsim {

Channel synthetic_channel(const std::string& name, const std::string& unit, ChannelEntity entity,
                          Quantity quantity, int component = 0);

Channel height();

Channel iterations();

double height_at(double t);

Snapshot synthetic_state(double t);

/// Duration 0.4 s, with the body and the rod of synthetic_state().
Scene synthetic_scene();

/// Steps of 0.04 s from 0 to the end, so that most instants lie within steps.
template <typename Observer>
void play(Observer& observer, double end = 0.4) {
  Snapshot before = synthetic_state(0);
  observer.begin(before);
  for (int k = 1; 0.04 * k <= end + 1e-9; ++k) {
    const Snapshot now = synthetic_state(0.04 * k);
    observer.step(before, now);
    before = now;
  }
}

}  // namespace cprsim
