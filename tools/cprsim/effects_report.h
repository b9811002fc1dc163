// SPDX-License-Identifier: BSD-3-Clause
// What each effect changes in the answer of a scene and costs in time, told as table, JSON, CSV and
// picture.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tools/cprsim/console.h"

namespace cprsim {

/// The scene with one effect more, or one less.
struct EffectRow {
  std::string effect;
  bool added = false;   ///< otherwise taken out
  std::string problem;  ///< why it could not be run
  double change = 0;    ///< largest distance of the measured channel from the scene's own run
  double rms = 0;
  double cpu_seconds = 0;
  long evaluations = 0;  ///< section evaluations
};

struct EffectsReport {
  std::string label, scene_path, measure, unit;
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<std::string> effects;  ///< of the scene
  double length = 0;                 ///< longest rod, m
  double duration = 0;               ///< s; 0: an equilibrium
  double numerical_error = 0;        ///< of the scene's own run, found by a tighter one
  double cpu_seconds = 0;            ///< of the scene's own run
  long evaluations = 0;
  std::vector<EffectRow> rows;

  /// Time of a row relative to the scene's own run, as what the effect adds: 1.3 is 30 % more.
  double time_factor(const EffectRow& row) const;
};

std::string to_json(const EffectsReport& report);
std::string to_summary(const EffectsReport& report, const std::string& folder);

/// effects.csv, effects.gp, effects.svg and effects.png
void write_effects(const EffectsReport& report, const std::filesystem::path& folder,
                   const Console& console);

}  // namespace cprsim
