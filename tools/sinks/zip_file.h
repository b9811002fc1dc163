// SPDX-License-Identifier: BSD-3-Clause
// A ZIP archive of stored members without a date, written from front to back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace cprsim {

class ZipFile {
 public:
  /// Creates path.part. @throws OutputError, as do all members
  explicit ZipFile(std::filesystem::path path);
  ~ZipFile();
  ZipFile(const ZipFile&) = delete;
  ZipFile& operator=(const ZipFile&) = delete;

  /// @param bytes  that write() will bring, at most
  void begin_member(const std::string& name, std::uint64_t bytes);
  void write(std::string_view data);
  void end_member();

  /// Completes the archive and gives it its name.
  void commit();

 private:
  void check(int status) const;

  std::filesystem::path path_, part_;
  void* zip_ = nullptr;  ///< minizip's zipFile
};

}  // namespace cprsim
