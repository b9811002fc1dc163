// SPDX-License-Identifier: BSD-3-Clause
// The scene to start from: it runs as it is, and each of its comments around an element is valid
// once it is none.
#include <algorithm>
#include <regex>

#include "engine/model/place_law.h"
#include "scenes/loader/load.h"
#include "scenes/loader/schema.h"
#include "tests/tools/program.h"

namespace cprsim {
namespace {

class NewCommand : public ProgramTest {
 protected:
  std::string starter() const {
    EXPECT_EQ(run("new start.xml").code, 0);
    return contents(folder_ / "start.xml");
  }
};

/// The elements that stand as comments at the beginnings of lines.
std::vector<std::string> options_of(const std::string& scene) {
  static const std::regex kOption("\\n *<!-- (<.*?>) -->");
  std::vector<std::string> found;
  for (std::sregex_iterator at(scene.begin(), scene.end(), kOption), end; at != end; ++at)
    found.push_back((*at)[1]);
  return found;
}

std::string uncommented(const std::string& scene, const std::string& option) {
  return with(scene, "<!-- " + option + " -->", option);
}

std::string complaints(const LoadResult& loaded, Severity least) {
  std::string text;
  for (const Diagnostic& d : loaded.diagnostics)
    if (d.severity >= least) text += d.code + ": " + d.message + "\n";
  return text;
}

TEST_F(NewCommand, WritesASceneThatRunsWithoutAWarning) {
  const std::string scene = starter();
  EXPECT_EQ(complaints(load_scene_text(scene, "start.xml", {}), Severity::kWarning), "");
  const Answer answer = run("start.xml");
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_TRUE(answer.says("1 of 1 met")) << answer.out;
}

TEST_F(NewCommand, ShowsEveryEffectThatThereIs) {
  const std::vector<std::string> options = options_of(starter());
  for (const std::string& effect : element_names("cprsim:effects")) {
    if (find_element("cprsim:effects", effect)->status != Status::kSupported) continue;
    EXPECT_EQ(std::count(options.begin(), options.end(), "<" + effect + "/>"), 1) << effect;
  }
}

TEST_F(NewCommand, ShowsEveryLawOfPlace) {
  const std::vector<std::string> options = options_of(starter());
  for (const PlaceLaw& law : kPlaceLaws)
    EXPECT_EQ(std::count_if(options.begin(), options.end(),
                            [&](const std::string& option) {
                              return option.find("<" + std::string(law.word) + ">") !=
                                     std::string::npos;
                            }),
              1)
        << law.word;
}

/// These two alone have nothing to rub.
bool is_friction(const std::string& option) {
  return option == "<friction/>" || option == "<tendon_friction/>";
}

std::string tendon_option(const std::string& scene) {
  for (const std::string& option : options_of(scene))
    if (option.starts_with("<cprsim:tendon")) return option;
  return {};
}

TEST_F(NewCommand, EveryOptionIsValid) {
  const std::string scene = starter();
  const std::vector<std::string> options = options_of(scene);
  ASSERT_GT(options.size(), 9u);
  for (const std::string& option : options) {
    const LoadResult loaded = load_scene_text(uncommented(scene, option), "start.xml", {});
    EXPECT_TRUE(loaded.scene) << option << "\n" << complaints(loaded, Severity::kError);
    if (!is_friction(option)) {
      EXPECT_EQ(complaints(loaded, Severity::kWarning), "") << option;
    }
  }
}

TEST_F(NewCommand, EveryOptionRuns) {
  const std::string scene = starter();
  for (const std::string& option : options_of(scene)) {
    if (option.starts_with("<cprsim:video")) continue;  // needs a machine that can draw
    spill(folder_ / "one.xml", uncommented(scene, option));
    const Answer answer = run("one.xml --duration 0.02 -o one");
    EXPECT_EQ(answer.code, 0) << option << "\n" << answer.err;
    std::filesystem::remove_all(folder_ / "one");
  }
}

TEST_F(NewCommand, TendonFrictionRunsWithItsTendon) {
  std::string scene = starter();
  scene = uncommented(uncommented(scene, tendon_option(scene)), "<tendon_friction/>");
  EXPECT_EQ(complaints(load_scene_text(scene, "start.xml", {}), Severity::kWarning), "");
  spill(folder_ / "rubs.xml", scene);
  const Answer answer = run("rubs.xml --duration 0.1");
  EXPECT_EQ(answer.code, 0) << answer.err;
}

TEST_F(NewCommand, AllEffectsTogetherAreValidAndRun) {
  std::string scene = starter();
  for (const std::string& effect : element_names("cprsim:effects"))
    if (effect != "tendon_friction")  // not where rods touch something
      scene = uncommented(scene, "<" + effect + "/>");
  EXPECT_EQ(complaints(load_scene_text(scene, "start.xml", {}), Severity::kWarning), "");
  spill(folder_ / "all.xml", scene);
  const Answer answer = run("all.xml --duration 0.1");
  EXPECT_EQ(answer.code, 0) << answer.err;
}

TEST_F(NewCommand, NamesTheWorldAfterTheFile) {
  ASSERT_EQ(run("new 'my robot-2.xml'").code, 0);
  EXPECT_NE(contents(folder_ / "my robot-2.xml").find("<world name=\"my_robot_2\">"),
            std::string::npos);
  EXPECT_EQ(run("check 'my robot-2.xml'").code, 0);
}

TEST_F(NewCommand, OverwritesOnlyWhenTold) {
  spill(folder_ / "scene.xml", "mine");
  const Answer refused = run("new");
  EXPECT_EQ(refused.code, 5);
  EXPECT_TRUE(refused.complains("'scene.xml' exists")) << refused.err;
  EXPECT_EQ(contents(folder_ / "scene.xml"), "mine");
  EXPECT_EQ(run("new --overwrite").code, 0);
  EXPECT_EQ(run("check scene.xml").code, 0);
}

TEST_F(NewCommand, WritesToStandardOutput) {
  const Answer answer = run("new -");
  EXPECT_EQ(answer.code, 0);
  EXPECT_TRUE(load_scene_text(answer.out, "-", {}).scene);
}

}  // namespace
}  // namespace cprsim
