// SPDX-License-Identifier: BSD-3-Clause
// bad/CODE_what.xml must give exactly that code, at a known place, and nothing else: no cascades.
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> bad_scenes() {
  std::vector<fs::path> paths;
  for (const auto& entry :
       fs::directory_iterator(std::string(CPRSIM_SOURCE_DIR) + "/tests/scenes/bad"))
    if (entry.path().extension() == ".xml") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string text_of(const fs::path& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(BadScenes, GiveTheCodeInTheirNameAndNoOther) {
  int count = 0;
  for (const fs::path& path : bad_scenes()) {
    const std::string name = path.filename().string(), code = name.substr(0, 4);
    const LoadResult result = load_scene(path.string());
    if (name == "valid.xml") {
      EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
      continue;
    }
    ++count;
    if (code[0] == 'E') {
      EXPECT_FALSE(result.scene) << name;
      EXPECT_EQ(error_codes(result), std::vector<std::string>{code}) << name << "\n"
                                                                     << to_text(result.diagnostics);
    } else {
      EXPECT_TRUE(result.scene) << name << "\n" << to_text(result.diagnostics);
      EXPECT_TRUE(has_code(result, code)) << name << "\n" << to_text(result.diagnostics);
    }
  }
  EXPECT_GT(count, 70);
}

TEST(BadScenes, AreComplainedAboutAtALine) {
  for (const fs::path& path : bad_scenes()) {
    const std::string name = path.filename().string();
    if (name.substr(0, 4) == "E104") continue;
    for (const Diagnostic& d : load_scene(path.string()).diagnostics) {
      EXPECT_GT(d.line, 0) << name << ": " << d.message;
      EXPECT_EQ(d.file, path.string()) << name;
      EXPECT_FALSE(explain_code(d.code).empty()) << d.code;
    }
  }
}

// What a loader's code means is shown by a scene in bad/; the others are named where they are
// tested.
TEST(Codes, HaveATestEach) {
  std::string tested;
  for (const fs::path& path : bad_scenes())
    tested += path.filename().string() + "\n";
  for (const auto& entry :
       fs::recursive_directory_iterator(std::string(CPRSIM_SOURCE_DIR) + "/tests"))
    if (entry.path().extension() == ".cpp") tested += text_of(entry.path());
  EXPECT_GT(diagnostic_codes().size(), 80u);
  for (const CodeEntry& entry : diagnostic_codes())
    EXPECT_NE(tested.find(entry.code), std::string::npos) << entry.code;
}

TEST(ShippedScenes, LoadWithoutErrorsOrWarnings) {
  const auto scenes = shipped_scenes();
  EXPECT_GE(scenes.size(), 6u);
  for (const fs::path& path : scenes) {
    const LoadResult result = load_scene(path.string());
    EXPECT_TRUE(result.scene || !result.expected_failure.empty()) << path << "\n"
                                                                  << to_text(result.diagnostics);
    for (const Diagnostic& d : result.diagnostics)
      EXPECT_EQ(d.severity, Severity::kNote) << path << "\n" << to_text(d);
  }
}

}  // namespace
}  // namespace cprsim
