// SPDX-License-Identifier: BSD-3-Clause
// Rules of style that a machine can check.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/hygiene/source_tree.h"

namespace cprsim {
namespace {

constexpr std::size_t kLongestFile = 400;

bool is_code(const SourceFile& file) {
  return file.is_cpp() || file.is_header();
}

/// The text without line comments and string literals, in which words mean nothing.
std::string code_of(const std::string& line) {
  static const std::regex text(R"("([^"\\]|\\.)*")");
  const std::string bare = std::regex_replace(line, text, "\"\"");
  return bare.substr(0, bare.find("//"));
}

void expect_nowhere(const std::regex& pattern, const std::string& why) {
  for (const SourceFile& file : source_tree())
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      EXPECT_FALSE(std::regex_search(file.lines[i], pattern)) << at(file, i) << ": " << why;
}

TEST(Sources, AreFound) {
  EXPECT_GT(source_tree().size(), 50U);
}

TEST(Sources, NameTheirLicence) {
  // split so that this line is not itself found
  const std::string tag = std::string("SPDX-License") + "-Identifier: BSD-3-Clause";
  for (const SourceFile& file : source_tree()) {
    const std::size_t count = std::min<std::size_t>(file.lines.size(), 2);
    const auto end = file.lines.begin() + static_cast<std::ptrdiff_t>(count);
    EXPECT_TRUE(std::any_of(file.lines.begin(), end, [&](const std::string& line) {
      return line.find(tag) != std::string::npos;
    })) << file.path;
  }
}

TEST(Sources, AreShort) {
  for (const SourceFile& file : source_tree()) {
    EXPECT_LE(file.lines.size(), kLongestFile) << file.path;
  }
}

TEST(Sources, OpenNoNamespaceForAWholeFile) {
  for (const SourceFile& file : source_tree()) {
    if (!is_code(file)) continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      EXPECT_NE(file.lines[i].rfind("using namespace", 0), 0U) << at(file, i);
  }
}

// The cell kernel is compiled once per vector width, from headers whose every function is local to
// the compilation, which they say (see small_vector.h).
bool opens(const SourceFile& file, const std::string& space) {
  return std::any_of(file.lines.begin(), file.lines.end(),
                     [&](const std::string& line) { return line.rfind(space, 0) == 0; });
}

TEST(Sources, KeepToTheNamespaceOfTheProject) {
  for (const SourceFile& file : source_tree()) {
    if (!file.is_header()) continue;
    EXPECT_EQ(std::count(file.lines.begin(), file.lines.end(), "#pragma once"), 1) << file.path;
    EXPECT_TRUE(opens(file, "namespace cprsim") || opens(file, "namespace {  // NOLINT:"))
        << file.path;
  }
}

TEST(Sources, LeaveNothingForLater) {
  expect_nowhere(std::regex(std::string("\\b(TO") + "DO|FIX" + "ME|XX" + "X|HA" + "CK)\\b"),
                 "unfinished work belongs in an issue");
}

TEST(Sources, NameNoMachine) {
  // homes of people, this checkout and its neighbours, and where it was built
  expect_nowhere(std::regex(std::string("/ho") + "me/|/Us" + "ers/|/ro" + "ot/"),
                 "somebody's home");
  const std::filesystem::path root = CPRSIM_SOURCE_DIR;
  const std::string around = root.parent_path().generic_string();
  for (const std::string& place : {root.generic_string(), std::string(CPRSIM_BINARY_DIR), around}) {
    if (place.find('/', 1) == std::string::npos) continue;  // "/tmp" is a word of every machine
    const std::string literal =
        std::regex_replace(place, std::regex(R"([.^$|()\[\]{}*+?\\])"), "\\$&");
    expect_nowhere(std::regex("(^|[\\s\"'(=:])" + literal + "(/|$|[\\s\"'):])"), place);
  }
}

TEST(Sources, WriteToTheTerminalOnlyInTools) {
  for (const SourceFile& file : source_tree()) {
    if (!is_code(file) || file.path.rfind("tools/", 0) == 0 || file.path.rfind("tests/", 0) == 0)
      continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      EXPECT_FALSE(std::regex_search(code_of(file.lines[i]),
                                     std::regex(R"(std::c(out|err)\b|\bf?printf\()")))
          << at(file, i);
  }
}

/// What a header includes, itself or through other headers of the project.
void collect_includes(const std::string& path, std::set<std::string>& found) {
  const std::vector<SourceFile>& tree = source_tree();
  const auto file = std::find_if(tree.begin(), tree.end(),
                                 [&](const SourceFile& each) { return each.path == path; });
  if (file == tree.end()) return;
  for (const Include& include : includes_of(*file))
    if (found.insert(include.target).second && include.quoted)
      collect_includes(include.target, found);
}

TEST(Sources, HeadersIncludeTheStandardHeadersTheyNeed) {
  // the headers-alone build has Eigen precompiled, which brings some of these along
  const std::map<std::string, std::string> home{{"vector", "vector"},
                                                {"string", "string"},
                                                {"array", "array"},
                                                {"map", "map"},
                                                {"set", "set"},
                                                {"optional", "optional"},
                                                {"function", "functional"},
                                                {"unique_ptr", "memory"},
                                                {"string_view", "string_view"}};
  for (const SourceFile& file : source_tree()) {
    if (!file.is_header()) continue;
    std::set<std::string> included;
    collect_includes(file.path, included);
    for (const auto& [name, header] : home) {
      const std::regex use("std::" + name + "\\b");
      const bool used = std::any_of(
          file.lines.begin(), file.lines.end(),
          [&](const std::string& line) { return std::regex_search(code_of(line), use); });
      EXPECT_TRUE(!used || included.count(header) > 0)
          << file.path << " names std::" << name << " without <" << header << ">";
    }
  }
}

/// Whether a build file names a source, from its own folder or from the root.
bool lists(const SourceFile& build_file, const SourceFile& source) {
  const std::string from_folder =
      std::filesystem::path(source.path).lexically_relative(build_file.folder()).generic_string();
  return std::any_of(build_file.lines.begin(), build_file.lines.end(),
                     [&](const std::string& line) {
                       return line.find(from_folder) != std::string::npos ||
                              line.find("/" + source.path) != std::string::npos;
                     });
}

TEST(Sources, AreListedInABuildFile) {
  const std::vector<SourceFile>& tree = source_tree();
  for (const SourceFile& source : tree) {
    if (!source.is_cpp()) continue;
    EXPECT_TRUE(std::any_of(tree.begin(), tree.end(),
                            [&](const SourceFile& file) {
                              return file.extension() == ".cmake" && lists(file, source);
                            }))
        << source.path << " is in no CMakeLists.txt";
  }
}

TEST(Arithmetic, IsNotCompiledFast) {
  const std::string word = std::string("fast") + "-math|-O" + "fast|-funsafe" + "-math";
  for (const SourceFile& file : source_tree()) {
    if (file.extension() != ".cmake") continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      const std::string code = file.lines[i].substr(0, file.lines[i].find('#'));
      EXPECT_FALSE(std::regex_search(code, std::regex(word))) << at(file, i);
    }
  }
  std::ifstream commands(CPRSIM_BINARY_DIR "/compile_commands.json");
  for (std::string line; std::getline(commands, line);)
    EXPECT_FALSE(std::regex_search(line, std::regex(word))) << line;
}

TEST(Arithmetic, KnowsWhatIsNotANumber) {
  volatile double zero = 0;
  const double nan = zero / zero, infinite = 1 / zero;
  EXPECT_TRUE(std::isnan(nan));
  EXPECT_FALSE(std::isfinite(nan));
  EXPECT_FALSE(std::isfinite(infinite));
  EXPECT_FALSE(nan == nan);
}

TEST(Arithmetic, DoesNotContractProductsAndSums) {
  // fused, a b - a b would be the rounding error of the product
  volatile double a = 1 + std::numeric_limits<double>::epsilon(), b = a;
  const double x = a, y = b, rounded = x * y;
  volatile double product = rounded;
  EXPECT_EQ(x * y - product, 0);
}

}  // namespace
}  // namespace cprsim
