// SPDX-License-Identifier: BSD-3-Clause
// The catalogue of hard cases is complete and names tests that exist.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace cprsim {
namespace {

namespace fs = std::filesystem;

struct Row {
  std::string name, tests;
};

std::vector<Row> catalogue() {
  std::ifstream file(CPRSIM_SOURCE_DIR "/tests/stability/catalogue.txt");
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream parts(line);
    std::string name, asks, tests;
    std::getline(parts, name, '|');
    std::getline(parts, asks, '|');
    std::getline(parts, tests);
    rows.push_back({name.substr(0, name.find(' ')), tests});
  }
  return rows;
}

/// "(Suite, Test)" of every TEST, TEST_F, TEST_P in the tree, one after the other.
std::string all_tests() {
  std::string all;
  for (const auto& entry : fs::recursive_directory_iterator(CPRSIM_SOURCE_DIR "/tests")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);)
      if (line.rfind("TEST", 0) == 0) all += line.substr(line.find('('), line.find(')')) + "\n";
  }
  return all;
}

TEST(Catalogue, HasEveryRowOnce) {
  const std::vector<Row> rows = catalogue();
  std::size_t next = 0;
  for (const auto& [letter, count] : {std::pair('N', 28), std::pair('I', 14), std::pair('S', 6)})
    for (int i = 1; i <= count; ++i, ++next) {
      ASSERT_LT(next, rows.size()) << letter << i;
      EXPECT_EQ(rows[next].name, letter + std::to_string(i));
    }
  EXPECT_EQ(next, rows.size());
}

TEST(Catalogue, NamesTestsThatExist) {
  const std::string all = all_tests();
  for (const Row& row : catalogue()) {
    if (row.tests.find(" -") == 0) continue;
    std::istringstream tests(row.tests);
    for (std::string test; std::getline(tests, test, ',');) {
      const std::size_t colon = test.find(':'), dot = test.find('.');
      ASSERT_NE(colon, std::string::npos) << row.name;
      ASSERT_NE(dot, std::string::npos) << row.name;
      std::string name = test.substr(dot + 1, test.find('/') - dot - 1);
      while (!name.empty() && name.back() == ' ')
        name.pop_back();
      const std::string suite = test.substr(colon + 1, dot - colon - 1);
      const std::string wanted = "(" + suite + ", " + (name == "*" ? "" : name + ")");
      EXPECT_NE(all.find(wanted), std::string::npos) << row.name << " " << wanted;
    }
  }
}

}  // namespace
}  // namespace cprsim
