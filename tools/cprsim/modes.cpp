// SPDX-License-Identifier: BSD-3-Clause
// cprsim modes: natural frequencies about the equilibrium, and a film of a mode.
#include "engine/study/modes.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "engine/study/stability.h"
#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/scene_options.h"
#include "tools/cprsim/static_words.h"
#include "tools/cprsim/study_command.h"
#include "tools/sinks/film_sink.h"
#include "tools/sinks/output_file.h"
#include "tools/sinks/view.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kFramesPerPeriod = 60;

struct ModesWords {
  std::string path;
  SceneOptions scene;
  ConsoleOptions console;
  int count = 6, film = 0;
  std::string video;
  std::optional<double> amplitude, at;
};

std::optional<int> read_words(ModesWords& w, const Words& words) {
  CommandLine line(
      "cprsim modes",
      "Natural frequencies and mode shapes of small vibration about the robot's equilibrium, "
      "without "
      "damping.\n\n"
      "Examples\n"
      "  cprsim modes scene.xml\n"
      "  cprsim modes scene.xml --count 12 --json\n"
      "  cprsim modes scene.xml --mode 2 --video mode_2.mp4 --amplitude 0.02");
  line.scene(w.path);
  line.count("--count", w.count, 1, "How many modes (default 6)");
  line.count("--mode", w.film, 1, "The mode that --video shows (default 1)");
  line.text("--video", w.video, "FILE", "Films two periods of a mode, slowed down to 4 s");
  line.number("--amplitude", w.amplitude,
              "Of the film: the farthest displacement (default: 5 % of the longest rod)",
              "of metres greater than 0", [](double a) { return a > 0; });
  line.number("--at", w.at, "Time at which drives and loads are read (default 0)", "of seconds",
              [](double t) { return t >= 0; });
  add_scene_options(line, w.scene);
  add_console_options(line, w.console);
  return line.parse(words);
}

double angular_rate(const VibrationMode& mode) {
  return std::sqrt(std::abs(mode.omega_squared));
}

/// What moves most: a link, or a rod between still ends.
std::string shape_of(const StaticStudy& study, const VibrationMode& mode) {
  std::string what;
  double most = 0;
  for (std::size_t b = 0; b < mode.bodies.size(); ++b) {
    const double size = mode.bodies[b].tail<3>().norm();
    if (size <= most) continue;
    most = size;
    const int link = study.robot().bodies[b].links.front();
    what = study.scene().bodies[static_cast<std::size_t>(link)].name;
  }
  for (std::size_t r = 0; r < mode.rods.size(); ++r)
    for (const Vec6& node : mode.rods[r]) {
      const double size = node.tail<3>().norm();
      if (size <= 1.02 * most) continue;
      most = size;
      what = study.scene().rods[r].name;
    }
  return what;
}

Json json_of(const StaticStudy& study, const std::vector<VibrationMode>& modes,
             const Stability& stability) {
  Json json = {{"schema", "cprsim-modes/1"},
               {"scene", {{"name", study.scene().name}, {"hash", study.scene().hash}}},
               {"stability", to_string(stability.verdict)},
               {"modes", Json::array()}};
  for (const VibrationMode& mode : modes) {
    Json one = {{"frequency_Hz", mode.frequency()},
                {"omega_squared", mode.omega_squared},
                {"moves_most", shape_of(study, mode)},
                {"bodies", Json::object()}};
    for (std::size_t b = 0; b < mode.bodies.size(); ++b) {
      const Vec6& m = mode.bodies[b];
      const int link = study.robot().bodies[b].links.front();
      one["bodies"][study.scene().bodies[static_cast<std::size_t>(link)].name] = {
          {"rotation", {m[0], m[1], m[2]}}, {"translation", {m[3], m[4], m[5]}}};
    }
    json["modes"].push_back(one);
  }
  return json;
}

void film(const StaticStudy& study, const VibrationMode& mode, const ModesWords& w) {
  double longest = 0;
  for (const RodSpec& rod : study.scene().rods)
    longest = std::max(longest, rod.length);
  const double amplitude = w.amplitude.value_or(0.05 * longest);
  VideoSpec video = video_or_default(study.scene());
  video.fps = 30;
  video.speed = 1;
  FilmSink sink(study.scene(), video, w.video, w.video);
  Snapshot before;
  for (int k = 0; k <= 2 * kFramesPerPeriod; ++k) {
    const double phase = 2 * std::numbers::pi * k / kFramesPerPeriod;
    Snapshot now = displaced(study, mode, amplitude * std::sin(phase));
    now.time = static_cast<double>(k) / video.fps;
    if (k == 0) sink.begin(now);
    if (k > 0) sink.step(before, now);
    before = std::move(now);
  }
  sink.finish();
}

int run(const ModesWords& w, const Scene& scene, const Console& console) {
  StaticStudy study(scene, w.at.value_or(0));
  require_equilibrium(study.solve());
  const int film_mode = std::max(1, w.film);
  const std::vector<VibrationMode> modes = natural_modes(study, std::max(w.count, film_mode));
  const Stability stability = judge(study);
  if (console.json()) write_to_stdout(json_of(study, modes, stability).dump(2) + "\n");
  std::string text = fmt::format(
      "{}: {} equilibrium, {} mode{}\n   mode   frequency [Hz]   omega [rad/s]   moves most\n",
      label_of(w.path, scene), to_string(stability.verdict), modes.size(),
      modes.size() == 1 ? "" : "s");
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const VibrationMode& mode = modes[i];
    text += mode.omega_squared > 0
                ? fmt::format("   {:4}   {:14.6f}   {:13.6f}   {}\n", i + 1, mode.frequency(),
                              angular_rate(mode), shape_of(study, mode))
                : fmt::format("   {:4}   grows with {:.4g} 1/s: unstable   {}\n", i + 1,
                              angular_rate(mode), shape_of(study, mode));
  }
  console.say(text);
  if (w.video.empty()) return kExitDone;
  if (static_cast<std::size_t>(film_mode) > modes.size())
    throw UsageError(fmt::format("--mode: there are only {} modes", modes.size()));
  film(study, modes[static_cast<std::size_t>(film_mode - 1)], w);
  console.say(fmt::format("  wrote {}\n", w.video));
  return kExitDone;
}

}  // namespace

int modes_command(const Words& words) {
  ModesWords w;
  if (const auto code = read_words(w, words)) return *code;
  const Console console(w.console);
  return answer(w.path, w.scene, console,
                [&](const Scene& scene) { return run(w, scene, console); });
}

}  // namespace cprsim
