// SPDX-License-Identifier: BSD-3-Clause
// In the place of hdf5_series.cpp where the library is not installed.
#include "tools/series/hdf5_series.h"
#include "tools/series/measured_table.h"

namespace cprsim {

Series read_hdf5_series(const std::string& path) {
  throw TableError(path +
                   ": this cprsim was built without HDF5; install libhdf5-dev and build again");
}

}  // namespace cprsim
