// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/gnuplot.h"

#include <fmt/core.h>
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

std::string gnuplot_head(const std::string& name, int width, int height) {
  constexpr double kPixelsPerInch = 100;
  const std::string font = "font 'DejaVu Sans,11'";
  return fmt::format(
      "# gnuplot {0}.gp, in the folder of its data; -e \"folder='X'\" for another folder,\n"
      "# -e \"kind='png'\" or 'pdf' for another format\n"
      "if (!exists(\"folder\")) folder = '.'\n"
      "if (!exists(\"kind\")) kind = 'svg'\n"
      "if (kind eq 'png') {{ set terminal pngcairo size {1},{2} {3} }}\n"
      "if (kind eq 'pdf') {{ set terminal pdfcairo size {4},{5} {3} }}\n"
      "if (kind eq 'svg') {{ set terminal svg size {1},{2} {3} background rgb 'white' }}\n"
      "set output folder.'/{0}.'.kind\n"
      "set datafile separator ','\n"
      "set border 3\nset tics nomirror\nset grid lt 1 lc rgb '#e4e4e4'\n",
      name, width, height, font, width / kPixelsPerInch, height / kPixelsPerInch);
}

namespace {

/// @return the exit status of gnuplot, 127 where it is not installed, -1 where no pipe can be had
int feed_gnuplot(const std::string& script) {
  std::FILE* pipe = ::popen("gnuplot 2>/dev/null", "w");
  if (pipe == nullptr) return -1;
  std::fwrite(script.data(), 1, script.size(), pipe);
  const int status = ::pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

bool draw_with_gnuplot(const std::filesystem::path& folder, const std::string& name,
                       const std::string& script, const Console& console,
                       const std::vector<std::string>& kinds) {
  write_file(folder / (name + ".gp"), script);
  for (const std::string& kind : kinds) {
    const int status = feed_gnuplot("folder = " + gnuplot_quoted(folder.string()) + "\nkind = '" +
                                    kind + "'\n" + script);
    if (status == 0) continue;
    console.warn(std::string(status == 127 ? "gnuplot is not installed, " : "gnuplot failed, ") +
                 name + "." + kind + " was not drawn; later: cd " + folder.string() +
                 " && gnuplot " + name + ".gp");
    return false;
  }
  return true;
}

}  // namespace cprsim
