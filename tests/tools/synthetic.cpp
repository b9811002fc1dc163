// SPDX-License-Identifier: BSD-3-Clause
#include "tests/tools/synthetic.h"

namespace cprsim {

Channel synthetic_channel(const std::string& name, const std::string& unit, ChannelEntity entity,
                          Quantity quantity, int component) {
  Channel channel;
  channel.name = name;
  channel.unit = unit;
  channel.entity = entity;
  channel.index = 0;
  channel.quantity = quantity;
  channel.component = component;
  return channel;
}

Channel height() {
  return synthetic_channel("ball.position.z", "m", ChannelEntity::kBody, Quantity::kPosition, 2);
}

Channel iterations() {
  return synthetic_channel("solver.iterations", "1", ChannelEntity::kSolver,
                           Quantity::kSolverIterations);
}

double height_at(double t) {
  return 1 + 2 * t - 5 * t * t;
}

Snapshot synthetic_state(double t) {
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

Scene synthetic_scene() {
  Scene scene;
  scene.name = "synthetic";
  scene.files = {"synthetic.xml"};
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.duration = 0.4;
  scene.bodies.emplace_back().name = "ball";
  scene.rods.emplace_back().name = "rod";
  return scene;
}

}  // namespace cprsim
