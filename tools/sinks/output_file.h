// SPDX-License-Identifier: BSD-3-Clause
// A file that has its name only once it is complete: written as name.part, then synced and renamed.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cprsim {

/// A full disk, a closed pipe, a folder that may not be written: exit code 5.
class OutputError : public std::runtime_error {
 public:
  explicit OutputError(const std::string& what, const char* code = "E701")
      : std::runtime_error(what), code_(code) {}

  /// As `cprsim explain` knows it.
  const char* code() const { return code_; }

 private:
  const char* code_;
};

class OutputFile {
 public:
  /// Creates path.part. @throws OutputError, as do all members.
  explicit OutputFile(std::filesystem::path path);
  /// Without commit() the .part file stays, with all blocks that were flushed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Buffers; a full block goes to disk.
  void write(std::string_view text);
  void flush();
  /// Flushes; what was written is then on the disk.
  void sync();
  /// Flushes, syncs and gives the file its name.
  void commit();
  /// The same, but leaves it to the system when the disk gets it: complete for every reader, also
  /// after this process is killed, though perhaps not after a power cut.
  void commit_unsynced();

  const std::filesystem::path& path() const { return path_; }

 private:
  void close_descriptor();

  std::filesystem::path path_, part_;
  std::string buffer_;
  int descriptor_ = -1;
};

/// What a file is called until it is complete.
std::filesystem::path part_of(const std::filesystem::path& path);

/// Gives a file that others wrote under the name of its part, and closed, its own name once it is
/// on the disk. @throws OutputError
void commit_part(const std::filesystem::path& path);

/// The whole of a small file at once.
void write_file(const std::filesystem::path& path, std::string_view text);

/// The same by commit_unsynced(), for files that are written many times a second.
void write_file_unsynced(const std::filesystem::path& path, std::string_view text);

/// A standard stream that the caller has closed is taken by /dev/null, unwritable: no file of ours
/// may get its number and then a message in its middle.
void claim_standard_streams();

/// Results go here. @throws OutputError when nobody reads them any more.
void write_to_stdout(std::string_view text);

/// Everything else goes here. That nobody reads it, or that its disk is full, stops no run.
void write_to_stderr(std::string_view text) noexcept;

}  // namespace cprsim
