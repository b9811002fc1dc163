// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/test_report.h"

#include <fmt/core.h>
#include <tinyxml2.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/cprsim/run_report.h"

namespace cprsim {

namespace {

long count(const std::vector<TestCase>& tests, TestVerdict verdict) {
  return std::count_if(tests.begin(), tests.end(),
                       [&](const TestCase& test) { return test.verdict == verdict; });
}

/// Lines about what is not met; empty if everything is.
std::string complaints(const TestCase& test) {
  std::string text;
  for (const ExpectResult& result : test.expectations) {
    if (result.verdict == Verdict::kMet) continue;
    text += fmt::format("{}: '{}'\n", to_string(result.verdict), result.name);
    for (const CheckResult& check : result.checks)
      if (check.verdict == Verdict::kNotMet) text += "  " + describe(check) + "\n";
  }
  return text;
}

std::string indented(const std::string& text) {
  std::string out = "        ";
  for (const char c : text.substr(0, text.size() - 1))
    out += c == '\n' ? std::string("\n        ") : std::string(1, c);
  return out + "\n";
}

}  // namespace

const char* to_string(TestVerdict verdict) {
  switch (verdict) {
    case TestVerdict::kPassed:
      return "passed";
    case TestVerdict::kFailed:
      return "failed";
    case TestVerdict::kSkipped:
      return "skipped";
  }
  return "";
}

std::string to_text(const TestCase& test) {
  const char* word = test.verdict == TestVerdict::kPassed   ? "PASS"
                     : test.verdict == TestVerdict::kFailed ? "FAIL"
                                                            : "SKIP";
  std::string text = fmt::format("{}  {}", word, test.path);
  if (!test.expectations.empty()) {
    const auto met =
        std::count_if(test.expectations.begin(), test.expectations.end(),
                      [](const ExpectResult& r) { return r.verdict == Verdict::kMet; });
    text += fmt::format("  {} of {} met, {:.2f} s", met, test.expectations.size(), test.seconds);
  }
  text += (test.message.empty() ? "" : ": " + test.message) + "\n";
  const std::string lines = complaints(test);
  return lines.empty() ? text : text + indented(lines);
}

std::string closing_line(const std::vector<TestCase>& tests) {
  const long skipped = count(tests, TestVerdict::kSkipped);
  return fmt::format("{} passed, {} failed", count(tests, TestVerdict::kPassed),
                     count(tests, TestVerdict::kFailed)) +
         (skipped > 0 ? fmt::format(", {} skipped\n", skipped) : "\n");
}

std::string to_json(const std::vector<TestCase>& tests) {
  using OrderedJson = nlohmann::ordered_json;
  OrderedJson json = {{"schema", "cprsim-test/1"},
                      {"passed", count(tests, TestVerdict::kPassed)},
                      {"failed", count(tests, TestVerdict::kFailed)},
                      {"skipped", count(tests, TestVerdict::kSkipped)},
                      {"scenes", OrderedJson::array()}};
  for (const TestCase& test : tests) {
    OrderedJson scene = {
        {"path", test.path}, {"verdict", to_string(test.verdict)}, {"seconds", test.seconds}};
    if (!test.message.empty()) scene["message"] = test.message;
    scene["expectations"] = OrderedJson::array();
    for (const ExpectResult& result : test.expectations) {
      OrderedJson checks = OrderedJson::array();
      for (const CheckResult& check : result.checks)
        checks.push_back({{"kind", check.kind},
                          {"verdict", to_string(check.verdict)},
                          {"channel", check.channel},
                          {"value", check.value},
                          {"time", check.time},
                          {"limit", check.limit}});
      scene["expectations"].push_back(
          {{"name", result.name}, {"verdict", to_string(result.verdict)}, {"checks", checks}});
    }
    json["scenes"].push_back(scene);
  }
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

std::string to_junit(const std::vector<TestCase>& tests) {
  double seconds = 0;
  for (const TestCase& test : tests)
    seconds += test.seconds;
  tinyxml2::XMLPrinter xml;
  xml.PushHeader(false, true);
  xml.OpenElement("testsuite");
  xml.PushAttribute("name", "cprsim");
  xml.PushAttribute("tests", static_cast<int>(tests.size()));
  xml.PushAttribute("failures", static_cast<int>(count(tests, TestVerdict::kFailed)));
  xml.PushAttribute("skipped", static_cast<int>(count(tests, TestVerdict::kSkipped)));
  xml.PushAttribute("time", fmt::format("{:.3f}", seconds).c_str());
  for (const TestCase& test : tests) {
    xml.OpenElement("testcase");
    xml.PushAttribute("classname", "scene");
    xml.PushAttribute("name", test.path.c_str());
    xml.PushAttribute("time", fmt::format("{:.3f}", test.seconds).c_str());
    if (test.verdict != TestVerdict::kPassed) {
      const bool failed = test.verdict == TestVerdict::kFailed;
      xml.OpenElement(failed ? "failure" : "skipped");
      const std::string lines = complaints(test);
      const std::string first = !test.message.empty() ? test.message
                                : lines.empty()       ? ""
                                                      : lines.substr(0, lines.find('\n'));
      xml.PushAttribute("message", first.c_str());
      if (failed) xml.PushText(lines.c_str());
      xml.CloseElement();
    }
    xml.CloseElement();
  }
  xml.CloseElement();
  return xml.CStr();
}

}  // namespace cprsim
