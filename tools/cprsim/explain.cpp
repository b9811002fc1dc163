// SPDX-License-Identifier: BSD-3-Clause
// cprsim explain: what a diagnostic's code means, what an element may hold.
#include <fmt/core.h>

#include "scenes/loader/diagnostic.h"
#include "scenes/loader/schema.h"
#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

std::string all_codes() {
  std::string text;
  for (const CodeEntry& entry : diagnostic_codes()) {
    text += fmt::format("{}  {}\n", entry.code, entry.explanation);
  }
  return text;
}

}  // namespace

int explain_command(const Words& words) {
  std::vector<std::string> names;
  CommandLine line(
      "cprsim explain",
      "Explains codes of diagnostics and elements of the scene language; alone, lists all "
      "codes.\n\n"
      "Examples\n"
      "  cprsim explain E301\n"
      "  cprsim explain cprsim:rod");
  line.arguments("NAME", names, "A code or an element", false);
  if (const auto code = line.parse(words)) return *code;

  std::string text = names.empty() ? all_codes() : "";
  for (const std::string& name : names) {
    const std::string_view meaning = explain_code(name);
    const std::string element = meaning.empty() ? explain_element(name) : "";
    if (meaning.empty() && element.empty()) {
      write_to_stderr(
          fmt::format("cprsim explain: '{}' is neither a code nor an element of a scene\n", name));
      return kExitUsage;
    }
    text += meaning.empty() ? element : fmt::format("{}  {}\n", name, meaning);
    if (text.back() != '\n') text += '\n';
  }
  write_to_stdout(text);
  return kExitDone;
}

}  // namespace cprsim
