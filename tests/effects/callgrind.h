// SPDX-License-Identifier: BSD-3-Clause
// Instructions that a program executes, counted by valgrind's callgrind: by whole program, or one
// count for each call of a function.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cprsim {

/// Whether valgrind is installed; tests are skipped without.
bool has_callgrind();

constexpr const char* kNoCallgrind = "valgrind is not installed: no instructions are counted";

/// Instructions of one function itself, without those that it calls.
struct FunctionCost {
  std::string object;    ///< path of the program or library
  std::string function;  ///< as in the source, with its namespace
  long instructions = 0;
};

/// What callgrind's output file says.
std::vector<FunctionCost> read_callgrind(const std::filesystem::path& file);

/// Runs a program to its end and counts all it does. @param scratch a folder for what is written.
/// @return empty if the program does not end with exit code 0
std::vector<FunctionCost> instructions_of(const std::string& command,
                                          const std::filesystem::path& scratch);

/// What each call of an extern "C" function of a program executes, calls within included.
/// @param output what the program writes to its standard output
std::vector<long> instructions_of_calls(const std::string& command, const std::string& function,
                                        const std::filesystem::path& scratch, std::string& output);

}  // namespace cprsim
