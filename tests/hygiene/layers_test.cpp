// SPDX-License-Identifier: BSD-3-Clause
// Who may include whom. Layers erode unless a machine checks them.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "tests/hygiene/source_tree.h"

namespace cprsim {
namespace {

/// A folder, the folders (ending in '/') and headers it may include besides its own, and the starts
/// of foreign includes that its .cpp files may have.
struct Layer {
  std::string folder;
  std::vector<std::string> may_include;
  std::vector<std::string> foreign;
};

// what operating systems have and C++ 20 lacks: processes, locks, durable writes, libraries at run
// time
const std::vector<std::string> kPosix{"unistd.h", "fcntl.h", "dlfcn.h", "spawn.h", "sys/"};

std::vector<std::string> join(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const std::vector<Layer>& layers() {
  static const std::vector<std::string> model{"engine/math/", "engine/model/"};
  static const std::vector<std::string> section = join(model, {"engine/time/"});
  static const std::vector<std::string> rod = join(section, {"engine/section/"});
  static const std::vector<std::string> sundials{"cvode/", "kinsol/", "nvector/", "sun"};
  static const std::vector<std::string> sundials_ida{"ida/", "nvector/", "sundials/"};
  static const std::vector<Layer> all{
      {"engine/math/", {}, {}},
      {"engine/model/", {"engine/math/"}, {}},
      {"engine/time/", model, sundials_ida},
      {"engine/section/", section, {}},
      {"engine/rod/", rod, sundials},
      {"engine/solve/", {"engine/math/"}, sundials},
      // the snapshot is plain data; the problem is the interface by which solvers see the
      // equations; the clock measures them
      {"engine/robot/",
       join(rod, {"engine/rod/", "engine/solve/problem.h", "engine/solve/phase_clock.h",
                  "engine/run/snapshot.h"}),
       {}},
      {"engine/run/", {"engine/"}, {}},
      {"engine/study/", {"engine/"}, {}},
      // unknown numbers and their confidence: no physics. MINPACK's search is Eigen's unsupported
      // one
      {"engine/fit/", {"engine/math/"}, {"unsupported/Eigen/"}},
      {"scenes/", model, join({"tinyxml2.h", "assimp/"}, kPosix)},
      {"collision/",
       join(model, {"engine/robot/free_bodies.h", "engine/run/snapshot.h"}),
       {"btBullet", "LinearMath/", "BulletCollision/", "BulletDynamics/"}},
      {"render/", join(model, {"engine/run/snapshot.h"}), join({"EGL/", "GL/", "stb/"}, kPosix)},
      {"tools/",
       {"engine/", "scenes/", "collision/", "render/"},
       join({"CLI/", "fmt/", "hdf5.h", "minizip/", "mpi.h", "nlohmann/", "tinyxml2.h", "xxhash.h"},
            kPosix)},
      {"tests/", {""}, {""}},
  };
  return all;
}

// A table of GL entry points needs GL's types; only render's own .cpp files include it.
const std::set<std::string> kForeignInHeader{"render/gl_api.h"};

bool starts_with_any(const std::string& text, const std::vector<std::string>& starts) {
  return std::any_of(starts.begin(), starts.end(),
                     [&](const std::string& start) { return text.rfind(start, 0) == 0; });
}

const Layer* layer_of(const SourceFile& file) {
  for (const Layer& layer : layers())
    if (file.path.rfind(layer.folder, 0) == 0) return &layer;
  return nullptr;
}

bool is_everywhere(const std::string& target) {
  return target.find_first_of("./") == std::string::npos || target.rfind("Eigen/", 0) == 0;
}

TEST(Layers, EveryFolderHasALayer) {
  for (const SourceFile& file : source_tree()) {
    if (!file.is_cpp() && !file.is_header()) continue;
    EXPECT_NE(layer_of(file), nullptr) << file.path;
  }
}

TEST(Layers, NobodyIncludesUpwards) {
  for (const SourceFile& file : source_tree()) {
    const Layer* layer = layer_of(file);
    if (layer == nullptr) continue;
    for (const Include& include : includes_of(file)) {
      if (!include.quoted) continue;
      const bool own = include.target.rfind(layer->folder, 0) == 0;
      EXPECT_TRUE(own || starts_with_any(include.target, layer->may_include))
          << file.path << ":" << include.line << " includes " << include.target << ", which "
          << layer->folder << " may not";
    }
  }
}

TEST(Layers, ForeignIncludesStayInTheCppFilesOfTheirFolder) {
  for (const SourceFile& file : source_tree()) {
    const Layer* layer = layer_of(file);
    if (layer == nullptr || layer->folder == "tests/") continue;
    for (const Include& include : includes_of(file)) {
      if (include.quoted || is_everywhere(include.target)) continue;
      EXPECT_TRUE(starts_with_any(include.target, layer->foreign))
          << file.path << ":" << include.line << " includes <" << include.target << ">";
      EXPECT_TRUE(file.is_cpp() || kForeignInHeader.count(file.path) > 0)
          << file.path << ":" << include.line << " includes <" << include.target << "> in a header";
    }
  }
}

TEST(Layers, IncludesAreWrittenFromTheRootAndExist) {
  std::set<std::string> paths;
  for (const SourceFile& file : source_tree())
    paths.insert(file.path);
  for (const SourceFile& file : source_tree())
    for (const Include& include : includes_of(file)) {
      if (!include.quoted) continue;
      EXPECT_EQ(paths.count(include.target), 1U)
          << file.path << ":" << include.line << " includes \"" << include.target << "\"";
    }
}

TEST(Layers, AFileIncludesItsOwnHeaderFirst) {
  std::set<std::string> paths;
  for (const SourceFile& file : source_tree())
    paths.insert(file.path);
  for (const SourceFile& file : source_tree()) {
    if (!file.is_cpp()) continue;
    const std::string header = file.path.substr(0, file.path.size() - 4) + ".h";
    const std::vector<Include> includes = includes_of(file);
    if (paths.count(header) == 0) continue;
    ASSERT_FALSE(includes.empty()) << file.path;
    EXPECT_EQ(includes[0].target, header) << file.path;
  }
}

}  // namespace
}  // namespace cprsim
