// SPDX-License-Identifier: BSD-3-Clause
// cprsim: which command is meant, and what becomes of what it throws.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <new>
#include <string_view>

#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/version.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

constexpr std::string_view kHelp =
    R"(cprsim - simulate continuum parallel robots from an SDF-like scene file, without a desktop

Examples
  cprsim new scene.xml                      a scene to start from, all effects as comments
  cprsim scene.xml                          run it: record, film, check as the scene says
  cprsim run scene.xml --duration 1 --with shear -o try
  cprsim check scenes/robots/*.xml          only validate
  cprsim test scenes                        run what they expect
  cprsim info scene.xml                     stiffness, frequencies, effects and their advisor
  cprsim solve scene.xml --pose robot::platform=0,0,0.4,0,10deg,0
  cprsim identify scene.xml tips.csv --fit rod/material/youngs_modulus
  cprsim workspace scene.xml --random 1000  what drives reach: stable, within limits
  cprsim compare out/planar measured.csv    RMS, maximum, lag, a picture
  cprsim sweep scene.xml                    what accuracy costs in time

Usage  cprsim [run] SCENE [options]
       cprsim COMMAND [options]

Commands
  run check info test      simulate, verify, look into a scene; scenes as tests
  solve modes path         equilibria, stability, natural frequencies, folds and branches
  identify workspace       fit values to measurements; what a robot reaches
  sweep effects            what accuracy and what each effect costs in time
  compare plot export      a run against a reference trajectory; plots; other formats
  render                   films and pictures of what was recorded, without running again
  new explain doctor       a scene to start from, what a code means, what this machine can do
  completion               words completed by bash, zsh or fish

Options
  -o, --output DIR   where results go (default out/<scene>)
      --set P=V      change any value of the scene, e.g. --set robot::leg_1/length=0.42
  -q, -v, --json     less, more, machine-readable
  -h, --help         this; 'cprsim COMMAND --help' for more
      --version

Exit codes
  0 done and all expectations met   1 an expectation is not met   2 wrong usage
  3 the scene is invalid            4 the simulation failed       5 files, pictures, machine
  70 a bug in cprsim                130, 143 interrupted
)";

struct Command {
  const char* name;
  int (*start)(const Words&);
};

constexpr std::array kCommands{Command{"run", run_command},
                               Command{"check", check_command},
                               Command{"info", info_command},
                               Command{"solve", solve_command},
                               Command{"modes", modes_command},
                               Command{"path", path_command},
                               Command{"workspace", workspace_command},
                               Command{"identify", identify_command},
                               Command{"compare", compare_command},
                               Command{"test", test_command},
                               Command{"sweep", sweep_command},
                               Command{"effects", effects_command},
                               Command{"plot", plot_command},
                               Command{"export", export_command},
                               Command{"render", render_command},
                               Command{"new", new_command},
                               Command{"explain", explain_command},
                               Command{"doctor", doctor_command}};

bool names_a_scene(const std::string& word) {
  const auto ends_in = [&](std::string_view end) { return word.ends_with(end); };
  return word == "-" || word.find('/') != std::string::npos || ends_in(".xml") || ends_in(".sdf") ||
         ends_in(".world") || std::filesystem::exists(word);
}

/// The index of the first word that is no option; options before it must be ones of every command.
std::size_t first_word(const Words& words) {
  std::size_t i = 0;
  while (i < words.size() && words[i].size() > 1 && words[i][0] == '-') {
    const std::string& option = words[i];
    const bool takes_value =
        option == "--color" || option == "--progress" || option == "--error-format";
    i += takes_value ? 2 : 1;
  }
  return i;
}

/// cprsim completion SHELL, and what the scripts ask for.
int complete(const Words& words) {
  const std::string what = words.size() > 1 ? words[1] : "";
  std::string text = shell_script(what);
  if (what == "commands")
    for (const Command& c : kCommands)
      text += std::string(text.empty() ? "" : " ") + c.name;
  if (what == "options" && words.size() == 3) {
    const auto command = std::find_if(kCommands.begin(), kCommands.end(),
                                      [&](const Command& c) { return words[2] == c.name; });
    if (command != kCommands.end()) return command->start({kListOptions});
  }
  if (text.empty()) {
    write_to_stderr("cprsim completion: for which shell? bash, zsh or fish\n");
    return kExitUsage;
  }
  write_to_stdout(text + (text.back() == '\n' ? "" : "\n"));
  return kExitDone;
}

int start(const Words& words) {
  if (words.empty()) {
    write_to_stderr(kHelp);
    return kExitUsage;
  }
  if (words[0] == "-h" || words[0] == "--help" || words[0] == "help") {
    write_to_stdout(kHelp);
    return kExitDone;
  }
  if (words[0] == "--version") {
    write_to_stdout(
        fmt::format("cprsim {} ({}, {})\n", version().number, version().revision, version().build));
    return kExitDone;
  }
  if (words[0] == "completion") return complete(words);
  const std::size_t first = first_word(words);
  const auto command = std::find_if(kCommands.begin(), kCommands.end(), [&](const Command& c) {
    return first < words.size() && words[first] == c.name;
  });
  if (command != kCommands.end()) {
    Words rest = words;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(first));
    return command->start(rest);
  }
  // an option of `run` may come first: cprsim --duration 1 scene.xml
  if (first != 0 || names_a_scene(words[0])) return run_command(words);
  std::vector<std::string> names;
  for (const Command& c : kCommands)
    names.emplace_back(c.name);
  write_to_stderr(
      fmt::format("cprsim: {}\nSee 'cprsim --help'.\n", not_one_of(words[0], "a command", names)));
  return kExitUsage;
}

int report_bug(const char* what) {
  write_to_stderr(fmt::format(
      "cprsim: internal error: {}\nThis is a bug in cprsim {} ({}). Please report it with "
      "the scene and the command line.\n",
      what, version().number, version().revision));
  return kExitInternalError;
}

}  // namespace

}  // namespace cprsim

int main(int count, char** arguments) {
  using namespace cprsim;
  claim_standard_streams();
  watch_signals();
  try {
    return start(Words(arguments + std::min(count, 1), arguments + count));
  } catch (const OutputError& error) {
    write_to_stderr(fmt::format("cprsim: error[{}]: {}\n", error.code(), error.what()));
    return kExitEnvironment;
  } catch (const std::runtime_error& error) {
    write_to_stderr(fmt::format("cprsim: error: {}\n", error.what()));
    return kExitEnvironment;
  } catch (const std::bad_alloc&) {
    write_to_stderr("cprsim: error: out of memory\n");
    return kExitEnvironment;
  } catch (const std::exception& error) {
    return report_bug(error.what());
  }
}
