// SPDX-License-Identifier: BSD-3-Clause
// Numbers that are none, that wrap around, or that would fill memory: refused at their line and
// column before anything of their size is made.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

/// A valid scene with every number of the solver given; `value` replaces that of the attribute.
LoadResult with(const std::string& attribute, const std::string& value,
                const std::string& model = "") {
  std::string text = scene_text(model);
  text.replace(
      text.find("</physics>"), 10,
      R"(<cprsim:solver method="auto"><space points="10"/><time scheme="esdirk32" step="0.01"/>)"
      R"(<nonlinear tolerance="1e-9" max_iterations="10"/></cprsim:solver></physics>)");
  const std::size_t at = text.find(attribute + "=\"") + attribute.size() + 2;
  text.replace(at, text.find('"', at) - at, value);
  return load_text(text);
}

Diagnostic first_error(const LoadResult& result) {
  EXPECT_FALSE(result.scene);
  for (const Diagnostic& d : result.diagnostics)
    if (d.severity == Severity::kError) return d;
  ADD_FAILURE() << "no error";
  return {};
}

TEST(Numbers, ThatAreWholeAreRefusedWithTheirPlace) {
  for (const char* value : {"1e9", "3.7", "4294967296", "-1", "0", "nan", "", "10 10"}) {
    const LoadResult result = with("points", value);
    const Diagnostic d = first_error(result);
    EXPECT_TRUE(d.code == "E305" || d.code == "E306") << value << " " << d.code;
    EXPECT_EQ(d.line, 4) << value;
    EXPECT_GT(d.column, 1) << value;
    EXPECT_NE(d.message.find("points"), std::string::npos) << d.message;
  }
}

TEST(Numbers, OfEnormousSizesAreRefusedBeforeAllocation) {
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  EXPECT_EQ(first_error(with("points", "1000000000")).code, "E509");
  EXPECT_EQ(first_error(with("points", "2147483647")).code, "E509");
  EXPECT_EQ(first_error(with("step", "1e-18")).code, "E509");
  EXPECT_EQ(first_error(with("step", "5e-324")).code, "E509");
  std::string rods;
  for (int k = 0; k < 30; ++k)
    rods +=
        "<cprsim:rod name='r" + std::to_string(k) +
        "' class='steel'><base attached_to='base' joint='fixed'/><length>1</length></cprsim:rod>";
  EXPECT_EQ(first_error(with("points", "10000", rods)).code, "E509");
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 50'000) << "kB";
}

TEST(Steps, ThatMakeNoSenseAreRefused) {
  for (const char* value : {"0", "-0.01", "-5e-324"})
    EXPECT_EQ(first_error(with("step", value)).code, "E306") << value;
  EXPECT_EQ(first_error(with("step", "1e999")).code, "E305");
  EXPECT_TRUE(has_code(with("step", "5"), "W504")) << "longer than the run";
}

TEST(Tolerances, AreNeverClampedSilently) {
  for (const char* value : {"0", "1e-20", "-1e-9", "1"})
    EXPECT_EQ(first_error(with("tolerance", value)).code, "E306") << value;
  EXPECT_TRUE(with("tolerance", "1e-12").scene);
}

}  // namespace
}  // namespace cprsim
