// SPDX-License-Identifier: BSD-3-Clause
#include "tests/hygiene/source_tree.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

namespace cprsim {
namespace {

namespace fs = std::filesystem;

SourceFile read(const fs::path& root, const fs::path& path) {
  SourceFile file;
  file.path = fs::relative(path, root).generic_string();
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);)
    file.lines.push_back(line);
  return file;
}

std::vector<SourceFile> read_all() {
  const fs::path root = CPRSIM_SOURCE_DIR;
  const std::set<std::string> wanted{".cpp", ".h", ".cmake", ".sh", ".py", ".glsl"};
  std::vector<SourceFile> files{read(root, root / "CMakeLists.txt")};
  for (const char* folder : {"engine", "scenes", "collision", "render", "tools", "tests"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      const bool is_build_file = entry.path().filename() == "CMakeLists.txt";
      if (!entry.is_regular_file()) continue;
      if (is_build_file || wanted.count(entry.path().extension().string()) > 0)
        files.push_back(read(root, entry.path()));
    }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace

std::string SourceFile::folder() const {
  return fs::path(path).parent_path().generic_string();
}

std::string SourceFile::extension() const {
  if (fs::path(path).filename() == "CMakeLists.txt") return ".cmake";
  return fs::path(path).extension().string();
}

const std::vector<SourceFile>& source_tree() {
  static const std::vector<SourceFile> files = read_all();
  return files;
}

std::vector<Include> includes_of(const SourceFile& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  std::vector<Include> includes;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    std::smatch match;
    if (std::regex_match(file.lines[i], match, pattern))
      includes.push_back({match[2], match[1] == "\"", static_cast<int>(i) + 1});
  }
  return includes;
}

std::string at(const SourceFile& file, std::size_t line_index) {
  return file.path + ":" + std::to_string(line_index + 1);
}

}  // namespace cprsim
