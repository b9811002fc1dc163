// SPDX-License-Identifier: BSD-3-Clause
// The grammar for editors, the table of the loader and the shipped scenes say the same.
#include "scenes/loader/schema.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <regex>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

const std::string kSchema = std::string(CPRSIM_SOURCE_DIR) + "/scenes/schema/";

// names that follow `keyword` in the grammar, "element (a|b|c)" included
std::set<std::string> names_in_grammar(const std::string& keyword) {
  const std::string text =
      std::regex_replace(file_text(kSchema + "cprsim.rnc"), std::regex("#[^\n]*"), "");
  const std::regex pattern("\\b" + keyword + "\\s+(\\(([a-z0-9_|:]+)\\)|([a-z0-9_:]+))\\s*\\{");
  std::set<std::string> names;
  for (auto at = std::sregex_iterator(text.begin(), text.end(), pattern);
       at != std::sregex_iterator(); ++at) {
    std::string group = (*at)[2].matched ? (*at)[2].str() : (*at)[3].str();
    std::istringstream words(std::regex_replace(group, std::regex("\\|"), " "));
    for (std::string word; words >> word;)
      names.insert(word.substr(0, 2) == "c:" ? "cprsim:" + word.substr(2) : word);
  }
  return names;
}

TEST(Grammar, AndTableKnowTheSameElements) {
  const std::set<std::string> grammar = names_in_grammar("element");
  std::set<std::string> table;
  for (const ElementRule& rule : element_rules())
    table.insert(rule.name);
  // insides of what this version refuses as a whole, or does not look into
  const std::set<std::string> unread{"parallel", "helical", "points", "termination"};
  for (const std::string& name : grammar)
    EXPECT_TRUE(table.count(name) || unread.count(name)) << "the table lacks <" << name << ">";
  for (const ElementRule& rule : element_rules()) {
    const bool inside_gui = rule.key() == "gui_camera";  // the grammar does not look into <gui>
    const bool refused =
        rule.status == Status::kRejected || rule.type == ValueType::kAny || inside_gui;
    EXPECT_TRUE(grammar.count(rule.name) || refused) << "the grammar lacks <" << rule.name << ">";
  }
}

TEST(Grammar, KnowsTheAttributesOfTheTable) {
  const std::set<std::string> grammar = names_in_grammar("attribute");
  for (const AttributeRule& rule : attribute_rules())
    EXPECT_TRUE(grammar.count(rule.name) || rule.status != Status::kSupported)
        << rule.owners << "/@" << rule.name;
}

TEST(Grammar, KnowsTheMethodsOfTheSolver) {
  std::string words;
  for (const MethodWord& each : kMethodWords)
    words += (words.empty() ? "" : "|") + ('"' + std::string(each.word) + '"');
  EXPECT_NE(file_text(kSchema + "cprsim.rnc").find("method = " + words + "\n"), std::string::npos)
      << words;
}

TEST(Table, DocumentsEveryElementAndNamesExistingParents) {
  std::set<std::string_view> ids;
  for (const ElementRule& rule : element_rules())
    ids.insert(rule.key());
  for (const ElementRule& rule : element_rules()) {
    EXPECT_FALSE(std::string(rule.doc).empty()) << rule.name;
    std::istringstream parents(rule.parents);
    for (std::string parent; parents >> parent;)
      EXPECT_TRUE(ids.count(parent)) << parent;
  }
  for (const AttributeRule& rule : attribute_rules()) {
    std::istringstream owners(rule.owners);
    for (std::string owner; owners >> owner;)
      EXPECT_TRUE(ids.count(owner)) << owner << "/@" << rule.name;
  }
}

TEST(Table, ExplainsElements) {
  const std::string text = explain_element("cprsim:rod");
  EXPECT_NE(text.find("<length>"), std::string::npos);
  EXPECT_NE(text.find("class="), std::string::npos);
  EXPECT_EQ(explain_element("rod"), text);
  EXPECT_EQ(explain_element("nonsense"), "");
}

TEST(Grammar, IsTheOneGeneratedFromItsSource) {
  const std::string trang = CPRSIM_TRANG;
  if (trang.empty()) FAIL() << "trang is not installed: run tools/install-deps.sh";
  const auto copy =
      std::filesystem::temp_directory_path() / ("cprsim_" + std::to_string(::getpid()) + ".rng");
  ASSERT_EQ(std::system((trang + " '" + kSchema + "cprsim.rnc' '" + copy.string() + "'").c_str()),
            0);
  EXPECT_EQ(file_text(copy), file_text(kSchema + "cprsim.rng"))
      << "run: trang cprsim.rnc cprsim.rng";
  std::filesystem::remove(copy);
}

TEST(Grammar, AcceptsEveryShippedScene) {
  const std::string xmllint = CPRSIM_XMLLINT;
  if (xmllint.empty()) FAIL() << "xmllint is not installed: run tools/install-deps.sh";
  for (const auto& path : shipped_scenes())
    EXPECT_EQ(std::system((xmllint + " --noout --relaxng '" + kSchema + "cprsim.rng' '" +
                           path.string() + "' 2>/dev/null")
                              .c_str()),
              0)
        << path;
}

}  // namespace
}  // namespace cprsim
