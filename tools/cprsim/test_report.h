// SPDX-License-Identifier: BSD-3-Clause
// What became of scenes run as tests, told as text, JSON and JUnit XML.
#pragma once

#include <string>
#include <vector>

#include "tools/cprsim/expectations.h"

namespace cprsim {

enum class TestVerdict { kPassed, kFailed, kSkipped };

const char* to_string(TestVerdict verdict);

struct TestCase {
  std::string path;
  TestVerdict verdict = TestVerdict::kFailed;
  std::string message;  ///< why it failed or was skipped, or with which code it was rejected
  std::vector<ExpectResult> expectations;
  double seconds = 0;  ///< wall time
};

/// "PASS  scenes/a.xml  2 of 2 met", below it what is not met; one line or more.
std::string to_text(const TestCase& test);

/// "3 passed, 1 failed", ", 2 skipped" if there are any.
std::string closing_line(const std::vector<TestCase>& tests);

std::string to_json(const std::vector<TestCase>& tests);

/// The format that continuous integration reads: a suite, a case a scene.
std::string to_junit(const std::vector<TestCase>& tests);

}  // namespace cprsim
