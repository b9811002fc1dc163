// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/gnuplot.h"

#include <sys/wait.h>

#include <cstdio>

#include "tools/sinks/output_file.h"

namespace cprsim {

std::string gnuplot_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

bool draw_with_gnuplot(const std::filesystem::path& folder, const std::string& name,
                       const std::string& script, const Console& console) {
  write_file(folder / (name + ".gp"), script);
  const std::string later =
      name + ".svg was not drawn; later: cd " + folder.string() + " && gnuplot " + name + ".gp";
  std::FILE* pipe = ::popen("gnuplot 2>/dev/null", "w");
  if (pipe == nullptr) {
    console.warn(later);
    return false;
  }
  const std::string text = "folder = " + gnuplot_quoted(folder.string()) + "\n" + script;
  std::fwrite(text.data(), 1, text.size(), pipe);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  const bool absent = WIFEXITED(status) && WEXITSTATUS(status) == 127;
  console.warn((absent ? "gnuplot is not installed, " : "gnuplot failed, ") + later);
  return false;
}

}  // namespace cprsim
