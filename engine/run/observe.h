// SPDX-License-Identifier: BSD-3-Clause
// Numbers seen in a snapshot: the value of a channel, and a row of many channels over time.
#pragma once

#include <vector>

#include "engine/math/types.h"
#include "engine/model/channel.h"
#include "engine/run/snapshot.h"

namespace cprsim {

struct Scene;

/// The value of one channel at one instant. Quaternions are returned with w >= 0.
/// @throws std::invalid_argument if the entity has no such quantity.
double evaluate(const Channel& channel, const Scene& scene, const Snapshot& snapshot);

/// Reads the same channels again and again, keeping the sign of every quaternion continuous.
class ChannelReader {
 public:
  ChannelReader(const Scene& scene, std::vector<Channel> channels);

  const std::vector<Channel>& channels() const { return channels_; }

  /// One value per channel, in their order; valid until the next call.
  const std::vector<double>& read(const Snapshot& snapshot);

  void visit(Archive& archive) { archive.doubles(last_quaternions_); }

 private:
  const Scene* scene_;
  std::vector<Channel> channels_;
  std::vector<Vec4> last_quaternions_;  ///< x y z w per channel; zero before the first read
  std::vector<double> values_;
};

}  // namespace cprsim
