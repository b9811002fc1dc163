// SPDX-License-Identifier: BSD-3-Clause
// Robots that nobody designed: valid scenes from a number.
#pragma once

#include <cstdint>
#include <string>

namespace cprsim {

struct RandomRobot {
  std::string text;  ///< of the scene file
  std::string mode, method;
  int rods = 0;
  bool contact = false, adaptive = false;
};

/// 1 to 12 rods of radius 0.1 to 20 mm, 10 to 100,000 times as long, of 1 kPa to 400 GPa, between a
/// base and a plate or ending freely, with every joint of rods and of bodies, standing still,
/// driven slowly or moving in steps of 1e-5 to 5e-2 s, a third of them beside obstacles. The same
/// seed gives the same robot.
RandomRobot random_robot(std::uint64_t seed);

}  // namespace cprsim
