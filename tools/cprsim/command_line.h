// SPDX-License-Identifier: BSD-3-Clause
// Options that commands share, and parsing that answers in our words.
#pragma once

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/cprsim/console.h"

namespace CLI {
class App;
}

namespace cprsim {

/// Words that make sense to the parser and none here: exit code 2. Its text is for people.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using Words = std::vector<std::string>;

/// -q -v --json --color --progress --error-format
void add_console_options(CLI::App& app, ConsoleOptions& options);

/// An option with one number; `demand` ("greater than 0") is what `fits` tests and the complaint
/// says.
void add_number(CLI::App& app, const std::string& name, std::optional<double>& value,
                const std::string& help, const std::string& demand,
                const std::function<bool(double)>& fits);
void add_count(CLI::App& app, const std::string& name, int& value, int least,
               const std::string& help);

/// The whole text as a number from 0 on, or nothing.
std::optional<unsigned> whole_number(const std::string& text);

/// Parses the words after the command. @return the exit code if nothing is left to do: help was
/// asked for (0), or the words make no sense (2, and said so).
std::optional<int> parse(CLI::App& app, const Words& words);

/// "'rnu' is not a command. Did you mean 'run'?"
std::string not_one_of(const std::string& word, const std::string& noun,
                       const std::vector<std::string>& names);

}  // namespace cprsim
