// SPDX-License-Identifier: BSD-3-Clause
// Markup that hides something, references in a loop, and that all mistakes are told at once.
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

// A comment that was not closed would swallow the load up to the end of the next comment.
TEST(Comments, ThatSwallowElementsAreRefused) {
  const std::string load = "<cprsim:load at='leg::tip'><force>0 0 1</force></cprsim:load>";
  const LoadResult swallowed = load_text(scene_text("<!-- first " + load + "<!-- second -->"));
  EXPECT_EQ(error_codes(swallowed), std::vector<std::string>{"E201"});
  EXPECT_TRUE(load_text(scene_text("<!-- first -->" + load + "<!-- second - -->")).scene);
  EXPECT_EQ(error_codes(load_text(scene_text("<!-- no end"))), std::vector<std::string>{"E201"});
  EXPECT_EQ(error_codes(load_text(scene_text("<!-- three --->"))),
            std::vector<std::string>{"E201"});
}

TEST(DocumentTypes, AndEntitiesAreRefused) {
  for (const char* head : {"<!DOCTYPE sdf [<!ENTITY a \"aaaa\">]>",
                           "<!DOCTYPE sdf [<!ENTITY x SYSTEM \"file:///etc/passwd\">]>",
                           "<!DOCTYPE sdf SYSTEM \"http://localhost/x.dtd\">"})
    EXPECT_EQ(error_codes(load_text(head + std::string("<sdf version='1.11'>&a;</sdf>"))),
              std::vector<std::string>{"E203"});
}

TEST(Structure, TellsEveryMistakeAtOnce) {
  const LoadResult result = load_text(scene_text(R"(
    <frame name="a" attached_to="b"/><frame name="b" attached_to="a"/>
    <joint name="self" type="revolute"><parent>plate</parent><child>plate</child><axis><xyz>0 0 1</xyz></axis></joint>
    <joint name="nobody" type="fixed"><parent>plate</parent><child>ghost</child></joint>
    <cprsim:rod name="loose" class="steel"><base attached_to="ghost" joint="fixed"/><length>0.1</length></cprsim:rod>
    <link name="plate"/>)"));
  EXPECT_EQ(error_codes(result),
            (std::vector<std::string>{"E401", "E403", "E405", "E407", "E501"}));
  for (const Diagnostic& d : result.diagnostics)
    EXPECT_GT(d.line, 0) << d.message;
}

}  // namespace
}  // namespace cprsim
