// SPDX-License-Identifier: BSD-3-Clause
// cprsim test: scenes as tests, many at once.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <optional>

#include "scenes/loader/files.h"
#include "tools/cprsim/asked_run.h"
#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/run_report.h"
#include "tools/cprsim/scene_options.h"
#include "tools/cprsim/stopwatch.h"
#include "tools/cprsim/test_report.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

namespace fs = std::filesystem;

struct TestOptions {
  ConsoleOptions console;
  SceneOptions scene;
  std::vector<std::string> paths;
  std::string junit;
  int jobs = 0;
};

/// Scene files named, and those in and below folders that are; each once, folders sorted.
std::vector<std::string> scenes_in(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path)) {
      const std::string extension = entry.path().extension();
      const bool scene = extension == ".xml" || extension == ".sdf" || extension == ".world";
      if (scene && entry.is_regular_file()) found.push_back(entry.path().string());
    }
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  std::vector<std::string> unique;
  for (const std::string& file : files)
    if (std::find(unique.begin(), unique.end(), file) == unique.end()) unique.push_back(file);
  return unique;
}

void judge_rejection(const LoadedScene& loaded, TestCase& test) {
  if (loaded.rejected_as_expected()) {
    test.verdict = TestVerdict::kPassed;
    test.message = "rejected with " + loaded.expected_failure + ", as it expects";
  } else if (loaded.scene != nullptr) {
    test.message = "expects to be rejected with " + loaded.expected_failure + ", but is valid";
  } else if (!loaded.expected_failure.empty()) {
    test.message = "is rejected, but not with " + loaded.expected_failure + " as it expects";
  } else {
    test.message = "the scene is invalid";
  }
}

void judge_run(const Scene& scene, TestCase& test) {
  std::optional<Expectations> expectations;
  const auto judge = [&] {
    expectations.emplace(scene);
    return onlooker(*expectations);
  };
  const QuietRun run = run_as_asked(scene, judge, [] { return stop_signal() != 0; }).last;
  test.expectations = expectations->results(run.status == RunStatus::kDone);
  const bool met =
      std::all_of(test.expectations.begin(), test.expectations.end(),
                  [](const ExpectResult& result) { return result.verdict == Verdict::kMet; });
  if (run.status == RunStatus::kFailed)
    test.message = fmt::format("failed at t = {:.6g} s: {}", run.time, run.failure);
  if (run.status == RunStatus::kRunning) test.message = "interrupted";
  if (met && run.status == RunStatus::kDone) test.verdict = TestVerdict::kPassed;
}

TestCase run_test(const std::string& path, const TestOptions& options, const Console& console) {
  const Stopwatch watch;
  TestCase test;
  test.path = path;
  if (read_file(path).text.find("cprsim:expect") == std::string::npos && fs::exists(path)) {
    test.verdict = TestVerdict::kSkipped;
    test.message = "it expects nothing";
    return test;
  }
  const LoadedScene loaded = load_and_show(path, options.scene, console);
  try {
    if (loaded.scene == nullptr || !loaded.expected_failure.empty())
      judge_rejection(loaded, test);
    else
      judge_run(*loaded.scene, test);
  } catch (const std::exception& error) {
    test.message = error.what();
  }
  test.seconds = watch.seconds();
  return test;
}

/// Complaints of a scene that is to be rejected are no news.
ConsoleOptions while_testing(ConsoleOptions options) {
  if (!options.verbose) options.quiet = std::max(options.quiet, 2);
  return options;
}

std::vector<TestCase> run_all(const std::vector<std::string>& paths, const TestOptions& options,
                              const Console& console) {
  const Console quiet(while_testing(options.console));
  std::vector<TestCase> tests(paths.size());
  std::vector<bool> done(paths.size(), false);
  std::size_t told = 0;
  std::mutex one_at_a_time;
  on_threads(paths.size(), options.jobs, [&](std::size_t i) {
    if (stop_signal() != 0) return;
    TestCase test = run_test(paths[i], options, quiet);
    const std::lock_guard lock(one_at_a_time);
    tests[i] = std::move(test);
    done[i] = true;
    // in order, as soon as all before it are known
    for (; told < done.size() && done[told]; ++told)
      console.say(to_text(tests[told]));
  });
  return tests;
}

}  // namespace

int test_command(const Words& words) {
  TestOptions options;
  CommandLine line(
      "cprsim test",
      "Runs scenes as tests: each must come to its end and meet its <cprsim:expect>, or be "
      "rejected "
      "with the code that it names (<fails with=\"E301\"/>). Scenes that expect nothing are "
      "skipped.\n\n"
      "Examples\n"
      "  cprsim test scenes\n"
      "  cprsim test scenes/robots/*.xml --junit report.xml -j 4");
  line.arguments("SCENE", options.paths, "Scene files, or folders of them", true);
  line.text("--junit", options.junit, "FILE", "Write a report for continuous integration");
  line.count("-j,--jobs", options.jobs, 1, "Threads (default: all cores)");
  add_scene_options(line, options.scene);
  add_console_options(line, options.console);
  if (const auto code = line.parse(words)) return *code;

  const Console console(options.console);
  const std::vector<std::string> paths = scenes_in(options.paths);
  if (paths.empty()) {
    console.error("there is no scene in " + options.paths.front());
    return kExitUsage;
  }
  const std::vector<TestCase> tests = run_all(paths, options, console);
  if (stop_signal() != 0) return 128 + stop_signal();
  if (!options.junit.empty()) write_file(options.junit, to_junit(tests));
  if (console.json()) write_to_stdout(to_json(tests));
  console.say(closing_line(tests));
  const bool failed = std::any_of(tests.begin(), tests.end(), [](const TestCase& test) {
    return test.verdict == TestVerdict::kFailed;
  });
  return failed ? kExitExpectationFailed : kExitDone;
}

}  // namespace cprsim
