// SPDX-License-Identifier: BSD-3-Clause
// One <match> of a scene: the run as a trajectory, held against that of a file.
#pragma once

#include <optional>

#include "engine/model/scene.h"
#include "engine/run/observe.h"
#include "tools/series/comparison.h"

namespace cprsim {

/// Channels of a run as a series: at chosen instants, looked at within steps as the film does.
class SeriesRecorder {
 public:
  /// @param instants increasing, s
  SeriesRecorder(const Scene& scene, const std::vector<Channel>& channels,
                 std::vector<double> instants);

  void begin(const Snapshot& start);
  void step(const Snapshot& before, const Snapshot& now);
  void visit(Archive& archive);

  /// What was seen so far.
  const Series& series() const { return series_; }

 private:
  void record(const Snapshot& snapshot);

  ChannelReader reader_;
  std::vector<double> instants_;
  std::size_t next_ = 0;
  Series series_;
};

class TrajectoryMatch {
 public:
  /// @throws TableError, PairingError if the file is no trajectory of this quantity
  TrajectoryMatch(const Scene& scene, const Expectation& expected);

  void begin(const Snapshot& start) { recorder_.begin(start); }

  void step(const Snapshot& before, const Snapshot& now) { recorder_.step(before, now); }

  void visit(Archive& archive) { recorder_.visit(archive); }

  /// Nothing while the run and the reference have no instant in common.
  std::optional<QuantityComparison> compare() const;

  /// Last instant of the reference that the scene, run to its end, covers.
  double last_instant() const { return last_instant_; }

 private:
  const Expectation* expected_;
  Series reference_;
  QuantityPair pair_;
  double last_instant_ = 0;
  SeriesRecorder recorder_;
};

}  // namespace cprsim
