// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace cprsim {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = std::size_t{16} << 20;

// reads until the end or beyond the limit
FileContent drain(int descriptor) {
  FileContent content;
  char block[65536];
  for (;;) {
    const ssize_t got = ::read(descriptor, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return {{}, "E101", std::string("cannot be read: ") + std::strerror(errno)};
    if (got == 0) break;
    content.text.append(block, static_cast<std::size_t>(got));
    if (content.text.size() > kMostBytes) return {{}, "E103", "is larger than 16 MiB"};
  }
  if (content.text.empty()) return {{}, "E104", "is empty"};
  return content;
}

bool lies_below(const fs::path& path, const fs::path& root) {
  auto a = path.begin();
  for (auto b = root.begin(); b != root.end(); ++b, ++a) {
    if (b->empty()) continue;
    if (a == path.end() || *a != *b) return false;
  }
  return true;
}

std::string root_of(const fs::path& path, const std::vector<std::string>& roots) {
  for (const std::string& root : roots) {
    std::error_code error;
    const fs::path canonical = fs::canonical(root, error);
    if (!error && lies_below(path, canonical)) return canonical.string();
  }
  return {};
}

// where a uri may lie, in the order of trying
std::vector<fs::path> candidates(const std::string& uri, const std::string& folder,
                                 const std::vector<std::string>& roots) {
  std::vector<fs::path> list;
  const std::size_t scheme = uri.find("://");
  std::string rest = scheme == std::string::npos ? uri : uri.substr(scheme + 3);
  if (!rest.empty() && rest.front() == '/') return {fs::path(rest)};
  if (scheme == std::string::npos) list.push_back(fs::path(folder) / rest);
  for (const std::string& root : roots) {
    const fs::path place = fs::path(root) / rest;
    if (list.empty() || list.front() != place) list.push_back(place);
  }
  return list;
}

}  // namespace

FileContent read_file(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return {{}, "E101", std::strerror(errno)};

  struct stat status {};

  FileContent content;
  if (::fstat(descriptor, &status) != 0)
    content = {{}, "E101", std::strerror(errno)};
  else if (!S_ISREG(status.st_mode))
    content = {{}, "E102", S_ISDIR(status.st_mode) ? "is a directory" : "is not a regular file"};
  else if (static_cast<std::size_t>(status.st_size) > kMostBytes)
    content = {{}, "E103", "is larger than 16 MiB"};
  else
    content = drain(descriptor);
  ::close(descriptor);
  return content;
}

FileContent read_standard_input() {
  return drain(STDIN_FILENO);
}

FoundFile find_resource(const std::string& uri, const std::string& folder,
                        const std::vector<std::string>& roots, std::string_view wanted) {
  FoundFile found;
  const std::size_t scheme = uri.find("://");
  const std::string kind = scheme == std::string::npos ? std::string() : uri.substr(0, scheme);
  if (!kind.empty() && kind != "model" && kind != "package" && kind != "file") {
    found.code = "E107";
    found.message = "'" + uri + "' would need the network; only local files are used";
    return found;
  }
  for (fs::path candidate : candidates(uri, folder, roots)) {
    std::error_code error;
    if (!wanted.empty() && fs::is_directory(candidate, error)) candidate /= wanted;
    found.tried.push_back(candidate.string());
    const fs::path canonical = fs::canonical(candidate, error);
    if (error) continue;
    found.root = root_of(canonical, roots);
    if (!found.root.empty()) {
      found.path = canonical.string();
      return found;
    }
    found.code = "E107";
    found.message = "'" + uri + "' lies outside the scene's folder and the resource paths";
    return found;
  }
  found.code = "E106";
  found.message = "'" + uri + "' was not found";
  return found;
}

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

}  // namespace cprsim
