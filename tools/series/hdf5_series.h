// SPDX-License-Identifier: BSD-3-Clause
// Trajectories from HDF5 files: an array `time`, and in the group `channels` arrays of the same
// length, each with its unit in the attribute `units`.
#pragma once

#include <string>

#include "tools/series/series.h"

namespace cprsim {

/// .h5, .hdf5
bool is_hdf5(const std::string& path);

/// @throws TableError
Series read_hdf5_series(const std::string& path);

}  // namespace cprsim
