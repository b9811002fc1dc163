// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace cprsim {

namespace {

constexpr std::size_t kBlock = 1 << 16;  ///< bytes lost at most when the process is killed

[[noreturn]] void fail(const std::string& doing, const std::filesystem::path& path) {
  throw OutputError("cannot " + doing + " " + path.string() + ": " + std::strerror(errno));
}

void write_all(int descriptor, std::string_view text, const std::filesystem::path& path) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write", path);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Makes the rename itself survive a power cut. Some file systems refuse; the file is complete
/// anyway.
void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

void rename_part_unsynced(const std::filesystem::path& part, const std::filesystem::path& path) {
  if (::rename(part.c_str(), path.c_str()) != 0) fail("rename to its final name", part);
}

/// The step from a whole part to the file.
void rename_part(const std::filesystem::path& part, const std::filesystem::path& path) {
  rename_part_unsynced(part, path);
  sync_folder(path.parent_path());
}

void sync_descriptor(int descriptor, const std::filesystem::path& path) {
  if (::fsync(descriptor) != 0 && errno != EINVAL && errno != EROFS) fail("write", path);
}

}  // namespace

std::filesystem::path part_of(const std::filesystem::path& path) {
  return path.string() + ".part";
}

void commit_part(const std::filesystem::path& path) {
  const std::filesystem::path part = part_of(path);
  const int descriptor = ::open(part.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail("open", part);
  try {
    sync_descriptor(descriptor, part);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  ::close(descriptor);
  rename_part(part, path);
}

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)), part_(part_of(path_)) {
  descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("create", part_);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::string_view text) {
  buffer_.append(text);
  if (buffer_.size() >= kBlock) flush();
}

void OutputFile::flush() {
  write_all(descriptor_, buffer_, part_);
  buffer_.clear();
}

void OutputFile::sync() {
  flush();
  sync_descriptor(descriptor_, part_);
}

void OutputFile::commit() {
  sync();
  close_descriptor();
  rename_part(part_, path_);
}

void OutputFile::commit_unsynced() {
  flush();
  close_descriptor();
  rename_part_unsynced(part_, path_);
}

void OutputFile::close_descriptor() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0) fail("write", part_);
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

void write_file_unsynced(const std::filesystem::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit_unsynced();
}

void claim_standard_streams() {
  // open() gives the lowest free number: the streams are filled in order
  int descriptor = ::open("/dev/null", O_RDONLY);
  while (descriptor >= 0 && descriptor <= STDERR_FILENO)
    descriptor = ::open("/dev/null", O_RDONLY);
  if (descriptor >= 0) ::close(descriptor);
}

void write_to_stdout(std::string_view text) {
  write_all(STDOUT_FILENO, text, "standard output");
}

void write_to_stderr(std::string_view text) noexcept {
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace cprsim
