// SPDX-License-Identifier: BSD-3-Clause
// A made-up run without an engine: one body on a parabola, one straight rod.
#pragma once

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"

namespace cprsim {

inline Channel synthetic_channel(const std::string& name, const std::string& unit,
                                 ChannelEntity entity, Quantity quantity, int component = 0) {
  Channel channel;
  channel.name = name;
  channel.unit = unit;
  channel.entity = entity;
  channel.index = 0;
  channel.quantity = quantity;
  channel.component = component;
  return channel;
}

inline Channel height() {
  return synthetic_channel("ball.position.z", "m", ChannelEntity::kBody, Quantity::kPosition, 2);
}

inline Channel iterations() {
  return synthetic_channel("solver.iterations", "1", ChannelEntity::kSolver,
                           Quantity::kSolverIterations);
}

inline double height_at(double t) {
  return 1 + 2 * t - 5 * t * t;
}

inline Snapshot synthetic_state(double t) {
  Snapshot state;
  state.time = t;
  BodySample body;
  body.X_WB.p = Vec3(0, 0, height_at(t));
  body.linear_velocity = Vec3(0, 0, 2 - 10 * t);
  state.bodies.push_back(body);
  RodSample rod;
  rod.length = 0.5;
  rod.radius = 0.01;
  for (int i = 0; i <= 4; ++i) {
    RodPoint point;
    point.s = 0.25 * i;
    point.position = Vec3(t, 0, rod.length * point.s);
    point.moment = Vec3(0, point.s, 0);
    rod.points.push_back(point);
  }
  state.rods.push_back(rod);
  state.solver.iterations = 3;
  state.energy.kinetic = 2;
  state.energy.work = t;
  state.energy.balance = -1e-3 * t;
  return state;
}

/// Duration 0.4 s, with the body and the rod of synthetic_state().
inline Scene synthetic_scene() {
  Scene scene;
  scene.name = "synthetic";
  scene.files = {"synthetic.xml"};
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.duration = 0.4;
  scene.bodies.emplace_back().name = "ball";
  scene.rods.emplace_back().name = "rod";
  return scene;
}

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
