// SPDX-License-Identifier: BSD-3-Clause
// The gallery's contact scenes: each says itself what must come out.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/tools/scratch_folder.h"

namespace cprsim {
namespace {

namespace fs = std::filesystem;

const fs::path kScenes = fs::path(CPRSIM_SOURCE_DIR) / "scenes/contact";

/// Exit code of a run without films.
int run(const fs::path& scene, const std::string& options = "") {
  const ScratchFolder folder;
  const std::string command = std::string(CPRSIM_BINARY_DIR) + "/bin/cprsim " + scene.string() +
                              " --no-video -o " + (folder / "out").string() + " " + options +
                              " > /dev/null 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ContactScenes, MeetTheirExpectations) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".xml") continue;
    EXPECT_EQ(run(entry.path()), 0) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 5);
}

/// The scene's copy in the folder with another resolution in space.
fs::path with_space(const std::string& scene, const std::string& space,
                    const ScratchFolder& folder) {
  std::string text = contents(kScenes / scene);
  const std::size_t from = text.find("<space "), to = text.find("/>", from);
  EXPECT_NE(from, std::string::npos) << scene;
  text.replace(from, to - from, "<space " + space);
  spill(folder / scene, text);
  fs::copy_file(kScenes / "rock.obj", folder / "rock.obj", fs::copy_options::skip_existing);
  return folder / scene;
}

// Statics, quasi-statics and dynamics; meshes, bodies that are held, other rods, friction.
TEST(ContactScenes, MeetTheirExpectationsByEveryMethod) {
  const ScratchFolder folder;
  for (const char* scene : {"slope.xml", "rod_on_floor.xml", "sprung_cylinder.xml",
                            "robot_and_bar.xml", "cantilever_on_rock.xml"}) {
    const std::string elements = scene[0] == 'c' ? "elements=\"40\"" : "elements=\"8\"";
    EXPECT_EQ(run(with_space(scene, "order=\"3\" " + elements, folder), "--method strain"), 0)
        << scene;
    EXPECT_EQ(run(with_space(scene, "degree=\"4\" " + elements, folder), "--method collocation"), 0)
        << scene;
  }
}

// A plane has no contact of its own: such a scene is solved in space.
TEST(ContactScenes, MayBePlanar) {
  const ScratchFolder folder;
  for (const char* scene : {"over_a_cylinder.xml", "over_two_pegs.xml"}) {
    std::string text = contents(kScenes / scene);
    const std::size_t at = text.find("</duration>");
    ASSERT_NE(at, std::string::npos) << scene;
    text.insert(at + 11, "<planar normal=\"0 1 0\"/>");
    spill(folder / scene, text);
    EXPECT_EQ(run(folder / scene, "--strict"), 0) << scene;
  }
}

// What the expectations are worth: without contact they fail.
TEST(ContactScenes, FailWithoutContact) {
  EXPECT_EQ(run(kScenes / "rod_on_floor.xml", "--without contact"), 1);
  EXPECT_EQ(run(kScenes / "over_a_cylinder.xml", "--without contact"), 1);
}

}  // namespace
}  // namespace cprsim
