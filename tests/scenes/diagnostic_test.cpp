// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/diagnostic.h"

#include <gtest/gtest.h>

#include "scenes/loader/suggest.h"
#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

const char* const kMisspelt = R"(<sdf version="1.11" xmlns:cprsim="urn:cprsim:1">
  <world name="w">
    <cprsim:simulation mode="static"/>
    <cprsim:effects/>
    <model name="mechanism">
      <link name="base"/>
      <joint name="j" type="fixed"><parent>world</parent><child>base</child></joint>
      <cprsim:rod name="rod">
        <base attached_to="base" joint="fixed"/>
        <lenght>0.3</lenght>
        <cross_section><circle><radius>0.001</radius></circle></cross_section>
        <material><density>1</density><youngs_modulus>1e9</youngs_modulus><shear_modulus>1e9</shear_modulus></material>
      </cprsim:rod>
    </model>
  </world>
</sdf>
)";

TEST(Diagnostics, ShowPlaceLineCaretSuggestionAndContext) {
  EXPECT_EQ(to_text(load_text(kMisspelt).diagnostics),
            "test.xml:10:9: error[E301]: <lenght> is not part of <cprsim:rod>\n"
            "   10 |         <lenght>0.3</lenght>\n"
            "      |         ^^^^^^^ did you mean <length>?\n"
            "      in world 'w' / model 'mechanism' / cprsim:rod 'rod'\n"
            "test.xml:8:7: error[E303]: <cprsim:rod> 'rod' has no <length>\n"
            "2 errors in 1 file (cprsim explain E301)\n");
}

TEST(Diagnostics, HaveCompilerJsonAndWorkflowForms) {
  Diagnostic d;
  d.code = "E301";
  d.file = "a.xml";
  d.line = 3;
  d.column = 7;
  d.message = "a \"quoted\" thing";
  EXPECT_EQ(to_gcc(d), "a.xml:3:7: error: a \"quoted\" thing [E301]\n");
  EXPECT_EQ(to_github(d), "::error file=a.xml,line=3,col=7,title=E301::a \"quoted\" thing\n");
  EXPECT_EQ(to_json(d),
            "{\"severity\":\"error\",\"code\":\"E301\",\"file\":\"a.xml\",\"line\":3,\"column\":7,"
            "\"message\":\"a \\\"quoted\\\" thing\",\"suggestion\":\"\",\"context\":\"\","
            "\"details\":[]}");
}

TEST(Diagnostics, KeepTheCaretBelowItsWordBehindTabsAndInLongLines) {
  Diagnostic d;
  d.code = "E301";
  d.file = "a.xml";
  d.line = 1;
  d.source_line = "\t\t<lenght>";
  d.column = 3;
  d.caret_length = 7;
  EXPECT_NE(to_text(d).find("      | \t\t^^^^^^^"), std::string::npos);
  d.source_line = std::string(5000, 'x') + "<lenght>" + std::string(5000, 'y');
  d.column = 5001;
  const std::string text = to_text(d);
  EXPECT_LT(text.size(), 500u);
  const std::size_t caret = text.find('^'), line = text.find("    1 | "),
                    mark = text.find("      | ");
  EXPECT_EQ(text[line + caret - mark], '<');
}

TEST(Diagnostics, HaveOneExplanationPerCode) {
  std::set<std::string> seen;
  for (const CodeEntry& entry : diagnostic_codes()) {
    EXPECT_TRUE(seen.insert(entry.code).second) << entry.code;
    EXPECT_FALSE(std::string(entry.explanation).empty());
  }
}

TEST(Suggestions, CountSwappedNeighboursAsOneMistake) {
  EXPECT_EQ(edit_distance("lenght", "length"), 1);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("same", "same"), 0);
}

TEST(Suggestions, KnowOtherToolsWords) {
  EXPECT_EQ(nearest_name("timestep", {"max_step_size", "gravity"}), "max_step_size");
  EXPECT_EQ(nearest_name("E", {"youngs_modulus", "density"}), "youngs_modulus");
  EXPECT_EQ(nearest_name("rod", {"cprsim:rod", "link"}), "cprsim:rod");
  EXPECT_EQ(nearest_name("zebra", {"link", "joint"}), "");
}

}  // namespace
}  // namespace cprsim
