// SPDX-License-Identifier: BSD-3-Clause
// Options that commands share, and parsing that answers in our words.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/cprsim/console.h"

namespace cprsim {

/// Words that make sense to the parser and none here: exit code 2. Its text is for people.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using Words = std::vector<std::string>;

/// What a command understands: its options are declared, then its words parsed into them. Wraps
/// CLI11, which takes seconds to compile in every file that sees it.
/// A command that is started with this word alone names its options; for `cprsim completion`.
constexpr const char* kListOptions = "--list-options";

class CommandLine {
 public:
  CommandLine(const std::string& name, const std::string& about);
  ~CommandLine();

  void scene(std::string& path);  ///< SCENE, required
  void argument(const std::string& name, std::string& value, const std::string& help);
  void arguments(const std::string& name, std::vector<std::string>& values, const std::string& help,
                 bool required);

  void flag(const std::string& name, bool& value, const std::string& help);
  void flag(const std::string& name, int& times, const std::string& help);
  void text(const std::string& name, std::string& value, const std::string& type,
            const std::string& help);
  /// May be given several times.
  void texts(const std::string& name, std::vector<std::string>& values, const std::string& type,
             const std::string& help);
  /// Separated by commas, or given several times.
  void list(const std::string& name, std::vector<std::string>& values, const std::string& type,
            const std::string& help);
  /// One finite number; `demand` ("greater than 0") is what `fits` tests and the complaint says.
  void number(const std::string& name, std::optional<double>& value, const std::string& help,
              const std::string& demand, const std::function<bool(double)>& fits);
  void count(const std::string& name, int& value, int least, const std::string& help);
  /// A text that is read as it comes; `read` may throw UsageError. `each` may be given several
  /// times.
  void one(const std::string& name, const std::string& type, const std::string& help,
           const std::function<void(const std::string&)>& read);
  void each(const std::string& name, const std::string& type, const std::string& help,
            const std::function<void(const std::string&)>& read);

  void require(const std::string& name);
  void exclude(const std::string& name, const std::string& other);

  /// @return the exit code if nothing is left to do: help was asked for (0), or the words make no
  /// sense (2, and said so)
  std::optional<int> parse(const Words& words);

 private:
  struct Parser;

  std::unique_ptr<Parser> parser_;
};

/// -q -v --json --color --progress --error-format
void add_console_options(CommandLine& line, ConsoleOptions& options);

/// The whole text as a number from 0 on, or nothing.
std::optional<unsigned> whole_number(const std::string& text);

/// "'rnu' is not a command. Did you mean 'run'?"
std::string not_one_of(const std::string& word, const std::string& noun,
                       const std::vector<std::string>& names);

}  // namespace cprsim
