// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/spool.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

[[noreturn]] void fail_in(const char* doing, const std::filesystem::path& folder) {
  throw OutputError(std::string("cannot ") + doing + " a temporary file in " + folder.string() +
                    ": " + std::strerror(errno));
}

/// A file that nobody else sees; some file systems have to be shown a name first.
int open_nameless(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return descriptor;
  std::string name = (folder / "spool-XXXXXX").string();
  const int named = ::mkstemp(name.data());
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

}  // namespace

Spool::Spool(const std::filesystem::path& folder, std::vector<std::size_t> widths,
             std::size_t block_rows)
    : folder_(folder), widths_(std::move(widths)), block_rows_(block_rows) {
  for (const std::size_t width : widths_) {
    before_.push_back(row_bytes_);
    row_bytes_ += width;
  }
  descriptor_ = open_nameless(folder.empty() ? "." : folder);
  if (descriptor_ < 0) fail_in("create", folder_);
}

Spool::~Spool() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void Spool::append(std::size_t rows, const std::vector<const void*>& data) {
  for (std::size_t i = 0; i < widths_.size(); ++i) {
    const char* from = static_cast<const char*>(data[i]);
    std::uint64_t at = rows_ * row_bytes_ + before_[i] * rows;
    for (std::size_t left = widths_[i] * rows; left > 0;) {
      const ssize_t written = ::pwrite(descriptor_, from, left, static_cast<off_t>(at));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail_in("write", folder_);
      from += written;
      at += static_cast<std::uint64_t>(written);
      left -= static_cast<std::size_t>(written);
    }
  }
  rows_ += rows;
}

std::size_t Spool::read(std::size_t array, std::uint64_t position, void* to,
                        std::size_t most) const {
  const std::uint64_t piece = static_cast<std::uint64_t>(widths_[array]) * block_rows_;
  if (position >= bytes(array)) return 0;
  const std::uint64_t block = position / piece, within = position % piece;
  const std::uint64_t rows = std::min<std::uint64_t>(block_rows_, rows_ - block * block_rows_);
  const std::uint64_t at = block * block_rows_ * row_bytes_ + before_[array] * rows + within;
  const std::uint64_t size = std::min<std::uint64_t>(most, rows * widths_[array] - within);
  for (;;) {
    const ssize_t got =
        ::pread(descriptor_, to, static_cast<std::size_t>(size), static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail_in("read", folder_);
    return static_cast<std::size_t>(got);
  }
}

}  // namespace cprsim
