// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/run_options.h"

#include <CLI/CLI.hpp>
#include <charconv>

#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

/// "shot.png@0.5" in two; an @ that no number follows belongs to the name.
StillOption to_still(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) return {text, std::nullopt};
  double time = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data() + at + 1, end, time);
  if (parsed.ec != std::errc{} || parsed.ptr != end || !(time >= 0)) return {text, std::nullopt};
  return {text.substr(0, at), time};
}

}  // namespace

std::variant<RunOptions, int> parse_run_options(const Words& words) {
  RunOptions options;
  CLI::App app(
      "Simulates a scene and records, films and checks what it asks for.\n\n"
      "Examples\n"
      "  cprsim scene.xml\n"
      "  cprsim run scene.xml --duration 1 --with shear -o try\n"
      "  cprsim run scene.xml --no-video --still shot.png@0.5",
      "cprsim run");
  app.add_option("SCENE", options.path, "The scene file; - reads standard input")
      ->required()
      ->type_name("");
  app.add_option("-o,--output", options.output, "Where results go (default out/<scene>)")
      ->type_name("DIR");
  add_scene_options(app, options.scene);
  CLI::Option* video = app.add_option("--video", options.video, "Film the run into this MP4 file");
  video->type_name("FILE");
  app.add_flag("--no-video", options.no_video, "Do not film, whatever the scene says")
      ->excludes(video);
  app.add_flag("--no-record", options.no_record, "Write no CSV and VTK files");
  app.add_option_function<std::vector<std::string>>(
         "--still",
         [&](const std::vector<std::string>& texts) {
           for (const std::string& text : texts)
             options.stills.push_back(to_still(text));
         },
         "A PNG picture at this time, or of the last state")
      ->type_name("FILE[@TIME]")
      ->allow_extra_args(false);
  add_number(app, "--max-wall", options.max_wall, "Stop after this many seconds of wall time",
             "greater than 0", [](double value) { return value > 0; });
  add_count(app, "-j,--jobs", options.jobs, 1, "At most this many threads draw the film");
  add_console_options(app, options.console);
  if (const auto code = parse(app, words)) return *code;
  return options;
}

std::vector<std::pair<std::string, std::string>> RunOptions::given() const {
  std::vector<std::pair<std::string, std::string>> list = cprsim::given(scene);
  if (!video.empty()) list.emplace_back("--video", video);
  if (no_video) list.emplace_back("--no-video", "");
  if (no_record) list.emplace_back("--no-record", "");
  if (max_wall) list.emplace_back("--max-wall", shortest(*max_wall));
  for (const StillOption& still : stills) {
    list.emplace_back("--still",
                      still.time ? still.file + "@" + shortest(*still.time) : still.file);
  }
  return list;
}

}  // namespace cprsim
