// SPDX-License-Identifier: BSD-3-Clause
// The study as CSV (one line a run) and as a page to read.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "tests/bench/work_precision.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4;  // of the rod, m

std::string number(double x, const char* format = "%.3g") {
  char text[32];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

std::string cells_of(const Setting& setting) {
  return std::to_string(setting.cells) + " cells";
}

std::string name_of(const Setting& setting) {
  const std::string how = setting.step > 0 ? "step " + number(setting.step) + " s"
                                           : "tolerance " + number(setting.tolerance);
  return "`" + setting.scheme_name() + "`, " + how + ", " + cells_of(setting);
}

std::string machine() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  std::string model = "an unnamed processor";
  int processors = 0;
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.rfind("processor", 0) == 0) ++processors;
    if (line.rfind("model name", 0) == 0) model = line.substr(line.find(':') + 2);
  }
  return model + ", " + std::to_string(processors) + " logical processors";
}

std::ofstream create(const std::string& path) {
  std::ofstream file(path);
  if (!file) throw std::runtime_error("cannot write " + path);
  return file;
}

void write_csv(const Study& study, const std::string& path) {
  std::ofstream file = create(path);
  file << "scheme,mode,step_s,tolerance,cells,error_at_steps_over_L,error_between_over_L,error_"
          "later_over_L,cpu_s,"
          "steps,retried,iterations,section_evaluations,failed\n";
  for (const Outcome& out : study.outcomes) {
    const Setting& s = out.setting;
    file << s.scheme_name() << ',' << (s.step > 0 ? "fixed" : "adaptive") << ',' << number(s.step)
         << ',' << number(s.tolerance) << ',' << s.cells << ','
         << number(out.error / kLength, "%.4e") << ','
         << number(out.error_between / kLength, "%.4e") << ','
         << number(out.error_later / kLength, "%.4e") << ',' << number(out.cpu_seconds, "%.6f")
         << ',' << out.steps << ',' << out.retried << ',' << out.iterations << ','
         << out.section_evaluations << ',' << (out.failure.empty() ? 0 : 1) << '\n';
  }
}

/// The cheapest run whose tip stays within `bound` lengths at all times; nullptr if there is none.
const Outcome* cheapest(const Study& study, double bound) {
  const Outcome* best = nullptr;
  for (const Outcome& out : study.outcomes)
    if (out.failure.empty() && out.worst() <= bound * kLength &&
        (!best || out.cpu_seconds < best->cpu_seconds))
      best = &out;
  return best;
}

void write_headline(const Study& study, std::ofstream& page) {
  const Outcome* best = cheapest(study, 1e-3);
  if (!best) {
    page << "No setting keeps the tip within 1e-3 L of the reference.\n\n";
    return;
  }
  page << "**One second of the released rod to 1e-3 L costs " << number(best->cpu_seconds, "%.4f")
       << " s of one core** (" << name_of(best->setting) << ", error "
       << number(best->worst() / kLength, "%.1e") << " L; asked for: 0.1 s)";
  double last = best->cpu_seconds;
  for (const double bound : {1e-4, 1e-5, 1e-6}) {
    const Outcome* next = cheapest(study, bound);
    if (!next) break;
    page << "; 1e" << std::lround(std::log10(bound)) << " L costs "
         << number(next->cpu_seconds, "%.3f") << " s (" << number(next->cpu_seconds / last, "%.1f")
         << " times more)";
    last = next->cpu_seconds;
  }
  page << ".\n\n";
}

void write_preface(const Study& study, std::ofstream& page) {
  const ReferenceFacts& r = study.reference;
  page
      << "Made by `build/bin/cprsim_work_precision docs/accuracy` and, for the picture, `gnuplot "
         "tests/bench/work_precision.gp` on "
      << machine()
      << ", shared with other work. Numbers of all runs: [released_rod.csv](released_rod.csv).\n\n"
      << "The rod: 0.4 m of 2 mm steel, clamped, bent by 1 N at its tip and its own weight, let "
         "go at t = 0 and followed for 1 s; extension, shear, rotary inertia, gravity and "
         "Kelvin-Voigt damping of 1 ms act (tests/support/released_rod.h). Its first period is "
         "0.11 s. The error is the largest distance of the tip from the reference over the "
         "second, whichever is larger: at the ends of steps, or between them where films and "
         "tables look. Time is that of the process on one core with building, static start and "
         "all steps, the best of three.\n\n"
      << "The reference: `esdirk43`, tolerance " << number(r.tolerance) << ", " << r.cells
      << " cells, residual 1e-12. It ends " << number(r.to_independent_tip, "%.1e")
      << " m from the tip that an independent program found; ten times the tolerance changes it "
         "by at most "
      << number(r.to_coarser_tolerance, "%.1e") << " m, " << r.fewer_cells << " cells by "
      << number(r.to_fewer_cells, "%.1e") << " m.\n\n"
      << "![Error against time](released_rod.svg)\n\nLines: 6 cells. Dots: 3 and 12 cells too.\n\n";
}

void write_decades(const Study& study, std::ofstream& page) {
  page
      << "## The cheapest way to each accuracy\n\n"
         "| error at most | setting | error / L | CPU s | steps | iterations | section evaluations "
         "|\n|---|---|---|---|---|---|---|\n";
  for (const double bound : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const Outcome* best = cheapest(study, bound);
    if (!best) continue;
    page << "| 1e" << std::lround(std::log10(bound)) << " L | " << name_of(best->setting) << " | "
         << number(best->worst() / kLength, "%.1e") << " | " << number(best->cpu_seconds, "%.4f")
         << " | " << best->steps << " | " << best->iterations << " | " << best->section_evaluations
         << " |\n";
  }
  page << '\n';
}

const Outcome* find(const Study& study, const Setting& like, double step, int cells) {
  for (const Outcome& out : study.outcomes)
    if (out.setting.scheme_name() == like.scheme_name() && out.setting.step == step &&
        out.setting.cells == cells)
      return &out;
  return nullptr;
}

void write_orders(const Study& study, std::ofstream& page) {
  constexpr int kCells = 12;
  const std::vector<double> steps{1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4};
  page << "## Fixed steps\n\nLargest error / L at the ends of steps after the first 50 ms with "
       << kCells
       << " cells, and the order seen from one step to the next (brackets). Right after the "
          "release the motion is not smooth, and fixed steps of every scheme leave an error of "
          "second order there; the other numbers of this page include it, and a tolerance instead "
          "of a step avoids it.\n\n| scheme |";
  for (const double step : steps)
    page << ' ' << number(step) << " s |";
  page << "\n|---|---|---|---|---|---|---|---|\n";
  std::string last;
  for (const Outcome& each : study.outcomes) {
    if (each.setting.scheme_name() == last) continue;
    last = each.setting.scheme_name();
    page << "| `" << last << "` |";
    const Outcome* coarser = nullptr;
    for (const double step : steps) {
      const Outcome* out = find(study, each.setting, step, kCells);
      if (!out) continue;
      page << ' ' << number(out->error_later / kLength, "%.1e");
      if (coarser)
        page << " ("
             << number(std::log(coarser->error_later / out->error_later) /
                           std::log(coarser->setting.step / step),
                       "%.1f")
             << ')';
      page << " |";
      coarser = out;
    }
    page << '\n';
  }
  page << '\n';
}

void write_failures(const Study& study, std::ofstream& page) {
  double smallest = 1, largest = 0;
  long failed = 0;
  bool drifts = false;
  for (const Outcome& out : study.outcomes) {
    if (!out.failure.empty()) ++failed;
    if (out.setting.step == 0) continue;
    drifts = drifts || out.iterations < out.steps - out.steps / 20;
    smallest = std::min(smallest, out.setting.step);
    largest = std::max(largest, out.setting.step);
  }
  page << "## Failures\n\n"
       << failed << " of " << study.outcomes.size() << " runs failed; fixed steps range from "
       << number(largest) << " s to " << number(smallest) << " s.\n\n"
       << "| small fixed steps, 6 cells | error / L | CPU s | iterations a step |\n"
          "|---|---|---|---|\n";
  for (const Outcome& out : study.outcomes)
    if (out.setting.step > 0 && out.setting.step < 5e-5)
      page << "| `" << out.setting.scheme_name() << "`, " << number(out.setting.step) << " s | "
           << number(out.worst() / kLength, "%.1e") << " | " << number(out.cpu_seconds, "%.1f")
           << " | "
           << number(static_cast<double>(out.iterations) / static_cast<double>(out.steps), "%.2f")
           << " |\n";
  if (drifts)
    page << "\nFewer than one iteration a step: guesses extrapolated from earlier steps met the "
            "equations "
            "to round-off and were kept, and what they are off by adds up.\n";
  for (const Outcome& out : study.outcomes)
    if (!out.failure.empty()) page << "\nFailed: " << name_of(out.setting) << ": " << out.failure;
}

}  // namespace

void write_study(const Study& study, const std::string& folder) {
  write_csv(study, folder + "/released_rod.csv");
  std::ofstream page = create(folder + "/released_rod.md");
  page << "# Accuracy against time: the released rod\n\n";
  write_headline(study, page);
  write_preface(study, page);
  write_decades(study, page);
  write_orders(study, page);
  write_failures(study, page);
  if (!page.flush()) throw std::runtime_error("cannot write " + folder + "/released_rod.md");
}

}  // namespace cprsim
