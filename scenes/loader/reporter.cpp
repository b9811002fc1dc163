// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/reporter.h"

#include <algorithm>

namespace cprsim {

namespace {

constexpr std::size_t kMostDiagnostics = 200;  ///< beyond, a file is not a scene but noise

}  // namespace

int Reporter::add_file(std::string path, std::string text) {
  SourceFile file;
  file.path = std::move(path);
  file.text = std::move(text);
  file.line_starts.push_back(0);
  for (std::size_t i = 0; i < file.text.size(); ++i)
    if (file.text[i] == '\n') file.line_starts.push_back(i + 1);
  files_.push_back(std::move(file));
  return static_cast<int>(files_.size()) - 1;
}

Diagnostic& Reporter::at(Severity severity, std::string_view code, const Place& place, int caret,
                         std::string message) {
  Diagnostic d;
  d.severity = severity;
  d.code = code;
  d.message = std::move(message);
  d.caret_length = caret;
  if (place.file >= 0 && place.file < static_cast<int>(files_.size())) {
    const SourceFile& file = files_[static_cast<std::size_t>(place.file)];
    d.file = file.path;
    d.line = place.line;
    d.column = place.column;
    const std::size_t line = static_cast<std::size_t>(std::max(place.line, 1)) - 1;
    if (place.line > 0 && line < file.line_starts.size()) {
      const std::size_t start = file.line_starts[line];
      d.source_line = file.text.substr(start, file.text.find('\n', start) - start);
      if (!d.source_line.empty() && d.source_line.back() == '\r') d.source_line.pop_back();
    }
  }
  failed_ = failed_ || severity == Severity::kError;
  const auto same = [&](const Diagnostic& other) {
    return other.code == d.code && other.file == d.file && other.line == d.line &&
           other.column == d.column && (d.line > 0 || other.message == d.message);
  };
  const bool seen = std::any_of(diagnostics_.begin(), diagnostics_.end(), same);
  if (seen || diagnostics_.size() >= kMostDiagnostics) {
    swallowed_ = std::move(d);
    return swallowed_;
  }
  diagnostics_.push_back(std::move(d));
  return diagnostics_.back();
}

Diagnostic& Reporter::error(std::string_view code, const Node& node, std::string message,
                            std::string suggestion) {
  Diagnostic& d = at(Severity::kError, code, node.place, static_cast<int>(node.name.size()) + 1,
                     std::move(message));
  d.suggestion = std::move(suggestion);
  d.context = context_of(node);
  return d;
}

Diagnostic& Reporter::warn(std::string_view code, const Node& node, std::string message) {
  Diagnostic& d = at(Severity::kWarning, code, node.place, static_cast<int>(node.name.size()) + 1,
                     std::move(message));
  d.context = context_of(node);
  return d;
}

Diagnostic& Reporter::note(std::string_view code, const Node& node, std::string message) {
  return at(Severity::kNote, code, node.place, 0, std::move(message));
}

Diagnostic& Reporter::missing(std::string_view code, const Node& node, std::string message) {
  Diagnostic& d = at(Severity::kError, code, node.place, 0, std::move(message));
  d.context = context_of(node);
  return d;
}

Diagnostic& Reporter::bad_text(std::string_view code, const Node& node, std::string message,
                               std::string suggestion) {
  if (!node.text_place.known()) return error(code, node, std::move(message), std::move(suggestion));
  const std::size_t first_line = std::min(node.text.find('\n'), node.text.size());
  Diagnostic& d =
      at(Severity::kError, code, node.text_place, static_cast<int>(first_line), std::move(message));
  d.suggestion = std::move(suggestion);
  d.context = context_of(node);
  return d;
}

Diagnostic& Reporter::bad_value(std::string_view code, const Node& node, const Attribute& attribute,
                                std::string message, std::string suggestion) {
  const int length = std::max(static_cast<int>(attribute.value.size()), 1);
  const Place& place = attribute.value_place.known() ? attribute.value_place : node.place;
  Diagnostic& d = at(Severity::kError, code, place, length, std::move(message));
  d.suggestion = std::move(suggestion);
  d.context = context_of(node);
  return d;
}

std::string Reporter::locate(const Place& place) const {
  if (place.file < 0 || place.file >= static_cast<int>(files_.size())) return "the command line";
  return files_[static_cast<std::size_t>(place.file)].path + ":" + std::to_string(place.line);
}

}  // namespace cprsim
