// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/compare_options.h"

#include <functional>
#include <map>
#include <numbers>

#include "scenes/loader/values.h"
#include "tools/series/measured_table.h"

namespace cprsim {

namespace {

constexpr const char* kAbout =
    "Compares a run with a reference trajectory, at the reference's instants: no extrapolation,\n"
    "linear between the run's samples, attitudes along the shortest arc.\n"
    "RUN is the folder of a run or a file, REFERENCE a file (CSV, HDF5 or TUM) whose columns\n"
    "have the run's names, or end like them (position.x, orientation.w).\n\n"
    "Examples\n"
    "  cprsim compare out/planar measured.csv --max 0.002\n"
    "  cprsim compare out/planar mocap.tum --map robot::platform= --align yaw --apply-lag\n"
    "  cprsim compare a.csv b.csv --of robot::platform.position --rms 1e-4 --json\n"
    "Exit code 1 if a limit of --rms or --max is not kept.";

ErrorLimit limit_of(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  ErrorLimit limit;
  if (equals != std::string::npos) limit.quantity = text.substr(0, equals);
  const auto number = parse_number(equals == std::string::npos ? text : text.substr(equals + 1));
  if (!number || *number <= 0)
    throw UsageError("'" + text + "' is not of the form [QUANTITY=]NUMBER");
  limit.value = *number;
  return limit;
}

Pose frame_of(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& part : split(text, ',')) {
    const bool degrees = part.ends_with("deg");
    const auto number = parse_number(degrees ? part.substr(0, part.size() - 3) : part);
    if (!number || (degrees && numbers.size() < 3))
      throw UsageError("'" + part + "' is not a number");
    numbers.push_back(degrees ? *number * std::numbers::pi / 180 : *number);
  }
  if (numbers.size() != 6) throw UsageError("'" + text + "' is not X,Y,Z,ROLL,PITCH,YAW");
  return {rotation_from_rpy(numbers[3], numbers[4], numbers[5]),
          Vec3(numbers[0], numbers[1], numbers[2])};
}

void add_frame_options(CommandLine& line, CompareOptions& options) {
  line.each("--ref-units", "UNITS", "Of columns that name none, e.g. mm (default SI)",
            [&options](const std::string& text) {
              for (const std::string& unit : split(text, ',')) {
                if (!si_unit(unit)) throw UsageError("'" + unit + "' is no known unit");
                options.reference_units.push_back(unit);
              }
            });
  line.each("--ref-frame", "X,Y,Z,R,P,Y",
            "Pose of the reference's frame in the run's world; angles in rad, or 90deg",
            [&options](const std::string& text) { options.reference_frame = frame_of(text); });
  line.one("--tangent", "AXIS", "Axis of the reference's attitudes along a rod: x or z (default)",
           [&options](const std::string& word) {
             if (word != "x" && word != "z") throw UsageError("'" + word + "' is none of x, z");
             options.tangent_is_x = word == "x";
           });
  const std::map<std::string, Alignment> alignments{{"none", Alignment::kNone},
                                                    {"translation", Alignment::kTranslation},
                                                    {"yaw", Alignment::kYaw},
                                                    {"se3", Alignment::kFull}};
  line.one("--align", "WHICH",
           "Move the reference to where it fits best: none, translation, yaw, se3",
           [&options, alignments](const std::string& word) {
             const auto found = alignments.find(word);
             if (found == alignments.end())
               throw UsageError("'" + word + "' is none of none, translation, yaw, se3");
             options.alignment = found->second;
           });
}

}  // namespace

std::variant<CompareOptions, int> parse_compare_options(const Words& words) {
  CompareOptions options;
  CommandLine line("cprsim compare", kAbout);
  line.argument("RUN", options.run, "Folder of a run, or a CSV, HDF5 or TUM file");
  line.argument("REFERENCE", options.reference, "CSV, HDF5 or TUM file");
  line.each("--of", "QUANTITY", "Compare only this, e.g. robot::platform.position",
            [&options](const std::string& text) { options.of.push_back(text); });
  line.each("--map", "NAME=REF", "The reference calls REF what the run calls NAME",
            [&options](const std::string& text) {
              const std::size_t equals = text.find('=');
              if (equals == std::string::npos || equals == 0)
                throw UsageError("'" + text + "' is not of the form NAME=REF");
              options.map.emplace_back(text.substr(0, equals), text.substr(equals + 1));
            });
  add_frame_options(line, options);
  line.flag("--apply-lag", options.apply_lag, "Shift the reference by the lag that is found");
  const auto positive = [](double value) { return value > 0; };
  line.number("--length", options.length, "Errors in m are per cent of this (default: rod)",
              "greater than 0", positive);
  for (const auto& [name, list] :
       {std::pair("--rms", &options.rms), std::pair("--max", &options.max)})
    line.each(name, "[QUANTITY=]X", "Largest error allowed, in the unit of the table",
              [list = list](const std::string& text) { list->push_back(limit_of(text)); });
  line.text("-o,--output", options.output, "DIR", "Folder (default out/<run>_compare)");
  add_console_options(line, options.console);
  if (const auto code = line.parse(words)) return *code;
  return options;
}

}  // namespace cprsim
