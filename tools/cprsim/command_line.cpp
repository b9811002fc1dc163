// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/command_line.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <map>

#include "scenes/loader/suggest.h"
#include "tools/cprsim/exit_code.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

/// The whole of a text as a number, whatever the locale says about commas.
template <typename T>
std::optional<T> to_number(const std::string& text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
  return value;
}

template <typename Enum>
void add_choice(CLI::App& app, const std::string& name, Enum& value, const std::string& help,
                const std::map<std::string, Enum>& choices) {
  std::vector<std::string> words;
  for (const auto& [word, meaning] : choices)
    words.push_back(word);
  app.add_option_function<std::string>(
         name,
         [&value, choices, words, name](const std::string& word) {
           const auto found = choices.find(word);
           if (found == choices.end()) {
             throw CLI::ValidationError(
                 name, fmt::format("'{}' is none of {}", word, fmt::join(words, ", ")));
           }
           value = found->second;
         },
         help)
      ->type_name("WHICH");
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames())
      names.push_back("--" + name);
  }
  return names;
}

int complain(const CLI::App& app, const std::string& message) {
  fmt::print(stderr, "{}: {}\nSee '{} --help'.\n", app.get_name(), message, app.get_name());
  return kExitUsage;
}

}  // namespace

void add_console_options(CLI::App& app, ConsoleOptions& options) {
  app.add_flag("-q,--quiet", options.quiet, "No summary and no progress; twice: errors only");
  app.add_flag("-v,--verbose", options.verbose, "Also say what is merely worth knowing");
  app.add_flag("--json", options.json, "Results as JSON on standard output");
  add_choice<When>(app, "--color", options.color, "auto, always or never",
                   {{"auto", When::kAuto}, {"always", When::kAlways}, {"never", When::kNever}});
  add_choice<ProgressStyle>(app, "--progress", options.progress, "auto, bar, plain or none",
                            {{"auto", ProgressStyle::kAuto},
                             {"bar", ProgressStyle::kBar},
                             {"plain", ProgressStyle::kPlain},
                             {"none", ProgressStyle::kNone}});
  if (const char* github = std::getenv("GITHUB_ACTIONS"); github != nullptr && *github != '\0') {
    options.error_format = ErrorFormat::kGithub;
  }
  add_choice<ErrorFormat>(app, "--error-format", options.error_format, "text, gcc, json or github",
                          {{"text", ErrorFormat::kText},
                           {"gcc", ErrorFormat::kGcc},
                           {"json", ErrorFormat::kJson},
                           {"github", ErrorFormat::kGithub}});
}

void add_number(CLI::App& app, const std::string& name, std::optional<double>& value,
                const std::string& help, const std::string& demand,
                const std::function<bool(double)>& fits) {
  app.add_option_function<std::string>(
         name,
         [&value, name, demand, fits](const std::string& text) {
           value = to_number<double>(text);
           if (!value || !std::isfinite(*value) || !fits(*value)) {
             throw CLI::ValidationError(name, fmt::format("'{}' is not a number {}", text, demand));
           }
         },
         help)
      ->type_name("NUMBER");
}

void add_count(CLI::App& app, const std::string& name, int& value, int least,
               const std::string& help) {
  app.add_option_function<std::string>(
         name,
         [&value, name, least](const std::string& text) {
           const auto number = to_number<int>(text);
           if (!number || *number < least) {
             throw CLI::ValidationError(
                 name, fmt::format("'{}' is not a whole number from {} on", text, least));
           }
           value = *number;
         },
         help)
      ->type_name("N");
}

std::optional<unsigned> whole_number(const std::string& text) {
  return to_number<unsigned>(text);
}

std::optional<int> parse(CLI::App& app, const Words& words) {
  app.allow_extras();
  try {
    app.parse(Words(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    write_to_stdout(app.help());
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    return complain(app, error.what());
  }
  const Words left = app.remaining();
  for (const std::string& word : left) {
    if (word.size() > 1 && word[0] == '-') {
      return complain(app,
                      not_one_of(word.substr(0, word.find('=')), "an option", option_names(app)));
    }
  }
  if (!left.empty()) return complain(app, fmt::format("'{}' is one word too many", left.front()));
  return std::nullopt;
}

std::string not_one_of(const std::string& word, const std::string& noun,
                       const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(word, names);
  return fmt::format("'{}' is not {}", word, noun) +
         (nearest.empty() ? "" : ". Did you mean '" + nearest + "'?");
}

}  // namespace cprsim
