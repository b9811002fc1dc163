// SPDX-License-Identifier: BSD-3-Clause
// mistakes.txt: each is told once, with its code, at its line and column. warnings.txt: what a
// scene is told that is loaded all the same.
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

struct Mistake {
  std::string code, line;
  std::string text;  ///< of the scene
  int at_line = 0, at_column = 0;
};

/// Takes the mark out and remembers where it stood.
void take_mark(Mistake& mistake) {
  const std::size_t at = mistake.text.find('@');
  ASSERT_NE(at, std::string::npos) << mistake.line;
  mistake.text.erase(at, 1);
  const auto here = mistake.text.begin() + static_cast<std::ptrdiff_t>(at);
  mistake.at_line = 1 + static_cast<int>(std::count(mistake.text.begin(), here, '\n'));
  const std::size_t before = mistake.text.rfind('\n', at - 1);
  mistake.at_column = static_cast<int>(at - before);
}

std::vector<Mistake> mistakes(const std::string& name) {
  std::ifstream file(std::string(CPRSIM_SOURCE_DIR) + "/tests/scenes/" + name);
  std::vector<Mistake> all;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    Mistake mistake{line.substr(0, 4), line, {}};
    const std::string rest = line.substr(5);
    if (rest.starts_with("model ")) {
      mistake.text = scene_text(rest.substr(6) + "\n");
    } else if (rest.starts_with("world ")) {
      mistake.text = scene_text("", rest.substr(6) + "\n");
    } else {
      const std::string words = "instead of ";
      const std::size_t arrow = rest.find(" => ");
      const std::string from = rest.substr(words.size(), arrow - words.size());
      mistake.text = scene_text();
      const std::size_t at = mistake.text.find(from);
      EXPECT_TRUE(arrow != std::string::npos && at != std::string::npos) << line;
      if (at != std::string::npos) mistake.text.replace(at, from.size(), rest.substr(arrow + 4));
    }
    take_mark(mistake);
    all.push_back(mistake);
  }
  return all;
}

TEST(Mistakes, AreToldOnceWithCodeLineAndColumn) {
  const std::vector<Mistake> all = mistakes("mistakes.txt");
  EXPECT_GT(all.size(), 220U);
  for (const Mistake& mistake : all) {
    const LoadResult result = load_text(mistake.text);
    EXPECT_FALSE(result.scene) << mistake.line;
    EXPECT_EQ(error_codes(result), std::vector<std::string>{mistake.code}) << mistake.line;
    const Diagnostic* first = nullptr;
    for (const Diagnostic& d : result.diagnostics)
      if (d.severity == Severity::kError && (first == nullptr || d.line == mistake.at_line))
        first = &d;
    if (first == nullptr) continue;
    EXPECT_EQ(first->line, mistake.at_line) << mistake.line << "\n" << to_text(*first);
    EXPECT_EQ(first->column, mistake.at_column) << mistake.line << "\n" << to_text(*first);
    EXPECT_FALSE(first->message.empty()) << mistake.line;
  }
}

TEST(Warnings, AreToldWithCodeLineAndColumnAndTheSceneIsLoaded) {
  const std::vector<Mistake> all = mistakes("warnings.txt");
  EXPECT_GE(all.size(), 14U);
  for (const Mistake& warning : all) {
    const LoadResult result = load_text(warning.text);
    EXPECT_TRUE(result.scene) << warning.line;
    int told = 0;
    for (const Diagnostic& d : result.diagnostics)
      if (d.code == warning.code && d.line == warning.at_line && d.column == warning.at_column)
        ++told;
    EXPECT_EQ(told, 1) << warning.line;
    // nor is it told where there is no reason
    EXPECT_FALSE(has_code(load_text(scene_text()), warning.code)) << warning.line;
  }
}

}  // namespace
}  // namespace cprsim
