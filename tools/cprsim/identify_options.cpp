// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/identify_options.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "scenes/loader/values.h"

namespace cprsim {

namespace {

constexpr const char* kAbout =
    R"(Fits values of a scene to measurements: the least sum of squares, with bounds, standard errors,
intervals, correlations, and a warning where the data do not determine a value.

Examples
  cprsim identify beam.xml tips.csv --fit 'm::beam/material/youngs_modulus=30e9:5e9:200e9' \
      --input 'load=load[m::beam::tip]/force#1' --match 'tip x=m::beam.tip.position.x'
  cprsim identify rod.xml record.csv --fit wire::rod/damping/bending \
      --fit 'wire::rod/material/youngs_modulus=190e9:150e9:250e9'
  cprsim identify robot.xml tips.csv --fit 'a/length,b/length=0.4:0.2:0.6' --sigma 'tip x=0.5' ...

DATA is a CSV file with a header `name [unit],...` (m cm mm s ms rad deg N mN ...; empty, nan, - or ?
where nothing was read). With a column `time` it is the record of one dynamic run; without, every row
is an equilibrium of its own. Columns called like a channel of the scene need no --match.

Exit codes: 0 every value is determined; 1 fitted, but a value is not observable or ends at a bound;
2 usage or table; 3 scene; 4 no equilibrium at the start, or no convergence; 5 files
)";

/// Assignments: COLUMN=...
void add_assignments(CommandLine& line, const std::string& name, std::vector<std::string>& list,
                     const std::string& type, const std::string& help) {
  line.each(name, type, help, [&list, type](const std::string& text) {
    if (text.find('=') == std::string::npos || text.front() == '=')
      throw UsageError("'" + text + "' is not of the form " + type);
    list.push_back(text);
  });
}

}  // namespace

std::string FitOption::name() const {
  return fmt::format("{}", fmt::join(paths, ","));
}

std::variant<FitOption, std::string> parse_fit_option(const std::string& text) {
  FitOption option;
  const std::size_t equals = text.find('=');
  for (const std::string& path : split(text.substr(0, equals), ',')) {
    option.paths.emplace_back(trim(path));
    if (option.paths.back().empty()) return "'" + text + "' names no path";
  }
  if (equals == std::string::npos) return option;
  const std::vector<std::string> numbers = split(text.substr(equals + 1), ':');
  if (numbers.size() != 1 && numbers.size() != 3)
    return "'" + text + "' is not of the form PATH=START or PATH=START:LOW:HIGH";
  std::optional<double>* const targets[] = {&option.start, &option.low, &option.high};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i == 0 && numbers[i].empty() && numbers.size() == 3) continue;  // the scene's value
    *targets[i] = parse_number(numbers[i]);
    if (!*targets[i]) return "'" + numbers[i] + "' in '" + text + "' is not a number";
  }
  if (option.low && !(*option.low < *option.high)) {
    return fmt::format("the bounds of {} are reversed or equal: {} to {}", option.name(),
                       *option.low, *option.high);
  }
  if (option.low && option.start && (*option.start < *option.low || *option.start > *option.high)) {
    return fmt::format("{} starts at {}, outside its bounds {} to {}", option.name(), *option.start,
                       *option.low, *option.high);
  }
  return option;
}

std::variant<IdentifyOptions, int> parse_identify_options(const Words& words) {
  IdentifyOptions options;
  std::optional<double> level;
  CommandLine line("cprsim identify", kAbout);
  line.scene(options.path);
  line.argument("DATA", options.data, "The measurements, a CSV file");
  line.each("--fit", "PATH[,PATH][=START[:LOW:HIGH]]",
            "A value to find; several paths share one. Repeatable", [&](const std::string& text) {
              auto option = parse_fit_option(text);
              if (const auto* why = std::get_if<std::string>(&option)) throw UsageError(*why);
              options.fit.push_back(std::get<FitOption>(std::move(option)));
            });
  line.require("--fit");
  add_assignments(line, "--input", options.input, "COLUMN=PATH",
                  "This column is set into the scene, row by row");
  add_assignments(line, "--match", options.match, "COLUMN=CHANNEL", "This column was measured");
  add_assignments(line, "--sigma", options.sigma, "COLUMN=VALUE",
                  "Standard deviation, in the column's unit");
  line.number("--confidence", level, "Of the intervals (default 0.95)", "between 0 and 1",
              [](double value) { return value > 0 && value < 1; });
  line.count("--max-iterations", options.max_iterations, 1, "Of the search (default 100)");
  line.text("-o,--output", options.output, "DIR",
            "Where results go (default out/<scene>_identify)");
  line.flag("--no-plot", options.no_plot, "Write no identify.svg");
  add_scene_options(line, options.scene);
  add_console_options(line, options.console);
  if (const auto code = line.parse(words)) return *code;
  if (level) options.level = *level;
  return options;
}

}  // namespace cprsim
