// SPDX-License-Identifier: BSD-3-Clause
// cprsim check: reads and validates scenes, all mistakes of all files.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/scene_options.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

Json file_json(const std::string& path, const LoadedScene& loaded) {
  Json list = Json::array();
  for (const Diagnostic& d : loaded.diagnostics)
    list.push_back(Json::parse(to_json(d)));
  Json json = {{"path", path}, {"valid", loaded.scene != nullptr}, {"diagnostics", list}};
  if (!loaded.expected_failure.empty()) json["expected_failure"] = loaded.expected_failure;
  return json;
}

}  // namespace

int check_command(const Words& words) {
  std::vector<std::string> paths;
  SceneOptions options;
  ConsoleOptions console_options;
  CommandLine line(
      "cprsim check",
      "Reads and validates scenes without simulating them; tells all mistakes, not the first.\n\n"
      "Examples\n"
      "  cprsim check scenes/robots/*.xml\n"
      "  cprsim check scene.xml --with shear --error-format gcc");
  line.arguments("SCENE", paths, "Scene files; - reads standard input", true);
  add_scene_options(line, options);
  add_console_options(line, console_options);
  if (const auto code = line.parse(words)) return *code;

  const Console console(console_options);
  Json files = Json::array();
  std::size_t invalid = 0;
  for (const std::string& path : paths) {
    const LoadedScene loaded = load_and_show(path, options, console);
    const bool as_expected = loaded.rejected_as_expected();
    const bool valid = loaded.scene != nullptr && loaded.expected_failure.empty();
    if (!valid && !as_expected) ++invalid;
    files.push_back(file_json(path, loaded));
    if (valid) console.say(path + ": valid\n");
    if (as_expected) {
      console.say(
          fmt::format("{}: rejected with {}, as it expects\n", path, loaded.expected_failure));
    }
    if (!valid && loaded.scene != nullptr) {
      console.error(fmt::format("{} expects to be rejected with {}, but is valid", path,
                                loaded.expected_failure));
    }
  }
  if (console.json()) {
    const Json report = {{"schema", "cprsim-check/1"}, {"invalid", invalid}, {"files", files}};
    write_to_stdout(report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  }
  return invalid == 0 ? kExitDone : kExitSceneInvalid;
}

}  // namespace cprsim
