// SPDX-License-Identifier: BSD-3-Clause
// What people see: results on standard output, everything else on standard error.
#pragma once

#include <string>
#include <vector>

#include "scenes/loader/diagnostic.h"

namespace cprsim {

enum class When { kAuto, kAlways, kNever };
enum class ProgressStyle { kAuto, kBar, kPlain, kNone };
enum class ErrorFormat { kText, kGcc, kJson, kGithub };

struct ConsoleOptions {
  int quiet = 0;  ///< 1: no summary and no progress, 2: errors only
  bool verbose = false;
  bool json = false;
  When color = When::kAuto;
  ProgressStyle progress = ProgressStyle::kAuto;
  ErrorFormat error_format = ErrorFormat::kText;
};

class Console {
 public:
  explicit Console(const ConsoleOptions& options);

  /// A result, on standard output; not with -q or --json.
  void say(const std::string& text) const;
  /// On standard error, with -v.
  void remark(const std::string& text) const;
  /// On standard error, unless -qq.
  void warn(const std::string& text) const;
  void error(const std::string& text) const;
  /// The same with a code that `cprsim explain` knows.
  void warn(const char* code, const std::string& text) const;
  void error(const char* code, const std::string& text) const;
  /// What the loader found, in the chosen format: notes with -v, warnings unless -qq.
  void show(const std::vector<Diagnostic>& diagnostics) const;

  bool json() const { return options_.json; }

  bool verbose() const { return options_.verbose; }

  /// Bar, plain or none.
  ProgressStyle progress() const { return progress_; }

 private:
  void print(const std::string& word, const char* hue, const std::string& text) const;

  ConsoleOptions options_;
  ProgressStyle progress_;
  bool color_ = false;
};

}  // namespace cprsim
