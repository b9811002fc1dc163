// SPDX-License-Identifier: BSD-3-Clause
#include "tests/effects/callgrind.h"

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numeric>

#include "tests/tools/scratch_folder.h"

namespace cprsim {
namespace {

/// Names stand in the file as "(7) name" at first and "(7)" from then on.
class Names {
 public:
  std::string read(const std::string& text) {
    const std::size_t end = text.find(')');
    if (text.empty() || text[0] != '(' || end == std::string::npos) return text;
    std::string& name = names_[text.substr(0, end)];
    if (end + 2 < text.size()) name = text.substr(end + 2);
    return name;
  }

 private:
  std::map<std::string, std::string> names_;
};

bool is_cost(const std::string& line) {
  return !line.empty() && (std::isdigit(static_cast<unsigned char>(line[0])) != 0 ||
                           line[0] == '+' || line[0] == '-' || line[0] == '*');
}

int run(const std::string& command) {
  return std::system(command.c_str());
}

std::string valgrind(const std::filesystem::path& scratch, const std::string& options) {
  return "cd '" + scratch.string() +
         "' && valgrind --quiet --tool=callgrind --callgrind-out-file=counts " + options + " ";
}

}  // namespace

bool has_callgrind() {
  static const bool kFound = run("valgrind --version >/dev/null 2>&1") == 0;
  return kFound;
}

std::vector<FunctionCost> read_callgrind(const std::filesystem::path& file) {
  std::ifstream stream(file);
  Names objects, functions;
  std::string object, function;
  std::map<std::pair<std::string, std::string>, long> sums;
  for (std::string line; std::getline(stream, line);) {
    const std::size_t equals = line.find('=');
    const std::string key = line.substr(0, equals),
                      rest = equals == std::string::npos ? "" : line.substr(equals + 1);
    if (key == "ob") object = objects.read(rest);
    if (key == "cob") objects.read(rest);
    if (key == "fn") function = functions.read(rest);
    if (key == "cfn") functions.read(rest);
    // the line after it is what the call costs, which the callee has already counted
    if (key == "calls") std::getline(stream, line);
    if (key == "calls" || !is_cost(line)) continue;
    sums[{object, function}] += std::strtol(line.substr(line.find(' ') + 1).c_str(), nullptr, 10);
  }
  std::vector<FunctionCost> costs;
  for (const auto& [name, sum] : sums)
    costs.push_back({name.first, name.second, sum});
  return costs;
}

std::vector<FunctionCost> instructions_of(const std::string& command,
                                          const std::filesystem::path& scratch) {
  if (run(valgrind(scratch, "") + command + " >out.txt 2>err.txt") != 0) return {};
  return read_callgrind(scratch / "counts");
}

std::vector<long> instructions_of_calls(const std::string& command, const std::string& function,
                                        const std::filesystem::path& scratch, std::string& output) {
  const std::string only = "--toggle-collect=" + function + " --dump-after=" + function;
  std::vector<long> counts;
  if (run(valgrind(scratch, only) + command + " >out.txt 2>err.txt") != 0) return counts;
  output = contents(scratch / "out.txt");
  // one file for each call; the last, without a number, holds what came after them
  for (int part = 1;; ++part) {
    const std::filesystem::path file = scratch / ("counts." + std::to_string(part));
    if (!std::filesystem::exists(file)) return counts;
    const std::vector<FunctionCost> costs = read_callgrind(file);
    counts.push_back(std::accumulate(
        costs.begin(), costs.end(), 0L,
        [](long sum, const FunctionCost& cost) { return sum + cost.instructions; }));
  }
}

}  // namespace cprsim
