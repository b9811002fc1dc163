// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/run_options.h"

#include "scenes/loader/values.h"
#include "tools/sinks/csv.h"

namespace cprsim {

StillOption to_still(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) return {text, std::nullopt};
  const std::optional<double> time = parse_number(text.substr(at + 1));
  if (!time || *time < 0) return {text, std::nullopt};
  return {text.substr(0, at), time};
}

std::variant<RunOptions, int> parse_run_options(const Words& words) {
  RunOptions options;
  CommandLine line("cprsim run",
                   "Simulates a scene and records, films and checks what it asks for.\n\n"
                   "Examples\n"
                   "  cprsim run scene.xml --duration 1 --with shear -o try\n"
                   "  cprsim run scene.xml --no-video --still shot.png@0.5");
  line.scene(options.path);
  line.text("-o,--output", options.output, "DIR", "Where results go (default out/<scene>)");
  add_scene_options(line, options.scene);
  line.text("--video", options.video, "FILE", "Film the run into this MP4 file");
  line.flag("--no-video", options.no_video, "Do not film, whatever the scene says");
  line.exclude("--no-video", "--video");
  line.flag("--no-record", options.no_record, "Write no recordings (CSV, HDF5, NPZ, VTK, glTF)");
  line.each("--still", "FILE[@TIME]", "A PNG picture at this time, or of the last state",
            [&](const std::string& text) { options.stills.push_back(to_still(text)); });
  line.number("--max-wall", options.max_wall, "Stop after this many seconds of wall time",
              "greater than 0", [](double value) { return value > 0; });
  line.number("--real-time-factor", options.real_time_factor,
              "Find the most accurate settings that simulate so many seconds in one",
              "greater than 0", [](double value) { return value > 0; });
  line.number("--checkpoint-every", options.checkpoint_every,
              "Write the state to DIR/checkpoint.state every so many simulated seconds",
              "greater than 0", [](double value) { return value > 0; });
  line.text("--from", options.from, "STATE", "Go on from a state file, bit for bit");
  line.flag("--hash", options.hash, "Print a hash of the state after each step");
  line.flag("--profile", options.profile, "Say where the wall time went, phase by phase");
  line.text("--trace", options.trace, "FILE",
            "Write every phase of every step, for chrome://tracing or ui.perfetto.dev");
  line.count("-j,--jobs", options.jobs, 1, "At most this many threads draw the film");
  add_console_options(line, options.console);
  if (const auto code = line.parse(words)) return *code;
  return options;
}

std::vector<std::pair<std::string, std::string>> RunOptions::given() const {
  std::vector<std::pair<std::string, std::string>> list = cprsim::given(scene);
  if (!video.empty()) list.emplace_back("--video", video);
  if (no_video) list.emplace_back("--no-video", "");
  if (no_record) list.emplace_back("--no-record", "");
  if (max_wall) list.emplace_back("--max-wall", shortest(*max_wall));
  if (real_time_factor) list.emplace_back("--real-time-factor", shortest(*real_time_factor));
  if (!from.empty()) list.emplace_back("--from", from);
  for (const StillOption& still : stills) {
    list.emplace_back("--still",
                      still.time ? still.file + "@" + shortest(*still.time) : still.file);
  }
  return list;
}

}  // namespace cprsim
