// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/workspace_options.h"

#include <fmt/core.h>

#include "scenes/loader/values.h"
#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

constexpr const char* kAbout =
    "Solves many equilibria and tells which are reached, stable and within limits. A grid or "
    "random\n"
    "points (--random) of drives, by default in the box of the joints' limits; with --pose a grid\n"
    "of poses of a frame, to which drives are found. Each point is solved from the scene alone.\n"
    "Writes points as CSV and VTK, a picture (SVG) and workspace.json.\n\n"
    "Examples\n"
    "  cprsim workspace robot.xml --vary robot::left=-1:1:41 --vary robot::right=-1:1:41\n"
    "  cprsim workspace robot.xml --random 10000 --seed 7 --max-effort 20 -j 4\n"
    "  cprsim workspace robot.xml --vary 'robot::leg_*=0.35:0.45' --random 1000\n"
    "  cprsim workspace robot.xml --pose robot::platform --vary x=-0.1:0.1:21 --vary z=0.3:0.5:21\n"
    "Freedoms of the frame that are not varied are held where the scene's equilibrium has them if\n"
    "there are six drives or more, else they are left free; --hold says otherwise.";

double number(const std::string& text) {
  const std::optional<double> value = parse_number(text);
  if (!value) throw UsageError("'" + text + "' is not a number");
  return *value;
}

VaryOption vary_of(const std::string& text) {
  VaryOption vary;
  const std::size_t equals = text.find('=');
  vary.name = text.substr(0, equals);
  if (vary.name.empty()) throw UsageError("'" + text + "' names nothing");
  if (equals == std::string::npos) return vary;
  const std::vector<std::string> parts = split(text.substr(equals + 1), ':');
  if (parts.size() < 2 || parts.size() > 3) {
    throw UsageError("'" + text + "' is not of the form NAME=LOW:HIGH[:COUNT]");
  }
  vary.low = number(parts[0]);
  vary.high = number(parts[1]);
  if (*vary.low > *vary.high) {
    throw UsageError("'" + text + "' ends below where it begins");
  }
  if (parts.size() == 3) {
    const auto count = whole_number(parts[2]);
    if (!count || *count < 1 || *count > 10000000) {
      throw UsageError("'" + parts[2] + "' is not a number of values");
    }
    vary.count = static_cast<int>(*count);
  }
  return vary;
}

NumberOption number_of(const std::string& text, bool name_first) {
  const std::size_t equals = text.find('=');
  NumberOption result;
  if (equals != std::string::npos) {
    result.name = text.substr(0, equals);
    result.value = number(text.substr(equals + 1));
  } else if (name_first) {
    result.name = text;
  } else {
    result.value = number(text);
  }
  return result;
}

void add_own_options(CommandLine& line, WorkspaceOptions& options) {
  line.each("--vary", "NAME[=LOW:HIGH[:COUNT]]",
            "A drive, or with --pose one of x y z roll pitch yaw; repeatable",
            [&options](const std::string& text) { options.vary.push_back(vary_of(text)); });
  line.count("--random", options.random, 1, "So many random points instead of a grid");
  line.text("--pose", options.pose, "FRAME", "Find drives that bring this frame to poses");
  line.each("--hold", "FREEDOM[=VALUE]", "With --pose: held, not free; 'none': all free",
            [&options](const std::string& text) {
              for (const std::string& part : split(text, ','))
                options.hold.push_back(number_of(part, true));
            });
  line.each("--drive", "ROD", "The length of an undriven rod is a drive, too",
            [&options](const std::string& text) { options.drives.push_back(text); });
  line.each("--max-effort", "[DRIVE=]NUMBER", "Flag points that need more, N or N m",
            [&options](const std::string& text) {
              options.max_effort.push_back(number_of(text, false));
              if (*options.max_effort.back().value < 0) {
                throw UsageError("'" + text + "' is below 0");
              }
            });
  line.text("--frame", options.frame, "FRAME", "Whose pose is told (default: what most rods hold)");
  line.one("--view", "PLANE", "Plane of the picture: xy, xz or yz (default: the widest)",
           [&options](const std::string& text) {
             if (text != "xy" && text != "xz" && text != "yz")
               throw UsageError("'" + text + "' is none of xy, xz, yz");
             options.view = text;
           });
  line.text("-o,--output", options.output, "DIR", "Folder (default out/<scene>_workspace)");
  line.flag("--resume", options.resume, "Go on where an interrupted one stopped");
  line.count("-j,--jobs", options.jobs, 1, "Threads (default: all cores)");
}

std::string range_text(const VaryOption& vary) {
  std::string text = vary.name;
  if (vary.low) text += "=" + shortest(*vary.low) + ":" + shortest(*vary.high);
  if (vary.count) text += ":" + std::to_string(*vary.count);
  return text;
}

std::string number_text(const NumberOption& option) {
  if (!option.value) return option.name;
  return (option.name.empty() ? "" : option.name + "=") + shortest(*option.value);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> WorkspaceOptions::given() const {
  auto list = cprsim::given(scene);
  for (const VaryOption& each : vary)
    list.emplace_back("--vary", range_text(each));
  if (random > 0) list.emplace_back("--random", std::to_string(random));
  for (const std::string& each : drives)
    list.emplace_back("--drive", each);
  if (!pose.empty()) list.emplace_back("--pose", pose);
  for (const NumberOption& each : hold)
    list.emplace_back("--hold", number_text(each));
  for (const NumberOption& each : max_effort)
    list.emplace_back("--max-effort", number_text(each));
  if (!frame.empty()) list.emplace_back("--frame", frame);
  if (!view.empty()) list.emplace_back("--view", view);
  return list;
}

std::variant<WorkspaceOptions, int> parse_workspace_options(const Words& words) {
  WorkspaceOptions options;
  CommandLine line("cprsim workspace", kAbout);
  line.scene(options.path);
  add_own_options(line, options);
  add_scene_options(line, options.scene);
  add_console_options(line, options.console);
  if (const auto code = line.parse(words)) return *code;
  return options;
}

}  // namespace cprsim
