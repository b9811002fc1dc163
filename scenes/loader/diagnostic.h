// SPDX-License-Identifier: BSD-3-Clause
// What the loader has to say about a scene: one code per kind of mistake, always with a place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cprsim {

enum class Severity { kNote, kWarning, kError };

struct Diagnostic {
  Severity severity = Severity::kError;
  std::string code;  ///< E301, W502; codes never change meaning
  std::string file;
  int line = 0, column = 0;  ///< from 1; 0: not about one place
  std::string message;
  std::string source_line;           ///< the line complained about; empty: not shown
  int caret_length = 0;              ///< characters to underline from `column`; 0: not shown
  std::string suggestion;            ///< "did you mean <length>?"
  std::string context;               ///< "in world 'w' / model 'm'"
  std::vector<std::string> details;  ///< further lines, e.g. the places where a file was looked for
};

struct CodeEntry {
  const char* code;
  const char* explanation;
};

/// Every code with its one-line explanation, ascending.
const std::vector<CodeEntry>& diagnostic_codes();

/// The explanation of a code, or an empty view.
std::string_view explain_code(std::string_view code);

bool has_errors(const std::vector<Diagnostic>& diagnostics);

/// One diagnostic with its source line, caret, suggestion and context, for people.
std::string to_text(const Diagnostic& diagnostic, bool color = false);

/// All of them, notes only if asked for, errors last, and a closing count.
std::string to_text(const std::vector<Diagnostic>& diagnostics, bool color = false,
                    bool notes = true);

/// file:line:column: severity: message [code]
std::string to_gcc(const Diagnostic& diagnostic);

/// One JSON object.
std::string to_json(const Diagnostic& diagnostic);

/// An annotation command of GitHub's workflows.
std::string to_github(const Diagnostic& diagnostic);

}  // namespace cprsim
