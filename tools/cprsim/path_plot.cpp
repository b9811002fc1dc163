// SPDX-License-Identifier: BSD-3-Clause
// Parameter against a channel along all paths: stable solid, unstable dashed, events marked.
// gnuplot draws it from a script with the data in it.
#include <fmt/core.h>

#include <array>
#include <filesystem>

#include "engine/run/observe.h"
#include "tools/cprsim/gnuplot.h"
#include "tools/cprsim/path_words.h"

namespace cprsim {

namespace {

struct Curves {
  std::string stable, unstable;       ///< lines of x y, gaps between pieces
  std::array<std::string, 3> events;  ///< by kind
  std::string jumps;                  ///< where a released robot ends
};

class Drawing {
 public:
  Drawing(StaticStudy& study, const PathScale& scale, const Channel& channel)
      : study_(study), scale_(scale), channel_(channel) {}

  void add(const Path& path) {
    const std::vector<PathRow> rows = rows_of(path);
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
      const bool unstable = rows[i].unstable_after() > 0;
      const bool goes_on = i > 0 && (rows[i - 1].unstable_after() > 0) == unstable;
      std::string& curve = unstable ? curves.unstable : curves.stable;
      if (!goes_on) curve += "\n" + at(*rows[i].point);
      curve += at(*rows[i + 1].point);
    }
    for (const PathEvent& event : path.events)
      curves.events[static_cast<std::size_t>(event.kind)] += at(event.point);
  }

  void add(const NamedRelease& release) {
    PathPoint end = release.release.end;
    end.lambda = release.lambda;
    curves.jumps += at(end);
  }

  Curves curves;

 private:
  std::string at(const PathPoint& point) {
    study_.restore(point.state);
    return fmt::format("{:.12g} {:.12g}\n", scale_.value(point.lambda),
                       evaluate(channel_, study_.scene(), study_.snapshot()));
  }

  StaticStudy& study_;
  const PathScale& scale_;
  const Channel& channel_;
};

std::string script_of(const Curves& curves, const PathScale& scale, const Channel& channel,
                      const std::string& title) {
  static constexpr const char* kLooks[] = {
      "pt 9 ps 1.3 lc rgb '#e15759' title 'fold'",
      "pt 7 ps 1.0 lc rgb '#59a14f' title 'branch point'",
      "pt 5 ps 1.0 lc rgb '#f28e2b' title 'stability changes'"};
  std::string text =
      "# gnuplot path.gp, in this folder; -e \"folder='X'\" for another\n"
      "if (!exists(\"folder\")) folder = '.'\n";
  std::string plot;
  const auto add = [&](const std::string& name, const std::string& data, const std::string& look) {
    if (data.empty()) return;
    text += "$" + name + " << EOD\n" + data + "EOD\n";
    plot += (plot.empty() ? "plot $" : ", \\\n     $") + name + " " + look;
  };
  add("stable", curves.stable, "with lines lw 2 lc rgb '#4e79a7' title 'stable'");
  add("unstable", curves.unstable, "with lines lw 1.6 dt 2 lc rgb '#4e79a7' title 'unstable'");
  for (std::size_t i = 0; i < 3; ++i)
    add("event_" + std::to_string(i), curves.events[i], std::string("with points ") + kLooks[i]);
  add("jumps", curves.jumps, "with points pt 6 ps 1.3 lw 1.5 lc rgb '#b07aa1' title 'let go'");
  text +=
      "set terminal svg size 900,600 font 'DejaVu Sans,12' background rgb 'white'\n"
      "set output folder.'/path.svg'\nset border 3\nset tics nomirror\nset grid lt 1 lc rgb "
      "'#e4e4e4'\nset key outside top center horizontal\nset offsets graph 0.02, graph 0.02, graph "
      "0.05, graph 0.05\n";
  text += "set title " + gnuplot_quoted(title) + " noenhanced\n";
  text += "set xlabel " + gnuplot_quoted(scale.name + " [" + scale.unit + "]") + " noenhanced\n";
  text +=
      "set ylabel " + gnuplot_quoted(channel.name + " [" + channel.unit + "]") + " noenhanced\n";
  return text + plot + "\n";
}

}  // namespace

bool draw_path(StaticStudy& study, const PathResult& result, const PathScale& scale,
               const Channel& channel, const std::string& title, const std::string& folder,
               const Console& console) {
  Drawing drawing(study, scale, channel);
  for (const NamedPath& named : result.paths)
    drawing.add(named.path);
  for (const NamedRelease& release : result.releases)
    drawing.add(release);
  return draw_with_gnuplot(folder, "path", script_of(drawing.curves, scale, channel, title),
                           console);
}

}  // namespace cprsim
