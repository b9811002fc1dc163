// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/diagnostic.h"

#include <algorithm>
#include <set>

namespace cprsim {

namespace {

constexpr std::size_t kWidth = 120;  ///< excerpts of longer lines are cut around the caret

const char* word(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "error";
    case Severity::kWarning:
      return "warning";
    default:
      return "note";
  }
}

std::string paint(const std::string& text, const char* code, bool color) {
  return color ? std::string("\033[") + code + "m" + text + "\033[0m" : text;
}

const char* hue(Severity severity) {
  return severity == Severity::kError ? "1;31" : severity == Severity::kWarning ? "1;35" : "1;36";
}

std::string place_of(const Diagnostic& d) {
  std::string text = d.file;
  if (d.line > 0) text.append(":").append(std::to_string(d.line));
  if (d.line > 0 && d.column > 0) text.append(":").append(std::to_string(d.column));
  return text;
}

// the source line with the caret below it, both cut to a window that shows the caret
std::string excerpt(const Diagnostic& d, bool color) {
  const std::size_t at = static_cast<std::size_t>(d.column - 1);
  if (at > d.source_line.size()) return {};
  const std::size_t start = at > kWidth - 20 ? at - 20 : 0;
  const std::string line = d.source_line.substr(start, kWidth);
  std::string number = std::to_string(d.line);
  if (number.size() < 5) number.insert(0, 5 - number.size(), ' ');

  // tabs stay tabs, so that the caret stands below what it means
  std::string pad = line.substr(0, at - start);
  for (char& c : pad)
    if (c != '\t') c = ' ';
  const std::size_t room = line.size() > pad.size() ? line.size() - pad.size() : 1;
  const std::size_t length = std::min(static_cast<std::size_t>(d.caret_length), room);
  std::string caret = paint(std::string(std::max<std::size_t>(length, 1), '^'), "1;32", color);
  if (!d.suggestion.empty()) caret += " " + d.suggestion;
  return number + " | " + line + "\n" + std::string(number.size(), ' ') + " | " + pad + caret +
         "\n";
}

std::string escape_json(const std::string& text) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20) {
      out += "\\u00";
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    } else {
      out += c;
    }
  }
  return out;
}

std::string escape_github(const std::string& text, bool property) {
  std::string out;
  for (const char c : text) {
    if (c == '%')
      out += "%25";
    else if (c == '\n')
      out += "%0A";
    else if (c == '\r')
      out += "%0D";
    else if (property && c == ':')
      out += "%3A";
    else if (property && c == ',')
      out += "%2C";
    else
      out += c;
  }
  return out;
}

std::string plural(std::size_t n, const char* noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

// a suggestion that no caret carries follows the message
std::string full_message(const Diagnostic& d) {
  return d.suggestion.empty() ? d.message : d.message + "; " + d.suggestion;
}

}  // namespace

bool has_errors(const std::vector<Diagnostic>& diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::kError; });
}

std::string to_text(const Diagnostic& d, bool color) {
  const std::string place = place_of(d);
  const std::string lines = d.caret_length > 0 && d.column > 0 ? excerpt(d, color) : std::string();
  std::string text = place.empty() ? place : paint(place + ":", "1", color) + " ";
  text += paint(std::string(word(d.severity)) + "[" + d.code + "]:", hue(d.severity), color) + " ";
  text += (lines.empty() ? full_message(d) : d.message) + "\n" + lines;
  for (const std::string& detail : d.details)
    text += "      " + detail + "\n";
  if (!d.context.empty() && !lines.empty()) text += "      " + d.context + "\n";
  return text;
}

std::string to_text(const std::vector<Diagnostic>& diagnostics, bool color, bool notes) {
  std::string text, first_code;
  std::size_t errors = 0, warnings = 0;
  std::set<std::string> files;
  for (const Severity level : {Severity::kNote, Severity::kWarning, Severity::kError}) {
    if (level == Severity::kNote && !notes) continue;
    for (const Diagnostic& d : diagnostics) {
      if (d.severity != level) continue;
      text += to_text(d, color);
      if (level == Severity::kNote) continue;
      (level == Severity::kError ? errors : warnings) += 1;
      files.insert(d.file);
      if (level == Severity::kError && first_code.empty()) first_code = d.code;
    }
  }
  if (errors + warnings == 0) return text;
  std::string counts;
  if (errors > 0) counts = plural(errors, "error");
  if (warnings > 0) counts += (counts.empty() ? "" : " and ") + plural(warnings, "warning");
  text += counts + " in " + plural(files.size(), "file");
  if (!first_code.empty()) text += " (cprsim explain " + first_code + ")";
  return text + "\n";
}

std::string to_gcc(const Diagnostic& d) {
  const std::string place = place_of(d);
  return (place.empty() ? std::string("cprsim") : place) + ": " + word(d.severity) + ": " +
         full_message(d) + " [" + d.code + "]\n";
}

std::string to_json(const Diagnostic& d) {
  std::string text = std::string("{\"severity\":\"") + word(d.severity) + "\",\"code\":\"" +
                     escape_json(d.code) + "\",\"file\":\"" + escape_json(d.file) +
                     "\",\"line\":" + std::to_string(d.line) +
                     ",\"column\":" + std::to_string(d.column) + ",\"message\":\"" +
                     escape_json(d.message) + "\",\"suggestion\":\"" + escape_json(d.suggestion) +
                     "\",\"context\":\"" + escape_json(d.context) + "\",\"details\":[";
  for (std::size_t i = 0; i < d.details.size(); ++i)
    text += (i ? ",\"" : "\"") + escape_json(d.details[i]) + "\"";
  return text + "]}";
}

std::string to_github(const Diagnostic& d) {
  const std::string level = d.severity == Severity::kNote ? "notice" : word(d.severity);
  std::string text = "::" + level + " file=" + escape_github(d.file, true);
  if (d.line > 0) text += ",line=" + std::to_string(d.line);
  if (d.column > 0) text += ",col=" + std::to_string(d.column);
  return text + ",title=" + d.code + "::" + escape_github(full_message(d), false) + "\n";
}

}  // namespace cprsim
