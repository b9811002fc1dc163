// SPDX-License-Identifier: BSD-3-Clause
// Collects diagnostics and knows the files they point into.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/model/place.h"
#include "scenes/loader/diagnostic.h"
#include "scenes/loader/document.h"

namespace cprsim {

struct SourceFile {
  std::string path;  ///< as named by the user, for messages
  std::string text;
  std::vector<std::size_t> line_starts;
};

class Reporter {
 public:
  /// Makes a file known and returns its index.
  int add_file(std::string path, std::string text);

  const std::vector<SourceFile>& files() const { return files_; }

  /// The most general form. At most one diagnostic per code and place is kept.
  Diagnostic& at(Severity severity, std::string_view code, const Place& place, int caret,
                 std::string message);

  /// About an element as a whole; the caret underlines its name.
  Diagnostic& error(std::string_view code, const Node& node, std::string message,
                    std::string suggestion = {});
  Diagnostic& warn(std::string_view code, const Node& node, std::string message);
  Diagnostic& note(std::string_view code, const Node& node, std::string message);

  /// About something that is not there: no caret.
  Diagnostic& missing(std::string_view code, const Node& node, std::string message);

  /// About the text of an element or the value of an attribute.
  Diagnostic& bad_text(std::string_view code, const Node& node, std::string message,
                       std::string suggestion = {});
  Diagnostic& bad_value(std::string_view code, const Node& node, const Attribute& attribute,
                        std::string message, std::string suggestion = {});

  /// "file:line", for mentions of other places.
  std::string locate(const Place& place) const;

  bool failed() const { return failed_; }

  std::vector<Diagnostic> take() { return std::move(diagnostics_); }

  std::vector<Diagnostic>& all() { return diagnostics_; }

 private:
  std::vector<SourceFile> files_;
  std::vector<Diagnostic> diagnostics_;
  Diagnostic swallowed_;
  bool failed_ = false;
};

}  // namespace cprsim
