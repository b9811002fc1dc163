// SPDX-License-Identifier: BSD-3-Clause
// cprsim doctor: can this machine draw and film, and which versions are at work.
#include <fmt/core.h>
#include <tinyxml2.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "render/film.h"
#include "render/renderer.h"
#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/version.h"
#include "tools/sinks/array_writer.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

struct Finding {
  bool good = true;
  std::string text;
};

Finding look_at_drawing() {
  std::string why_not;
  const auto renderer = Renderer::create(Scene{}, 64, 64, {}, why_not);
  if (renderer == nullptr) return {false, why_not};
  return {true, renderer->device()};
}

Finding look_at_filming() {
  const std::string why_not = film_unavailable();
  if (!why_not.empty()) return {false, why_not};
  return {true, "ffmpeg with libx264"};
}

std::string environment(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr ? value : "";
}

Json versions() {
  return {{"cprsim", std::string(version().number) + " (" + version().revision + ")"},
          {"build", version().build},
          {"Eigen",
           fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"tinyxml2", fmt::format("{}.{}.{}", TINYXML2_MAJOR_VERSION, TINYXML2_MINOR_VERSION,
                                   TINYXML2_PATCH_VERSION)},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                              FMT_VERSION % 100)},
          {"CLI11", CLI11_VERSION},
          {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                        NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
          {"NPZ", writes_npz() ? "built in" : "not built in (libminizip-dev)"},
          {"HDF5", hdf5_version().empty() ? "not built in (libhdf5-dev)" : hdf5_version()}};
}

}  // namespace

int doctor_command(const Words& words) {
  ConsoleOptions console_options;
  CommandLine line("cprsim doctor",
                   "Says what this machine can do: draw without a display, encode films.");
  add_console_options(line, console_options);
  if (const auto code = line.parse(words)) return *code;

  const Console console(console_options);
  const Finding drawing = look_at_drawing(), filming = look_at_filming();
  Json report = {{"schema", "cprsim-doctor/1"},
                 {"drawing", {{"works", drawing.good}, {"detail", drawing.text}}},
                 {"filming", {{"works", filming.good}, {"detail", filming.text}}},
                 {"versions", versions()},
                 {"environment", Json::object()}};
  for (const char* variable : {"CPRSIM_RESOURCE_PATH", "GZ_SIM_RESOURCE_PATH", "SDF_PATH",
                               "CPRSIM_OUTPUT_DIR", "CPRSIM_RENDER_DEVICE"}) {
    if (!environment(variable).empty()) report["environment"][variable] = environment(variable);
  }
  if (console.json()) write_to_stdout(report.dump(2) + "\n");

  const auto row = [](const char* what, const Finding& finding) {
    return fmt::format("{:<9} {:<8} {}\n", what, finding.good ? "works" : "missing", finding.text);
  };
  console.say(row("drawing", drawing) + row("filming", filming));
  for (const auto& [name, value] : report["versions"].items()) {
    console.say(fmt::format("{:<15} {}\n", name, value.get<std::string>()));
  }
  for (const auto& [name, value] : report["environment"].items()) {
    console.say(fmt::format("{}={}\n", name, value.get<std::string>()));
  }
  return drawing.good && filming.good ? kExitDone : kExitEnvironment;
}

}  // namespace cprsim
