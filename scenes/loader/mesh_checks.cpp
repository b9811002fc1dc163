// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/mesh_checks.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "scenes/loader/values.h"

namespace cprsim {

namespace {

constexpr std::size_t kMostNested = 500;  // assimp recurses; at 20,000 it runs out of stack

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    ++count;
  return count;
}

/// Deepest nesting of elements, counting every start tag that is not closed at once.
std::size_t element_depth(const std::string& text) {
  std::size_t depth = 0, deepest = 0;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const char next = at + 1 < text.size() ? text[at + 1] : '\0';
    if (next == '!' || next == '?') continue;
    if (next == '/') {
      if (depth > 0) --depth;
      continue;
    }
    const std::size_t end = text.find('>', at);
    if (end != std::string::npos && text[end - 1] == '/') continue;
    deepest = std::max(deepest, ++depth);
  }
  return deepest;
}

/// Whether all indices of a COLLADA file are numbers: assimp 5.2 reads one that is not for ever.
bool indices_are_numbers(const std::string& text) {
  for (const char* name : {"<p", "<vcount", "<v", "<ph", "<h"}) {
    const std::string tag = name;
    for (std::size_t at = text.find(tag); at != std::string::npos; at = text.find(tag, at + 1)) {
      const char next = at + tag.size() < text.size() ? text[at + tag.size()] : '\0';
      if (next != '>' && next != ' ' && next != '\t' && next != '\n' && next != '\r') continue;
      const std::size_t begin = text.find('>', at);
      if (begin == std::string::npos) return false;
      const std::size_t end = std::min(text.find('<', begin), text.size());
      if (text.find_first_not_of("+-0123456789 \t\r\n", begin + 1) < end) return false;
    }
  }
  return true;
}

/// Whether the file claims to hold more of something than it has bytes.
bool claims_too_much(const std::string& text) {
  const std::string word = "count=";
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t begin = std::min(at + word.size() + 1, text.size());  // past the quote
    std::size_t end = begin;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9')
      ++end;
    const auto claimed = parse_integer(text.substr(begin, end - begin));
    if (end - begin > 18 || (claimed && *claimed > static_cast<long long>(text.size())))
      return true;
  }
  return false;
}

}  // namespace

std::string refusal(const std::filesystem::path& path, const std::string& kind) {
  namespace fs = std::filesystem;
  std::error_code problem;
  if (!fs::is_regular_file(path, problem)) return "not a regular file";
  const auto size = fs::file_size(path, problem);
  if (problem) return "cannot be read: " + problem.message();
  if (size == 0) return "the file is empty";
  if (size > kLargestMeshFile) return "larger than 256 MiB";
  if (kind != "dae" && kind != "gltf" && kind != "glb") return "";
  std::ifstream in(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  if (kind == "dae") {
    if (text.find('\0') != std::string::npos) return "COLLADA must be UTF-8";
    if (element_depth(text) > kMostNested || count_of(text, "<instance_node") > kMostNested) {
      return "nodes nested deeper than " + std::to_string(kMostNested);
    }
    if (!indices_are_numbers(text)) return "an index is not a number";
    if (claims_too_much(text)) return "a count is larger than the file";
    return "";
  }
  // nodes name their children, possibly with escaped letters: a chain is no longer than their
  // number
  if (count_of(text, "\"children\"") + count_of(text, "\\u") > kMostNested) {
    return "more than " + std::to_string(kMostNested) + " nodes with children";
  }
  return "";
}

}  // namespace cprsim
