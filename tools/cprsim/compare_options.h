// SPDX-License-Identifier: BSD-3-Clause
// What `cprsim compare` may be told.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tools/cprsim/command_line.h"
#include "tools/series/alignment.h"

namespace cprsim {

/// [QUANTITY=]NUMBER, in the unit that the table shows: attitudes in degrees.
struct ErrorLimit {
  std::string quantity;  ///< empty: of all
  double value = 0;
};

struct CompareOptions {
  ConsoleOptions console;
  std::string run, reference, output;
  std::vector<std::string> of;                           ///< quantities; empty: all
  std::vector<std::pair<std::string, std::string>> map;  ///< name in the run, name in the reference
  std::vector<std::string> reference_units;
  std::optional<Pose> reference_frame;
  bool tangent_is_x = false;
  Alignment alignment = Alignment::kNone;
  bool apply_lag = false;
  std::optional<double> length;  ///< m, what errors are per cent of
  std::vector<ErrorLimit> rms, max;
};

std::variant<CompareOptions, int> parse_compare_options(const Words& words);

}  // namespace cprsim
