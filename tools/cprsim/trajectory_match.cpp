// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/trajectory_match.h"

#include <algorithm>

#include "tools/series/pairing.h"
#include "tools/series/read_series.h"

namespace cprsim {

namespace {

/// Of a step, within which an instant counts as its end (times are sums of rounded steps).
constexpr double kRoundOff = 1e-9;

/// With a lag taken out the run is looked at between the reference's instants, too.
std::vector<double> instants_of(const Scene& scene, const Expectation& expected,
                                const Series& reference) {
  constexpr int kFine = 10000;
  const double end = scene.simulation.mode == Mode::kStatic ? 0 : scene.simulation.duration;
  std::vector<double> instants = reference.time;
  if (expected.take_lag_out)
    for (int i = 0; i <= kFine; ++i)
      instants.push_back(end * i / kFine);
  std::sort(instants.begin(), instants.end());
  instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
  return instants;
}

Series empty_series(const std::vector<Channel>& channels) {
  Series series;
  series.path = "the run";
  for (const Channel& channel : channels)
    series.columns.push_back({channel.name, channel.unit, {}});
  return series;
}

}  // namespace

SeriesRecorder::SeriesRecorder(const Scene& scene, const std::vector<Channel>& channels,
                               std::vector<double> instants)
    : reader_(scene, channels), instants_(std::move(instants)), series_(empty_series(channels)) {}

void SeriesRecorder::record(const Snapshot& snapshot) {
  const std::vector<double>& values = reader_.read(snapshot);
  series_.time.push_back(snapshot.time);
  for (std::size_t i = 0; i < values.size(); ++i)
    series_.columns[i].values.push_back(values[i]);
}

void SeriesRecorder::begin(const Snapshot& start) {
  while (next_ < instants_.size() && instants_[next_] < start.time)
    ++next_;
  if (next_ == instants_.size() || instants_[next_] > start.time) return;
  ++next_;
  record(start);
}

void SeriesRecorder::step(const Snapshot& before, const Snapshot& now) {
  const double slack = kRoundOff * (now.time - before.time);
  for (; next_ < instants_.size() && instants_[next_] <= now.time + slack; ++next_) {
    Snapshot between = interpolate(before, now, std::min(instants_[next_], now.time));
    between.time = instants_[next_];
    record(between);
  }
}

void SeriesRecorder::visit(Archive& archive) {
  reader_.visit(archive);
  archive(next_);
  const std::size_t seen = archive.count(series_.time.size(), instants_.size());
  series_.time.resize(seen);
  archive.doubles(series_.time);
  for (SeriesColumn& column : series_.columns) {
    column.values.resize(seen);
    archive.doubles(column.values);
  }
}

TrajectoryMatch::TrajectoryMatch(const Scene& scene, const Expectation& expected)
    : expected_(&expected),
      reference_(read_series(expected.reference)),
      recorder_(scene, expected.channels, instants_of(scene, expected, reference_)) {
  const SeriesQuantity quantity = quantities_of(recorder_.series()).front();
  const SeriesQuantity* found = nullptr;
  const auto theirs = quantities_of(reference_);
  for (const SeriesQuantity& candidate : theirs)
    if (counterpart({quantity}, candidate) != nullptr && found == nullptr) found = &candidate;
  if (found == nullptr) {
    throw PairingError(expected.reference + ": no column belongs to " + quantity.name +
                       "; its columns are to be called so, or like its end");
  }
  pair_ = {quantity, *found};
  convert_units(reference_, pair_, recorder_.series(), {});
  const double end = scene.simulation.mode == Mode::kStatic ? 0 : scene.simulation.duration;
  for (const double t : reference_.time)
    if (t <= end * (1 + kRoundOff)) last_instant_ = t;
}

std::optional<QuantityComparison> TrajectoryMatch::compare() const {
  const Series& run = recorder_.series();
  if (run.time.empty()) return std::nullopt;
  double shift = 0;
  if (expected_->take_lag_out)
    if (const auto lag = estimate_lag(run, reference_, {pair_})) shift = lag->seconds;
  QuantityComparison comparison =
      compare_quantity(run, pair_.quantity, reference_, pair_.reference, shift);
  if (comparison.time.empty()) return std::nullopt;
  return comparison;
}

}  // namespace cprsim
