// SPDX-License-Identifier: BSD-3-Clause
// minizip rather than libzip: it writes as it goes, under the name that it is given, and assimp has
// loaded it already, whereas libzip brings OpenSSL and 4 ms to every start of the program.
#include "tools/sinks/zip_file.h"

#include <minizip/zip.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

constexpr std::uint64_t kNeedsZip64 = 0xff000000;
constexpr uLong kUtf8 = 1u << 11;            ///< member names are UTF-8
constexpr uLong kDate = 1u << 21 | 1 << 16;  ///< 1980-01-01, the first that ZIP knows

}  // namespace

ZipFile::ZipFile(std::filesystem::path path) : path_(std::move(path)), part_(part_of(path_)) {
  errno = 0;
  zip_ = zipOpen64(part_.c_str(), APPEND_STATUS_CREATE);
  if (zip_ == nullptr)
    throw OutputError("cannot create " + part_.string() + ": " + std::strerror(errno));
}

ZipFile::~ZipFile() {
  if (zip_ != nullptr) zipClose(zip_, nullptr);
}

void ZipFile::begin_member(const std::string& name, std::uint64_t bytes) {
  zip_fileinfo info{};
  info.dosDate = kDate;
  errno = 0;
  check(zipOpenNewFileInZip4_64(zip_, name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, 0, 0, 0,
                                -MAX_WBITS, DEF_MEM_LEVEL, Z_DEFAULT_STRATEGY, nullptr, 0, 0, kUtf8,
                                bytes >= kNeedsZip64));
}

void ZipFile::write(std::string_view data) {
  errno = 0;
  check(zipWriteInFileInZip(zip_, data.data(), static_cast<unsigned>(data.size())));
}

void ZipFile::end_member() {
  errno = 0;
  check(zipCloseFileInZip(zip_));
}

void ZipFile::commit() {
  errno = 0;
  check(zipClose(std::exchange(zip_, nullptr), nullptr));
  commit_part(path_);
}

void ZipFile::check(int status) const {
  if (status == ZIP_OK) return;
  throw OutputError("cannot write " + part_.string() + ": " +
                    (errno != 0 ? std::strerror(errno) : "the archive cannot take it"));
}

}  // namespace cprsim
