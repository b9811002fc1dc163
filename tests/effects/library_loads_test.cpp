// SPDX-License-Identifier: BSD-3-Clause
// Which libraries a run uses, as the dynamic linker tells: it loads what the program asks for, and
// binds a function of a library when it is called first. Beside what is not to be used stands a
// scene that does use it, so that a changed name cannot make the check empty.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <sstream>

#include "tests/system/program.h"

namespace cprsim {
namespace {

constexpr const char* kLoads = "loads";

class LibraryLoads : public Program {
 protected:
  static void SetUpTestSuite() {
#ifndef __GLIBC__
    GTEST_SKIP() << "only glibc's linker tells";
#endif
  }

  /// Libraries, by the part of their names before ".so", that the program loads or calls once it
  /// has begun; those of programs that it starts are not its own.
  std::map<std::string, int> used_for(const std::string& scene) {
    spill(folder_ / "scene.xml", scene);
    const Outcome run_of =
        run("run scene.xml -o out",
            "LD_BIND_NOW= LD_DEBUG=libs,bindings LD_DEBUG_OUTPUT=" + std::string(kLoads));
    complaints_ = run_of.code == 0 ? "" : run_of.err;
    std::map<std::string, int> used;
    for (const auto& file : std::filesystem::directory_iterator(folder_.path())) {
      if (file.path().stem() != kLoads) continue;
      count(contents(file.path()), used);
      std::filesystem::remove(file.path());
    }
    return used;
  }

  std::string complaints_;  ///< of the last run

 private:
  static void count(const std::string& told, std::map<std::string, int>& used) {
    std::istringstream lines(told);
    bool begun = false;
    for (std::string line; std::getline(lines, line);) {
      if (has(line, "transferring control: ")) begun = has(line, "/bin/cprsim");
      if (!begun) continue;
      for (const char* word : {" to ", "calling init: "}) {
        const std::size_t at = line.find(word);
        if (at == std::string::npos) continue;
        const std::string path = line.substr(at + std::string(word).size());
        const std::string name = path.substr(path.find_last_of('/', path.find(".so")) + 1);
        ++used[name.substr(0, name.find(".so"))];
      }
    }
  }
};

/// Of a library in several parts.
int calls(const std::map<std::string, int>& used, const std::string& begin) {
  int sum = 0;
  for (const auto& [name, count] : used)
    if (name.rfind(begin, 0) == 0) sum += count;
  return sum;
}

constexpr const char* kLibraries[] = {"libBullet", "libLinearMath", "libassimp", "libEGL", "libGL"};

/// The swing for 20 ms.
std::string brief() {
  return replaced(swing(), "<duration>2</duration>", "<duration>0.02</duration>");
}

std::string with_link(const std::string& link) {
  return replaced(brief(), "<cprsim:load at", link + "<cprsim:load at");
}

TEST_F(LibraryLoads, AreNoneForASceneOfRodsAndLinks) {
  const std::map<std::string, int> used = used_for(brief());
  EXPECT_EQ(complaints_, "");
  EXPECT_GT(calls(used, "libtinyxml2"), 0) << "nothing was traced";
  for (const char* library : kLibraries)
    EXPECT_EQ(calls(used, library), 0) << library;
}

TEST_F(LibraryLoads, AreBulletsWhereABodyFlies) {
  const std::map<std::string, int> used = used_for(with_link(
      R"(<link name="ball"><pose>1 0 1 0 0 0</pose>
        <inertial><mass>0.1</mass><inertia><ixx>1e-5</ixx><iyy>1e-5</iyy><izz>1e-5</izz></inertia></inertial>
        <collision name="c"><geometry><sphere><radius>0.02</radius></sphere></geometry></collision></link>)"));
  EXPECT_EQ(complaints_, "");
  EXPECT_GT(calls(used, "libBullet"), 0);
  for (const char* library : {"libassimp", "libEGL", "libGL"})
    EXPECT_EQ(calls(used, library), 0) << library;
}

TEST_F(LibraryLoads, AreAssimpsWhereALinkHasAMesh) {
  spill(folder_ / "corner.obj",
        "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const std::map<std::string, int> used = used_for(with_link(
      R"(<link name="corner"><visual name="v"><geometry><mesh><uri>corner.obj</uri></mesh></geometry></visual></link>
      <joint name="held" type="fixed"><parent>world</parent><child>corner</child></joint>)"));
  EXPECT_EQ(complaints_, "");
  EXPECT_GT(calls(used, "libassimp"), 0);
  for (const char* library : {"libBullet", "libEGL", "libGL"})
    EXPECT_EQ(calls(used, library), 0) << library;
}

TEST_F(LibraryLoads, AreOfOpenGlWhereAFilmIsDrawn) {
  const std::map<std::string, int> used =
      used_for(replaced(brief(), "<cprsim:record",
                        R"(<cprsim:camera name="c"><eye>1 1 1</eye><look_at>0 0 1</look_at>
      <image><width>64</width><height>64</height></image></cprsim:camera>
    <cprsim:video camera="c" fps="50" file="swing.mp4"/>
    <cprsim:record)"));
  if (has(complaints_, "ffmpeg") || has(complaints_, "libegl"))
    GTEST_SKIP() << "no films here: " << complaints_;
  EXPECT_EQ(complaints_, "");
  EXPECT_GT(calls(used, "libEGL"), 0);
  for (const char* library : {"libBullet", "libassimp"})
    EXPECT_EQ(calls(used, library), 0) << library;
}

}  // namespace
}  // namespace cprsim
