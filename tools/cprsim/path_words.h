// SPDX-License-Identifier: BSD-3-Clause
// What `cprsim path` was asked, and what it found.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/study/path.h"
#include "tools/cprsim/scene_options.h"

namespace cprsim {

struct PathWords {
  std::string path;
  SceneOptions scene;
  ConsoleOptions console;
  std::vector<std::string> drives, channels, free;
  std::string load, pose, from, to, plot, output;
  std::optional<double> at, largest_step, back;
  int max_points = 500, max_events = 50;
  bool branch = false, release = false, no_plot = false;
};

/// The words, or the exit code if nothing is left to do.
std::variant<PathWords, int> read_path_words(const Words& words);

/// What lambda means: value = from + lambda (to - from).
struct PathScale {
  std::string name = "fraction of the way", unit = "1";
  double from = 0, to = 1;

  double value(double lambda) const { return from + lambda * (to - from); }
};

/// Ready to follow: the study is in equilibrium at the path's start.
struct PathSetup {
  PathProblem problem;
  PathScale scale;
};

/// Brings the study to the path's start. @throws UsageError for words that mean nothing here,
/// NoEquilibrium where there is no equilibrium
PathSetup set_up(StaticStudy& study, const PathWords& words, const std::vector<Parameter>& probe);

/// What --load names: the link or rod, "force" or "torque", component 0 to 2.
struct LoadWords {
  std::string target;
  Parameter::Kind kind = Parameter::Kind::kForce;
  int component = 0;
};

LoadWords load_words(const std::string& text);

/// The scene's load there, if there is exactly one; -1 if there is none.
int load_at_target(const Scene& scene, const std::string& target);

struct NamedPath {
  std::string name;  ///< "path", "branch 1+"
  Path path;
};

struct NamedRelease {
  std::string event;  ///< "stability 1"
  int side = 1;
  double lambda = 0;
  Release release;
};

struct PathResult {
  std::vector<NamedPath> paths;
  std::vector<NamedRelease> releases;
  double seconds = 0;
  std::vector<std::string> files;
};

/// The rows of a path in the order of arclength, events among them.
struct PathRow {
  const PathPoint* point = nullptr;
  const PathEvent* event = nullptr;

  int unstable_after() const { return event != nullptr ? event->after : point->unstable; }
};

std::vector<PathRow> rows_of(const Path& path);

std::string path_csv(StaticStudy& study, const PathResult& result, const PathScale& scale,
                     const std::vector<Channel>& channels);
std::string path_json(StaticStudy& study, const PathResult& result, const PathScale& scale,
                      const PathWords& words);
std::string path_text(StaticStudy& study, const PathResult& result, const PathScale& scale,
                      const std::string& label, const std::string& folder);

/// path.gp, and path.svg if gnuplot is there. @return whether it was drawn
bool draw_path(StaticStudy& study, const PathResult& result, const PathScale& scale,
               const Channel& channel, const std::string& title, const std::string& folder,
               const Console& console);

}  // namespace cprsim
