// SPDX-License-Identifier: BSD-3-Clause
// The project's own source files, as text, for tests that read rather than run them.
#pragma once

#include <string>
#include <vector>

namespace cprsim {

struct SourceFile {
  std::string path;                // relative to the root, with '/'
  std::vector<std::string> lines;  // without line ends

  std::string folder() const;
  std::string extension() const;  // with the dot; "CMakeLists.txt" as ".cmake"

  bool is_cpp() const { return extension() == ".cpp"; }

  bool is_header() const { return extension() == ".h"; }
};

/// All code, scripts and build files below engine, scenes, collision, render, tools, tests and the
/// root's CMakeLists.txt, sorted by path.
const std::vector<SourceFile>& source_tree();

/// One #include of a file.
struct Include {
  std::string target;
  bool quoted = false;  // "…", otherwise <…>
  int line = 0;
};

std::vector<Include> includes_of(const SourceFile& file);

/// "path:line", as editors like it.
std::string at(const SourceFile& file, std::size_t line_index);

}  // namespace cprsim
