// SPDX-License-Identifier: BSD-3-Clause
// Every method on every reference case: error, unknowns, time. Writes FOLDER/reference_cases.md.
//   cprsim_reference_cases [--quick] [--only ID] FOLDER
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "tests/bench/reference_cases.h"
#include "tests/support/methods.h"

namespace cprsim {
namespace {

struct Measured {
  CaseAnswer answer;
  double least = 0;  ///< s
};

/// The smallest time of some runs: fewer of long ones.
Measured measure(const ReferenceCase& one, Method method, bool quick) {
  using Clock = std::chrono::steady_clock;
  Measured found;
  found.least = 1e9;
  double sum = 0;
  for (int i = 0; i < (quick ? 1 : 9) && (i < 1 || sum < 4); ++i) {
    const auto start = Clock::now();
    found.answer = one.solve(method);
    const double took = std::chrono::duration<double>(Clock::now() - start).count();
    found.least = std::min(found.least, took);
    sum += took;
  }
  return found;
}

std::string milliseconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, seconds < 0.1 ? "%.2g" : "%.0f", 1e3 * seconds);
  return text;
}

std::string cells(const Measured& m) {
  char text[64];
  if (m.answer.found)
    std::snprintf(text, sizeof text, " %.1e | %d | ", m.answer.error, m.answer.unknowns);
  else
    std::snprintf(text, sizeof text, " not found | %d | ", m.answer.unknowns);
  return text + milliseconds(m.least) + " |";
}

/// @return whether every method found it, within the case's limit
bool add_row(std::ostream& page, const ReferenceCase& one, bool quick) {
  bool good = true;
  std::string row = std::string("| ") + one.id + " | " + one.what + " | " + one.error_of + " | " +
                    one.source + " |";
  for (const Method method : kEveryMethod) {
    const Measured m = measure(one, method, quick);
    row += cells(m);
    if (one.limit < kNoLimit && !(m.answer.found && m.answer.error < one.limit)) {
      std::fprintf(stderr, "%s, %s: %s, error %.3g\n", one.id, method_name(method),
                   m.answer.found ? "found" : "not found", m.answer.error);
      good = false;
    }
  }
  page << row << "\n";
  std::printf("%s\n", row.c_str());
  std::fflush(stdout);
  return good;
}

constexpr const char* kHead =
    "# Every method on every reference case\n"
    "\n"
    "Made by `build/bin/cprsim_reference_cases docs`.\n"
    "\n"
    "The same scene by each of the three methods, its equations solved to 1e-11 (D10: 1e-9). IDs "
    "are those of the project's list of benchmarks. Rods are cut by the program itself for an "
    "accuracy of 1e-8 of the length. That is a promise for rods bent by a radian or two; where "
    "they wind up or whip about, and for frequencies, a hundredth of that or less is asked for, "
    "and strains get 2 or 4 elements (S17, D01, D02, D09 to D11, D15; B07: 12). Motions are by "
    "`esdirk43` "
    "to a local error of 1e-8 (D08: 1e-6; D11: steps of 20 ms), the same for all methods, so "
    "that in time they err alike. Rods that touch are cut as the scene of the gallery says "
    "(shooting) or into 8 to 60 elements (strain: order 3, collocation: degree 4): touch is felt "
    "where elements meet.\n"
    "\n"
    "Error: of what the column says; of places over a length, of others relative. A closed form "
    "is exact; a computed reference was found by a program that shares nothing with this one, "
    "statics to 1e-10 and better, motions to the difference of two meshes, told where it is more "
    "than 1e-8. Unknowns: of the whole robot, bodies, joints and rods. ms: from the scene in "
    "memory to the answer, load steps, paths and all: the smallest of up to 9 runs (1 where it "
    "takes seconds) on one of two cores that were busy with other work at the time, so to be "
    "compared along a row rather than with other machines.\n"
    "\n";

constexpr const char* kTail =
    "\n"
    "## What the rows say\n"
    "\n"
    "- Shooting takes the least time for its error nearly everywhere; a strain basis needs the "
    "fewest unknowns where a rod bends by a radian or two, and many where it winds up or whips "
    "(S17, D09); collocation takes the most unknowns, banded, and is the fastest way along the "
    "paths of B05.\n"
    "- S11: a slack cable that bends as if it could not. Its error is EI's share and a boundary "
    "layer at each end. Shooting does not find it from the rod along its chord, and of rods a "
    "hundred times as stiff it finds the one that stands upright; `method=\"auto\"` takes the "
    "strain "
    "basis.\n"
    "- D11 is solved in its plane. In space shooting loses it near 1.9 s. Collocation did not "
    "start it in steps of 5 ms: an end moment out of nothing has a boundary layer that is the "
    "thinner the smaller the step, and its elements do not show it.\n"
    "- D08 begins with a jump. Collocation does not start it to a local error of 1e-8: the "
    "estimate stops falling with the step.\n"
    "- C12 by shooting in steps of 0.1 ms with 100 cells, by the others in steps of 0.5 ms with 20 "
    "elements. Collocation creeps where the wave passes only a part of an element in a step: what "
    "its elements make of a force that comes at once at an end does not yield then.\n"
    "- B07 by halves, as its scene says (`scenes/rods/localised_buckle.xml`): where along the "
    "whole "
    "rod the buckle stands, next to nothing says.\n"
    "\n"
    "## What is not in the table\n"
    "\n"
    "- No rod in them: D18, D19 (rigid tops), C10 (distances between curves: "
    "`tests/engine/model/distance_test.cpp`), D21 (what a time scheme does to one vibration: "
    "`tests/engine/time`), P10 (what others have published of their robots).\n"
    "- No question to a method: I01, I04 are fits; in the table are the equilibrium and the "
    "motion that are fitted ([identification.md](identification.md)). The rates of P02 are in "
    "[benchmarks.md](benchmarks.md).\n";

int write_page(const std::string& folder, bool quick, const char* only) {
  std::ofstream page(folder + "/reference_cases.md");
  if (!page) throw std::runtime_error("cannot write to " + folder);
  page << kHead << "| ID | case | error of | reference |";
  for (const Method method : kEveryMethod)
    page << ' ' << method_name(method) << ": error | unknowns | ms |";
  page << "\n|---|---|---|---|";
  for (int i = 0; i < 9; ++i)
    page << "---|";
  page << "\n";
  int missed = 0;
  for (const auto& group :
       {static_cases(), stability_cases(), dynamic_cases(), contact_cases(), robot_cases()})
    for (const ReferenceCase& one : group)
      if (only ? std::strstr(one.id, only) != nullptr : !(quick && one.slow))
        missed += add_row(page, one, quick) ? 0 : 1;
  page << kTail;
  return missed;
}

}  // namespace
}  // namespace cprsim

int main(int argc, char** argv) {
  bool quick = false;
  const char* only = nullptr;
  for (int i = 1; i + 1 < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0) quick = true;
    if (std::strcmp(argv[i], "--only") == 0) only = argv[++i];
  }
  if (argc < 2) {
    std::fputs("cprsim_reference_cases [--quick] [--only ID] FOLDER\n", stderr);
    return 2;
  }
  try {
    return cprsim::write_page(argv[argc - 1], quick, only) == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cprsim_reference_cases: %s\n", error.what());
    return 1;
  }
}
