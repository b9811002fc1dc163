// SPDX-License-Identifier: BSD-3-Clause
// What a sweep runs: grids of settings, and the run that each of them is compared with.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tools/cprsim/measured_run.h"

namespace cprsim {

/// NAME=a,b,c or NAME=FROM:TO:COUNT[log]
struct SweepAxis {
  std::string name;
  std::vector<std::string> values;
};

/// --reference
enum class ReferenceKind { kTight, kSettings, kFile, kNone };

struct SweepOptions {
  ConsoleOptions console;
  SceneOptions scene;
  std::string path, output;
  std::string sweep;  ///< name of a <cprsim:sweep>; empty: the first one
  std::vector<SweepAxis> vary;
  std::vector<std::string> measure;
  std::string norm;  ///< max, rms, final
  std::string reference;
  int jobs = 0, repetitions = 3;
  bool quick = false, resume = false;

  std::vector<std::pair<std::string, std::string>> given() const;
};

/// Where people look: the link that most rods hold, else the tip of the first rod.
std::string default_channel(const Scene& scene);

std::variant<SweepOptions, int> parse_sweep_options(const Words& words);

/// One run to be made.
struct SweepPoint {
  Settings settings;          ///< what is varied
  std::string line;           ///< runs of one line differ in the refined setting only
  std::string refined;        ///< name of that setting; empty: none
  std::size_t reference = 0;  ///< index
};

struct SweepMeasureName {
  std::string name, unit;
  std::vector<std::string> channels;
  Norm norm = Norm::kMax;
};

struct SweepPlan {
  std::string label, scene_hash;
  bool dynamic = false;
  int usual_cells = 6;              ///< of shooting, of the rod that it cuts into most of them
  double duration = 0, length = 0;  ///< s, and the longest rod, m
  std::vector<std::string> axes;    ///< names of all that is varied
  std::vector<SweepPoint> points;
  std::vector<SweepMeasureName> measures;
  ReferenceKind reference_kind = ReferenceKind::kTight;
  std::string reference_file;
  /// A tight solution for each combination of values that are no settings of the solver, and a
  /// looser one that tells how far the first may be off.
  std::vector<Settings> references, looser;

  std::vector<std::string> channels() const;  ///< of all measures
};

/// @throws UsageError
SweepPlan make_plan(const Scene& scene, const SweepOptions& options);

/// Grids over settings of the solver that show what accuracy costs.
std::vector<std::vector<SweepAxis>> default_grids(const Scene& scene, bool quick);

}  // namespace cprsim
