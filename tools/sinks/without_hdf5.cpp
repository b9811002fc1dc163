// SPDX-License-Identifier: BSD-3-Clause
// In the place of hdf5_writer.cpp where the library is not installed.
#include "tools/sinks/array_writer.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

std::unique_ptr<ArrayWriter> make_hdf5_writer(const std::filesystem::path& path, const Scene&) {
  throw OutputError("cannot write " + path.string() +
                    ": this cprsim was built without HDF5; install libhdf5-dev and build again, or "
                    "take <csv/>");
}

std::string hdf5_version() {
  return {};
}

}  // namespace cprsim
