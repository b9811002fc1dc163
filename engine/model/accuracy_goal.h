// SPDX-License-Identifier: BSD-3-Clause
// What an <accuracy> is about, where it is not distances in metres.
#pragma once

#include <string>
#include <vector>

#include "engine/model/channel.h"

namespace cprsim {

struct AccuracyGoal {
  double error = 0;       ///< asked for
  bool relative = false;  ///< to the largest value in the run; of distances to the longest rod
  std::string of;         ///< as the scene names its channels; empty: distances
  std::vector<Channel> channels;
};

}  // namespace cprsim
