// SPDX-License-Identifier: BSD-3-Clause
// The question that `cprsim identify` answers: which values of which scene, seen through which
// channels, in which rows of which table.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/fit/fit_parameter.h"
#include "engine/model/channel.h"
#include "scenes/loader/load.h"
#include "tools/cprsim/identify_options.h"
#include "tools/series/measured_table.h"

namespace cprsim {

struct FittedValue {
  FitParameter parameter;
  std::vector<std::string> paths;
};

struct InputColumn {
  std::string column, path;
  std::vector<double> values;  ///< per row, SI
};

struct MatchedColumn {
  std::string column;
  Channel channel;
  std::vector<double> values;   ///< per row, SI; NaN where nothing was read
  std::optional<double> sigma;  ///< SI
};

/// One number that was measured and is computed.
struct MeasuredCell {
  std::size_t row = 0, match = 0;
  double value = 0;  ///< SI
};

struct Study {
  std::string label, scene_text, scene_name, hash;
  LoadOptions load;  ///< what the command line changes in the scene
  MeasuredTable table;
  std::vector<FittedValue> values;
  std::vector<InputColumn> inputs;
  std::vector<MatchedColumn> matches;
  std::vector<double> times;        ///< s, per row; empty: every row is an equilibrium
  std::vector<std::size_t> rows;    ///< that are used
  std::vector<MeasuredCell> cells;  ///< by row, then by match: the order of the residuals
  long missing = 0;                 ///< cells of used columns without a number
  long rows_without_input = 0, rows_after_end = 0;

  bool dynamic() const { return !times.empty(); }

  bool sigma_known() const { return matches.front().sigma.has_value(); }
};

/// Reads scene and table and puts them together, or says what is wrong and returns the exit code.
std::variant<Study, int> prepare_study(const IdentifyOptions& options, const Console& console);

}  // namespace cprsim
