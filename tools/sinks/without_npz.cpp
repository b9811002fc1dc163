// SPDX-License-Identifier: BSD-3-Clause
// In the place of npz_writer.cpp where minizip is not installed.
#include "tools/sinks/array_writer.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

std::unique_ptr<ArrayWriter> make_npz_writer(const std::filesystem::path& path, const Scene&) {
  throw OutputError("cannot write " + path.string() +
                    ": this cprsim was built without minizip; install libminizip-dev and build "
                    "again, or take <csv/>");
}

bool writes_npz() {
  return false;
}

}  // namespace cprsim
