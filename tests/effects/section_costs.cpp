// SPDX-License-Identifier: BSD-3-Clause
// The work that sections of rods take, for valgrind to count instructions in and for a clock:
//
//   cprsim_section_costs kernels   cells by the kernel as it is, and by one without any effect
//   cprsim_section_costs copies    how many of many cells differ between copies of the kernel
//   cprsim_section_costs cases     a line METHOD;EFFECT for every rod that is measured
//   cprsim_section_costs METHOD EFFECT [timed]   residual and linearisation of that rod
//
// One line per measurement, in the order of the calls of measured_cell() and measured_sweep().
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>

#include "engine/rod/cell.h"
#include "tests/effects/costed_rods.h"

namespace cprsim {

const CellKernel& cell_kernel_bare(int stages, CellLaw law);
const CellKernel& cell_kernel_baseline(int stages, CellLaw law);
const CellKernel& unloaded_kernel_baseline(int stages, bool extensible);
#ifdef __x86_64__
const CellKernel& cell_kernel_avx2(int stages, CellLaw law);
#endif

}  // namespace cprsim

/// valgrind counts inside these two only.
extern "C" {
[[gnu::noinline]] void measured_cell(const cprsim::CellKernel& kernel, cprsim::CellModel& model,
                                     cprsim::CellStage* stages, const cprsim::NodeState& start,
                                     cprsim::NodeState& end, double* Y, double* dU) {
  kernel.evaluate(model, stages, start, end);
  kernel.linearize_narrow(model, stages, start, end, Y, dU);
}

[[gnu::noinline]] void measured_sweep(cprsim::RodModel& rod, const cprsim::Port& base,
                                      const cprsim::Port& tip, cprsim::CondensedRod& out) {
  rod.evaluate(base, tip);
  rod.linearize(base, tip, out);
}
}

namespace cprsim {
namespace {

constexpr int kColumns = 12 * kNarrow;

/// What a cell is given and what it finds, for a comparison of bytes.
struct CellRun {
  std::vector<CellStage> stages;
  NodeState start{}, end{};
  double Y[kColumns] = {}, dU[kMaxLifted * kNarrow] = {};
};

/// @param seed of a number that all of the cell depend on
CellRun run_cell(const CellKernel& kernel, ArcIntegrator integrator, bool inertia, int seed = 0) {
  CellRun run;
  const double number = std::sin(seed);
  const ArcTableau& table = arc_tableau(integrator);
  CellModel model;
  model.table = &table;
  model.h = 0.04;
  for (int i = 0; i < 3; ++i) {
    model.C_bt[i] = 6 + i;
    model.C_se[i] = 1e-6;
    run.start.R[4 * i] = 1;
    run.start.n[i] = 0.3 * i - 0.2 + number;
    run.start.m[i] = 0.1 - 0.04 * i;
  }
  model.k = inertia ? 2500 : 0;
  const std::vector<CellSection> sections(static_cast<std::size_t>(table.stages), model);
  model.sections = sections.data();
  for (int j = 0; j < table.stages; ++j) {
    CellStage stage{};
    stage.v0[2] = stage.v[2] = 1;
    stage.b[2] = 0.25;
    for (int i = 0; i < 3; ++i)
      stage.w[i] = 0.5 * i + 0.1 * j + 3 * number;
    run.stages.push_back(stage);
  }
  for (int c = 0; c < kColumns; ++c)
    run.Y[c] = 0.01 * c - 0.3;
  measured_cell(kernel, model, run.stages.data(), run.start, run.end, run.Y, run.dU);
  return run;
}

bool same_bytes(const CellRun& a, const CellRun& b) {
  return std::memcmp(a.stages.data(), b.stages.data(), a.stages.size() * sizeof(CellStage)) == 0 &&
         std::memcmp(&a.end, &b.end, sizeof a.end) == 0 && std::memcmp(a.Y, b.Y, sizeof a.Y) == 0 &&
         std::memcmp(a.dU, b.dU, sizeof a.dU) == 0;
}

/// The copy that valgrind can run: it knows no wider vectors.
const CellKernel& shipped_kernel(int stages, CellLaw law) {
#ifdef __x86_64__
  return cell_kernel_avx2(stages, law);
#else
  return cell_kernel_baseline(stages, law);
#endif
}

void compare_kernels() {
  struct {
    CellLaw law;
    bool inertia;
    const char* name;
  } laws[] = {{CellLaw::kKirchhoff, false, "inextensible, at rest"},
              {CellLaw::kKirchhoff, true, "inextensible, moving"},
              {CellLaw::kExtensibleStatic, false, "extensible, at rest"},
              {CellLaw::kExtensible, true, "extensible, moving"}};

  for (const ArcIntegrator integrator : {ArcIntegrator::kGauss4, ArcIntegrator::kGauss6})
    for (const auto& at : laws) {
      const int stages = arc_tableau(integrator).stages;
      const CellRun shipped = run_cell(shipped_kernel(stages, at.law), integrator, at.inertia),
                    bare = run_cell(cell_kernel_bare(stages, at.law), integrator, at.inertia);
      const char* bytes = same_bytes(shipped, bare) ? "same" : "differ";
      std::printf("%d stages, %s;shipped;%s\n", stages, at.name, bytes);
      std::printf("%d stages, %s;bare;%s\n", stages, at.name, bytes);
    }
}

const CellKernel& narrowest_kernel(int stages, CellLaw law) {
  if (is_unloaded(law))
    return unloaded_kernel_baseline(stages, law == CellLaw::kUnloadedExtensible);
  return cell_kernel_baseline(stages, law);
}

// The widest copy that the machine runs, beside the narrowest.
void compare_copies() {
  constexpr int kCells = 4000;
  int differ = 0;
  for (int seed = 0; seed < kCells; ++seed)
    for (const CellLaw law : {CellLaw::kKirchhoff, CellLaw::kExtensible, CellLaw::kKirchhoffGeneral,
                              CellLaw::kUnloaded, CellLaw::kUnloadedExtensible}) {
      const ArcIntegrator integrator = ArcIntegrator::kGauss6;
      const int stages = arc_tableau(integrator).stages;
      differ += !same_bytes(run_cell(cell_kernel(stages, law), integrator, true, seed),
                            run_cell(narrowest_kernel(stages, law), integrator, true, seed));
    }
  std::printf("%d\n", differ);
}

/// A rod that is swept, and what a section of it takes.
struct TimedRod {
  CostedRod rod;
  CondensedRod condensed;
  long sections = 0;
  double best = 1;  ///< s, of a sweep

  TimedRod(const RodCase& at, Method method) : rod(at, method) {
    // everything that is set up once is, before the sweep that counts
    rod.model().evaluate(rod.base(), rod.tip());
    rod.model().linearize(rod.base(), rod.tip(), condensed);
    const long before = rod.model().section_evaluations();
    measured_sweep(rod.model(), rod.base(), rod.tip(), condensed);
    sections = rod.model().section_evaluations() - before;
  }

  void sweep(int times) {
    using Clock = std::chrono::steady_clock;
    for (int run = 0; run < times; ++run) {
      const Clock::time_point begin = Clock::now();
      measured_sweep(rod.model(), rod.base(), rod.tip(), condensed);
      const std::chrono::duration<double> spent = Clock::now() - begin;
      best = std::min(best, spent.count());
    }
  }

  double nanoseconds() const { return 1e9 * best / static_cast<double>(sections); }
};

// Times are the best of many sweeps, those of a plain rod in between: what else a machine does
// slows down both.
void sweep_rod(const RodCase& at, Method method, bool timed) {
  TimedRod rod(at, method);
  if (!timed) {
    // what it finds, to the last bit
    const CondensedRod& found = rod.condensed;
    std::printf("%ld;%d", rod.sections, rod.rod.model().unknown_count());
    const Eigen::Index d = std::string(at.name).starts_with("planar") ? 3 : 6;
    for (Eigen::Index i = 0; i < d; ++i) {
      for (Eigen::Index k = 0; k < d; ++k)
        std::printf(" %a", found.T(i, k));
      std::printf(" %a", found.t[i]);
    }
    for (const RodPoint& point : rod.rod.model().observe().points)
      for (int i = 0; i < 3; ++i)
        std::printf(" %a %a", point.position[i], point.moment[i]);
    std::printf("\n");
    return;
  }
  TimedRod plain(costed_cases().front(), method);
  double spent = 0;
  for (int round = 0; round < 100 && spent < 0.4; ++round) {
    rod.sweep(20);
    plain.sweep(20);
    spent += 20 * (rod.best + plain.best);
  }
  std::printf("%ld;%d;%.1f;%.1f\n", rod.sections, rod.rod.model().unknown_count(),
              rod.nanoseconds(), plain.nanoseconds());
}

void sweep_rods(const std::string& method_wanted, const std::string& name, bool timed) {
  for (const Method method : kEveryMethod)
    for (const RodCase& at : costed_cases()) {
      if (method_wanted == "cases")
        std::printf("%s;%s\n", method_name(method), at.name);
      else if (method_wanted == method_name(method) && name == at.name)
        sweep_rod(at, method, timed);
    }
}

}  // namespace
}  // namespace cprsim

int main(int count, char** words) {
  const std::string what = count > 1 ? words[1] : "cases";
  if (what == "kernels")
    cprsim::compare_kernels();
  else if (what == "copies")
    cprsim::compare_copies();
  else
    cprsim::sweep_rods(what, count > 2 ? words[2] : "", count > 3);
}
