// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/compare_options.h"

#include <CLI/CLI.hpp>
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
    "RUN is the folder of a run, a CSV file or a TUM trajectory, REFERENCE a CSV or TUM file "
    "whose\n"
    "columns have the run's names, or end like them (position.x, orientation.w).\n\n"
    "Examples\n"
    "  cprsim compare out/planar measured.csv --max 0.002\n"
    "  cprsim compare out/planar mocap.tum --map robot::platform= --align yaw --apply-lag\n"
    "  cprsim compare a.csv b.csv --of robot::platform.position --rms 1e-4 --json\n"
    "Exit code 1 if a limit of --rms or --max is not kept.";

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

void add_texts(CLI::App& app, const std::string& name, const std::string& type,
               const std::string& help, const std::function<void(const std::string&)>& take) {
  app.add_option_function<std::vector<std::string>>(
         name,
         [take](const std::vector<std::string>& texts) {
           for (const std::string& text : texts)
             take(text);
         },
         help)
      ->type_name(type)
      ->allow_extra_args(false);
}

ErrorLimit limit_of(const std::string& option, const std::string& text) {
  const std::size_t equals = text.rfind('=');
  ErrorLimit limit;
  if (equals != std::string::npos) limit.quantity = text.substr(0, equals);
  const auto number = parse_number(equals == std::string::npos ? text : text.substr(equals + 1));
  if (!number || *number <= 0)
    throw CLI::ValidationError(option, "'" + text + "' is not of the form [QUANTITY=]NUMBER");
  limit.value = *number;
  return limit;
}

Pose frame_of(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& part : split(text)) {
    const bool degrees = part.ends_with("deg");
    const auto number = parse_number(degrees ? part.substr(0, part.size() - 3) : part);
    if (!number || (degrees && numbers.size() < 3))
      throw CLI::ValidationError("--ref-frame", "'" + part + "' is not a number");
    numbers.push_back(degrees ? *number * std::numbers::pi / 180 : *number);
  }
  if (numbers.size() != 6)
    throw CLI::ValidationError("--ref-frame", "'" + text + "' is not X,Y,Z,ROLL,PITCH,YAW");
  return {rotation_from_rpy(numbers[3], numbers[4], numbers[5]),
          Vec3(numbers[0], numbers[1], numbers[2])};
}

void add_frame_options(CLI::App& app, CompareOptions& options) {
  add_texts(app, "--ref-units", "UNITS", "Of columns that name none, e.g. mm (default SI)",
            [&options](const std::string& text) {
              for (const std::string& unit : split(text)) {
                if (!si_unit(unit))
                  throw CLI::ValidationError("--ref-units", "'" + unit + "' is no known unit");
                options.reference_units.push_back(unit);
              }
            });
  add_texts(app, "--ref-frame", "X,Y,Z,R,P,Y",
            "Pose of the reference's frame in the run's world; angles in rad, or 90deg",
            [&options](const std::string& text) { options.reference_frame = frame_of(text); });
  app.add_option_function<std::string>(
         "--tangent",
         [&options](const std::string& word) {
           if (word != "x" && word != "z")
             throw CLI::ValidationError("--tangent", "'" + word + "' is none of x, z");
           options.tangent_is_x = word == "x";
         },
         "Axis of the reference's attitudes along a rod: x or z (default)")
      ->type_name("AXIS");
  const std::map<std::string, Alignment> alignments{{"none", Alignment::kNone},
                                                    {"translation", Alignment::kTranslation},
                                                    {"yaw", Alignment::kYaw},
                                                    {"se3", Alignment::kFull}};
  app.add_option_function<std::string>(
         "--align",
         [&options, alignments](const std::string& word) {
           const auto found = alignments.find(word);
           if (found == alignments.end())
             throw CLI::ValidationError("--align",
                                        "'" + word + "' is none of none, translation, yaw, se3");
           options.alignment = found->second;
         },
         "Move the reference to where it fits best: none, translation, yaw, se3")
      ->type_name("WHICH");
}

}  // namespace

std::variant<CompareOptions, int> parse_compare_options(const Words& words) {
  CompareOptions options;
  CLI::App app(kAbout, "cprsim compare");
  app.add_option("RUN", options.run, "Folder of a run, or a CSV or TUM file")
      ->required()
      ->type_name("");
  app.add_option("REFERENCE", options.reference, "CSV or TUM file")->required()->type_name("");
  add_texts(app, "--of", "QUANTITY", "Compare only this, e.g. robot::platform.position",
            [&options](const std::string& text) { options.of.push_back(text); });
  add_texts(app, "--map", "NAME=REF", "The reference calls REF what the run calls NAME",
            [&options](const std::string& text) {
              const std::size_t equals = text.find('=');
              if (equals == std::string::npos || equals == 0)
                throw CLI::ValidationError("--map", "'" + text + "' is not of the form NAME=REF");
              options.map.emplace_back(text.substr(0, equals), text.substr(equals + 1));
            });
  add_frame_options(app, options);
  app.add_flag("--apply-lag", options.apply_lag, "Shift the reference by the lag that is found");
  const auto positive = [](double value) { return value > 0; };
  add_number(app, "--length", options.length, "Errors in m are per cent of this (default: rod)",
             "greater than 0", positive);
  for (const auto& [name, list] :
       {std::pair("--rms", &options.rms), std::pair("--max", &options.max)})
    add_texts(app, name, "[QUANTITY=]X", "Largest error allowed, in the unit of the table",
              [name = std::string(name), list = list](const std::string& text) {
                list->push_back(limit_of(name, text));
              });
  app.add_option("-o,--output", options.output, "Folder (default out/<run>_compare)")
      ->type_name("DIR");
  add_console_options(app, options.console);
  if (const auto code = parse(app, words)) return *code;
  return options;
}

}  // namespace cprsim
