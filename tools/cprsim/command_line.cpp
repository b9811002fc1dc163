// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/command_line.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <map>

#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"
#include "tools/cprsim/exit_code.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

template <typename Enum>
void add_choice(CommandLine& line, const std::string& name, Enum& value, const std::string& help,
                const std::map<std::string, Enum>& choices) {
  line.one(name, "WHICH", help, [&value, choices](const std::string& word) {
    const auto found = choices.find(word);
    if (found == choices.end()) {
      std::vector<std::string> words;
      for (const auto& [choice, meaning] : choices)
        words.push_back(choice);
      throw UsageError(fmt::format("'{}' is none of {}", word, fmt::join(words, ", ")));
    }
    value = found->second;
  });
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames())
      names.push_back("--" + name);
  }
  return names;
}

/// @param name as it was declared: "-j,--jobs"
CLI::Option* option_named(CLI::App& app, const std::string& name) {
  return app.get_option(name.substr(name.rfind(',') + 1));
}

int complain(const CLI::App& app, const std::string& message) {
  write_to_stderr(
      fmt::format("{}: {}\nSee '{} --help'.\n", app.get_name(), message, app.get_name()));
  return kExitUsage;
}

}  // namespace

struct CommandLine::Parser {
  CLI::App app;
  std::vector<std::pair<std::string, std::string>> exclusive;  ///< not CLI11's: it widens the help
};

namespace {

/// At commas, but not at that of contact(a,b).
std::vector<std::string> split_outside_parentheses(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

}  // namespace

CommandLine::CommandLine(const std::string& name, const std::string& about)
    : parser_(std::make_unique<Parser>()) {
  parser_->app.name(name);
  parser_->app.description(about);
}

CommandLine::~CommandLine() = default;

void CommandLine::scene(std::string& path) {
  argument("SCENE", path, "The scene file; - reads standard input");
}

void CommandLine::argument(const std::string& name, std::string& value, const std::string& help) {
  parser_->app.add_option(name, value, help)->required()->type_name("");
}

void CommandLine::arguments(const std::string& name, std::vector<std::string>& values,
                            const std::string& help, bool required) {
  parser_->app.add_option(name, values, help)->required(required)->type_name("...");
}

void CommandLine::flag(const std::string& name, bool& value, const std::string& help) {
  parser_->app.add_flag(name, value, help);
}

void CommandLine::flag(const std::string& name, int& times, const std::string& help) {
  parser_->app.add_flag(name, times, help);
}

void CommandLine::text(const std::string& name, std::string& value, const std::string& type,
                       const std::string& help) {
  parser_->app.add_option(name, value, help)->type_name(type);
}

void CommandLine::texts(const std::string& name, std::vector<std::string>& values,
                        const std::string& type, const std::string& help) {
  parser_->app.add_option(name, values, help)->type_name(type)->allow_extra_args(false);
}

void CommandLine::list(const std::string& name, std::vector<std::string>& values,
                       const std::string& type, const std::string& help) {
  each(name, type, help, [&values](const std::string& text) {
    for (std::string& part : split_outside_parentheses(text))
      values.push_back(std::move(part));
  });
}

void CommandLine::one(const std::string& name, const std::string& type, const std::string& help,
                      const std::function<void(const std::string&)>& read) {
  each(name, type, help, read);
  option_named(parser_->app, name)->expected(1);
}

void CommandLine::each(const std::string& name, const std::string& type, const std::string& help,
                       const std::function<void(const std::string&)>& read) {
  const auto read_all = [name, read](const std::vector<std::string>& texts) {
    try {
      for (const std::string& text : texts)
        read(text);
    } catch (const UsageError& error) {
      throw CLI::ValidationError(name, error.what());
    }
  };
  parser_->app.add_option_function<std::vector<std::string>>(name, read_all, help)
      ->type_name(type)
      ->allow_extra_args(false);
}

void CommandLine::number(const std::string& name, std::optional<double>& value,
                         const std::string& help, const std::string& demand,
                         const std::function<bool(double)>& fits) {
  one(name, "NUMBER", help, [&value, demand, fits](const std::string& text) {
    value = parse_number(text);
    if (!value || !fits(*value))
      throw UsageError(fmt::format("'{}' is not a number {}", text, demand));
  });
}

void CommandLine::count(const std::string& name, int& value, int least, const std::string& help) {
  one(name, "N", help, [&value, least](const std::string& text) {
    const auto number = parse_integer(text);
    if (!number || *number < least || *number > std::numeric_limits<int>::max())
      throw UsageError(fmt::format("'{}' is not a whole number from {} on", text, least));
    value = static_cast<int>(*number);
  });
}

void CommandLine::require(const std::string& name) {
  option_named(parser_->app, name)->required();
}

void CommandLine::exclude(const std::string& name, const std::string& other) {
  parser_->exclusive.emplace_back(name, other);
}

std::optional<int> CommandLine::parse(const Words& words) {
  CLI::App& app = parser_->app;
  if (words == Words{kListOptions}) {
    write_to_stdout(fmt::format("{}\n", fmt::join(option_names(app), " ")));
    return kExitDone;
  }
  app.allow_extras();
  try {
    app.parse(Words(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    write_to_stdout(app.help());
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    return complain(app, error.what());
  }
  for (const auto& [name, other] : parser_->exclusive)
    if (app.count(name) > 0 && app.count(other) > 0)
      return complain(app, fmt::format("{} excludes {}", name, other));
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

void add_console_options(CommandLine& line, ConsoleOptions& options) {
  line.flag("-q,--quiet", options.quiet, "No summary and no progress; twice: errors only");
  line.flag("-v,--verbose", options.verbose, "Also say what is merely worth knowing");
  line.flag("--json", options.json, "Results as JSON on standard output");
  add_choice<When>(line, "--color", options.color, "auto, always or never",
                   {{"auto", When::kAuto}, {"always", When::kAlways}, {"never", When::kNever}});
  add_choice<ProgressStyle>(line, "--progress", options.progress, "auto, bar, plain or none",
                            {{"auto", ProgressStyle::kAuto},
                             {"bar", ProgressStyle::kBar},
                             {"plain", ProgressStyle::kPlain},
                             {"none", ProgressStyle::kNone}});
  if (const char* github = std::getenv("GITHUB_ACTIONS"); github != nullptr && *github != '\0') {
    options.error_format = ErrorFormat::kGithub;
  }
  add_choice<ErrorFormat>(line, "--error-format", options.error_format, "text, gcc, json or github",
                          {{"text", ErrorFormat::kText},
                           {"gcc", ErrorFormat::kGcc},
                           {"json", ErrorFormat::kJson},
                           {"github", ErrorFormat::kGithub}});
}

std::optional<unsigned> whole_number(const std::string& text) {
  const auto number = parse_integer(text);
  if (!number || *number < 0 || *number > std::numeric_limits<unsigned>::max()) return std::nullopt;
  return static_cast<unsigned>(*number);
}

std::string not_one_of(const std::string& word, const std::string& noun,
                       const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(word, names);
  return fmt::format("'{}' is not {}", word, noun) +
         (nearest.empty() ? "" : ". Did you mean '" + nearest + "'?");
}

}  // namespace cprsim
