// SPDX-License-Identifier: BSD-3-Clause
// Simulates robots that nobody designed (random_robot.h), each in a process of its own with a
// budget, and counts how they end. FOLDER/random_robots.csv has a line for each and is gone on with
// if it is there already; FOLDER/random_robots.md is made of it. Ends with 1 if one of them
// crashed, ran out of its budget, failed without a reason, or was called converged and is not.
//   cprsim_random_robots [--robots N] [--seed S] [--budget SECONDS] [--jobs N] FOLDER
//   cprsim_random_robots --show SEED        prints the scene
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/run/simulation.h"
#include "engine/study/static_study.h"
#include "scenes/loader/load.h"
#include "tests/bench/equilibrium_check.h"
#include "tests/bench/random_robot.h"

namespace cprsim {
namespace {

constexpr double kBalanced = 1e-6;  // of the force scale, and of the robot's length
constexpr double kEnergy = 0.1;     // missing of all energy that moved: the program warns

struct Options {
  std::string folder;
  std::uint64_t robots = 10000, seed = 1;
  unsigned budget = 60;  ///< s of CPU
  std::size_t jobs = 1;  ///< robots at a time
};

/// How a robot ended, as the child writes it: a letter and a reason.
enum class End : char {
  kDone = 'd',     ///< to the end
  kReason = 'r',   ///< with a typed reason
  kRefused = 'n',  ///< by the loader
  kWrong = 'w',    ///< converged, and out of balance
  kCrashed = 'c',
  kBudget = 'b'
};

struct Result {
  End end = End::kCrashed;
  std::string reason;
};

/// Numbers differ from robot to robot, reasons do not.
std::string without_numbers(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool digit = std::isdigit(static_cast<unsigned char>(text[i])) != 0;
    if (!digit)
      out += text[i];
    else if (out.empty() || out.back() != '#')
      out += '#';
  }
  return out.substr(0, out.find_first_of(";\n"));
}

Result solve_static(const Scene& scene) {
  StaticStudy study(scene);
  const SolveReport report = study.solve();
  if (!report.converged())
    return {End::kReason, std::string("statics: ") + to_string(report.status)};
  const EquilibriumCheck check = check_equilibrium(study);
  if (!(check.imbalance < kBalanced) || !(check.gap < kBalanced))
    return {End::kWrong, "statics: called converged and out of balance"};
  return {End::kDone, {}};
}

bool is_finite(const Snapshot& now) {
  for (const RodSample& rod : now.rods)
    for (const RodPoint& point : rod.points)
      if (!point.position.allFinite() || !point.force.allFinite()) return false;
  return std::isfinite(now.energy.total);
}

Result simulate(const Scene& scene, const RandomRobot& robot) {
  Simulation simulation(scene);
  simulation.start();
  double largest = 0;  // energy that moved
  const auto look = [&] {
    const EnergySample& e = simulation.now().energy;
    largest = std::max(largest, std::abs(e.kinetic) + std::abs(e.elastic) + std::abs(e.work) +
                                    std::abs(e.dissipated));
  };
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    look();
  }
  if (simulation.status() == RunStatus::kFailed) {
    if (simulation.failure().empty()) return {End::kWrong, "failed without a reason"};
    return {End::kReason, robot.mode + ": " + to_string(simulation.last_report().status)};
  }
  if (!is_finite(simulation.now())) return {End::kWrong, "done with numbers that are not finite"};
  const double balance = std::abs(simulation.now().energy.balance);
  const RobotScale& scale = simulation.robot().scale;
  const double noise = 1e-9 * scale.force * scale.length;
  if (robot.adaptive && balance > kEnergy * largest + noise)
    return {End::kReason, "dynamic: done, with a warning that the energy balance is open"};
  return {End::kDone, {}};
}

Result try_robot(const RandomRobot& robot) {
  const LoadResult loaded = load_scene_text(robot.text, "random.xml");
  if (!loaded.scene) {
    for (const Diagnostic& d : loaded.diagnostics)
      if (d.severity == Severity::kError)
        return {End::kRefused, d.code + " " + without_numbers(d.message)};
    return {End::kWrong, "refused without a reason"};
  }
  const bool at_rest = robot.mode == "static" && !robot.contact;  // studies see no contact
  return at_rest ? solve_static(*loaded.scene) : simulate(*loaded.scene, robot);
}

/// A robot at work in a process of its own, with limits, so that nothing that happens there ends
/// the count.
struct Child {
  std::uint64_t seed = 0;
  int answer = -1;  ///< end of a pipe
};

[[noreturn]] void be_child(const RandomRobot& robot, unsigned budget, int answer) {
  const rlimit time{budget, budget + 1};
  ::setrlimit(RLIMIT_CPU, &time);
  Result result;
  try {
    result = try_robot(robot);
  } catch (const std::exception& error) {
    result = {End::kCrashed, std::string("exception: ") + without_numbers(error.what())};
  }
  const std::string line = static_cast<char>(result.end) + result.reason;
  const ssize_t written = ::write(answer, line.data(), line.size());
  ::_exit(written == static_cast<ssize_t>(line.size()) ? 0 : 1);
}

pid_t start(std::uint64_t seed, unsigned budget, Child& child) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t id = ::fork();
  if (id < 0) throw std::runtime_error("no process");
  if (id == 0) be_child(random_robot(seed), budget, ends[1]);
  ::close(ends[1]);
  child = {seed, ends[0]};
  return id;
}

/// What a child that has ended said.
Result hear(const Child& child, int status) {
  std::string line(4096, '\0');
  const ssize_t read = ::read(child.answer, line.data(), line.size());
  ::close(child.answer);
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU || signal == SIGKILL) return {End::kBudget, "out of its budget"};
    return {End::kCrashed, std::string("signal ") + ::strsignal(signal)};
  }
  if (read < 1) return {End::kCrashed, "said nothing"};
  line.resize(static_cast<std::size_t>(read));
  return {static_cast<End>(line[0]), line.substr(1)};
}

struct Tally {
  std::map<End, std::uint64_t> all;
  std::map<std::string, std::map<End, std::uint64_t>> by_kind;
  std::map<std::pair<End, std::string>, std::vector<std::uint64_t>> reasons;  ///< seeds

  void add(const RandomRobot& robot, std::uint64_t seed, const Result& result) {
    ++all[result.end];
    ++by_kind["mode " + robot.mode][result.end];
    ++by_kind["method " + robot.method][result.end];
    ++by_kind[robot.contact ? "beside obstacles" : "without obstacles"][result.end];
    const int least = robot.rods < 3 ? 1 : robot.rods < 7 ? 3 : 7;
    ++by_kind[std::to_string(least) + (least == 1   ? " or 2 rods"
                                       : least == 3 ? " to 6 rods"
                                                    : " to 12 rods")][result.end];
    if (result.end != End::kDone) reasons[{result.end, result.reason}].push_back(seed);
  }
};

const std::pair<End, const char*> kEnds[] = {
    {End::kDone, "to the end"}, {End::kReason, "with a reason"}, {End::kRefused, "refused"},
    {End::kWrong, "wrong"},     {End::kCrashed, "crashed"},      {End::kBudget, "out of budget"}};

void write_page(const Options& options, const Tally& tally) {
  std::ofstream page(options.folder + "/random_robots.md");
  page << "# Robots that nobody designed\n\nMade by `cprsim_random_robots --robots "
       << options.robots << " --seed " << options.seed << " --budget " << options.budget
       << "` (tests/bench/random_robots.cpp; `--show SEED` prints a scene). Every robot has 1 to "
          "12 rods of "
          "radius 0.1 to 20 mm, 10 to 100,000 times as long, of 1 kPa to 400 GPa, all joints of "
          "rods and "
          "bodies, gravity, extension, shear, rotary inertia, damping, every method, most schemes, "
          "ten steps of 1e-5 to 5e-2 s, a third of them "
          "beside "
          "obstacles. Most are absurd: rods that weigh thousands of times what they can carry.\n\n"
          "An equilibrium is wrong if forces on a body, joint or rod do not sum up to zero within "
          "1e-6 of "
          "EI / L², a motion if its numbers are not finite.\n\n| robots | all |";
  for (const auto& [end, name] : kEnds)
    page << " " << name << " |";
  page << "\n|---|---|---|---|---|---|---|---|\n";
  const auto row = [&](const std::string& name, const std::map<End, std::uint64_t>& counts) {
    std::uint64_t sum = 0;
    for (const auto& [end, count] : counts)
      sum += count;
    page << "| " << name << " | " << sum << " |";
    for (const auto& [end, unused] : kEnds)
      page << " " << (counts.count(end) ? counts.at(end) : 0) << " |";
    page << "\n";
  };
  row("all", tally.all);
  for (const auto& [kind, counts] : tally.by_kind)
    row(kind, counts);
  page << "\n## Those that did not reach the end\n\n| how | reason | robots | seeds "
          "|\n|---|---|---|---|\n";
  for (const auto& [key, seeds] : tally.reasons) {
    const auto* name = std::find_if(std::begin(kEnds), std::end(kEnds),
                                    [&](const auto& entry) { return entry.first == key.first; });
    page << "| " << name->second << " | " << key.second << " | " << seeds.size() << " |";
    for (std::size_t i = 0; i < std::min<std::size_t>(seeds.size(), 3); ++i)
      page << " " << seeds[i];
    page << (seeds.size() > 3 ? " ... |\n" : " |\n");
  }
}

/// seed, letter, seconds, reason
struct Line {
  Result result;
  double seconds = 0;
};

std::map<std::uint64_t, Line> read_lines(const std::string& file) {
  std::map<std::uint64_t, Line> lines;
  std::ifstream stream(file);
  std::string text;
  while (std::getline(stream, text)) {
    std::istringstream words(text);
    std::uint64_t seed = 0;
    char end = 0, comma = 0;
    Line line;
    if (!(words >> seed >> comma >> end >> comma >> line.seconds >> comma)) continue;
    line.result.end = static_cast<End>(end);
    std::getline(words, line.result.reason);
    lines[seed] = line;
  }
  return lines;
}

/// Tries what has not been tried, several at a time, and writes down each as it ends.
void try_the_rest(const Options& options, const std::string& file,
                  std::map<std::uint64_t, Line>& lines) {
  std::ofstream log(file, std::ios::app);
  std::map<pid_t, Child> children;
  std::uint64_t next = options.seed;
  const std::uint64_t end = options.seed + options.robots;
  while (true) {
    while (next < end && children.size() < options.jobs) {
      const std::uint64_t seed = next++;
      if (lines.count(seed)) continue;
      Child child;
      const pid_t id = start(seed, options.budget, child);
      children[id] = child;
    }
    if (children.empty()) return;
    int status = 0;
    rusage used{};
    const pid_t ended = ::wait4(-1, &status, 0, &used);
    const auto at = children.find(ended);
    if (at == children.end()) continue;
    Line line;
    line.result = hear(at->second, status);
    line.seconds = static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                   1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    log << at->second.seed << "," << static_cast<char>(line.result.end) << "," << line.seconds
        << "," << line.result.reason << std::endl;
    lines[at->second.seed] = line;
    children.erase(at);
  }
}

int run(const Options& options) {
  const std::string file = options.folder + "/random_robots.csv";
  std::map<std::uint64_t, Line> lines = read_lines(file);
  try_the_rest(options, file, lines);
  Tally tally;
  for (std::uint64_t seed = options.seed; seed < options.seed + options.robots; ++seed)
    tally.add(random_robot(seed), seed, lines[seed].result);
  write_page(options, tally);
  for (const auto& [end, name] : kEnds)
    std::printf("%-14s %llu\n", name, static_cast<unsigned long long>(tally.all[end]));
  for (const auto& [key, seeds] : tally.reasons)
    if (key.first != End::kReason)
      std::printf("%c %s: %zu, first seed %llu\n", static_cast<char>(key.first), key.second.c_str(),
                  seeds.size(), static_cast<unsigned long long>(seeds[0]));
  return tally.all[End::kWrong] + tally.all[End::kCrashed] + tally.all[End::kBudget] > 0 ? 1 : 0;
}

}  // namespace
}  // namespace cprsim

int main(int argc, char** argv) {
  cprsim::Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] { return i + 1 < argc ? std::stoull(argv[++i]) : 0ULL; };
    if (word == "--show") {
      std::fputs(cprsim::random_robot(value()).text.c_str(), stdout);
      return 0;
    }
    if (word == "--robots")
      options.robots = value();
    else if (word == "--seed")
      options.seed = value();
    else if (word == "--budget")
      options.budget = static_cast<unsigned>(value());
    else if (word == "--jobs")
      options.jobs = std::max<std::size_t>(1, value());
    else
      options.folder = word;
  }
  if (options.folder.empty()) {
    std::fputs(
        "cprsim_random_robots [--robots N] [--seed S] [--budget SECONDS] [--jobs N] FOLDER\n",
        stderr);
    return 2;
  }
  return cprsim::run(options);
}
