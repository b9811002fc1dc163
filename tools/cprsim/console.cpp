// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/console.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

bool set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

bool dumb_terminal() {
  const char* term = std::getenv("TERM");
  return term != nullptr && std::string_view(term) == "dumb";
}

bool wants_color(When when) {
  if (when != When::kAuto) return when == When::kAlways;
  if (set("NO_COLOR")) return false;
  const char* force = std::getenv("CLICOLOR_FORCE");
  if (force != nullptr && *force != '\0' && std::string_view(force) != "0") return true;
  return isatty(STDERR_FILENO) != 0 && !dumb_terminal();
}

ProgressStyle choose_progress(const ConsoleOptions& options) {
  if (options.quiet > 0) return ProgressStyle::kNone;
  if (options.progress != ProgressStyle::kAuto) return options.progress;
  const bool terminal = isatty(STDERR_FILENO) != 0 && !dumb_terminal();
  return terminal ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

}  // namespace

Console::Console(const ConsoleOptions& options)
    : options_(options), progress_(choose_progress(options)), color_(wants_color(options.color)) {}

void Console::say(const std::string& text) const {
  if (options_.quiet == 0 && !options_.json) write_to_stdout(text);
}

void Console::remark(const std::string& text) const {
  if (options_.verbose) write_to_stderr(fmt::format("{}\n", text));
}

void Console::warn(const std::string& text) const {
  if (options_.quiet < 2) print("warning", "1;35", text);
}

void Console::error(const std::string& text) const {
  print("error", "1;31", text);
}

void Console::warn(const char* code, const std::string& text) const {
  if (options_.quiet < 2) print(fmt::format("warning[{}]", code), "1;35", text);
}

void Console::error(const char* code, const std::string& text) const {
  print(fmt::format("error[{}]", code), "1;31", text);
}

void Console::print(const std::string& word, const char* hue, const std::string& text) const {
  if (color_) {
    write_to_stderr(fmt::format("cprsim: \033[{}m{}:\033[0m {}\n", hue, word, text));
  } else {
    write_to_stderr(fmt::format("cprsim: {}: {}\n", word, text));
  }
}

void Console::show(const std::vector<Diagnostic>& diagnostics) const {
  std::vector<Diagnostic> shown;
  for (const Diagnostic& d : diagnostics) {
    if (d.severity == Severity::kNote && !options_.verbose) continue;
    if (d.severity == Severity::kWarning && options_.quiet > 1) continue;
    shown.push_back(d);
  }
  if (options_.error_format == ErrorFormat::kText) {
    write_to_stderr(to_text(shown, color_));
    return;
  }
  for (const Diagnostic& d : shown) {
    switch (options_.error_format) {
      case ErrorFormat::kJson:
        write_to_stderr(fmt::format("{}\n", to_json(d)));
        break;
      case ErrorFormat::kGithub:
        write_to_stderr(to_github(d));
        break;
      default:
        write_to_stderr(to_gcc(d));
        break;
    }
  }
}

}  // namespace cprsim
