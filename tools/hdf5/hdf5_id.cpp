// SPDX-License-Identifier: BSD-3-Clause
#include "tools/hdf5/hdf5_id.h"

#include <hdf5.h>

namespace cprsim {

namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t), "HDF5 1.10 or later");

/// Of a stack of complaints the one that names a failed system call, else the innermost.
herr_t look_at(unsigned, const H5E_error2_t* complaint, void* result) {
  auto& text = *static_cast<std::string*>(result);
  const std::string desc = complaint->desc != nullptr ? complaint->desc : "";
  const std::string mark = "error message = '";
  const std::size_t at = desc.find(mark);
  if (at != std::string::npos) {
    const std::size_t begin = at + mark.size();
    text = desc.substr(begin, desc.find('\'', begin) - begin);
    return 1;
  }
  if (text.empty()) text = desc;
  return 0;
}

[[noreturn]] void fail() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look_at, &text);
  H5Eclear2(H5E_DEFAULT);
  throw Hdf5Error(text.empty() ? "HDF5 gives no reason" : text);
}

}  // namespace

Hdf5Id::Hdf5Id(std::int64_t id) : id_(id) {
  if (id < 0) fail();
}

Hdf5Id::~Hdf5Id() {
  if (id_ >= 0) H5Idec_ref(id_);
}

void Hdf5Id::close() {
  if (H5Idec_ref(std::exchange(id_, -1)) < 0) fail();
}

int checked(int status) {
  if (status < 0) fail();
  return status;
}

std::string hdf5_library_version() {
  unsigned major = 0, minor = 0, release = 0;
  checked(H5get_libversion(&major, &minor, &release));
  return std::to_string(major) + '.' + std::to_string(minor) + '.' + std::to_string(release);
}

void start_hdf5() {
  // its last rites would complain about a file that could not be written
  H5dont_atexit();
  checked(H5open());
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace cprsim
