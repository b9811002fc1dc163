// SPDX-License-Identifier: BSD-3-Clause
// In the place of hdf5_series.cpp where the library is not installed.
#include "tools/series/hdf5_series.h"
#include "tools/series/measured_table.h"
#include "tools/series/recorded_states.h"

namespace cprsim {

namespace {

[[noreturn]] void refuse(const std::string& path) {
  throw TableError(path +
                   ": this cprsim was built without HDF5; install libhdf5-dev and build again");
}

}  // namespace

Series read_hdf5_series(const std::string& path) {
  refuse(path);
}

struct RecordedStates::File {};

RecordedStates::RecordedStates(const std::string& path, const Scene& scene) : scene_(scene) {
  refuse(path);
}

RecordedStates::~RecordedStates() = default;

Snapshot RecordedStates::at(std::size_t) const {
  return {};
}

}  // namespace cprsim
