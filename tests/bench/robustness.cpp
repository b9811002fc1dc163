// SPDX-License-Identifier: BSD-3-Clause
// Random drive vectors for every robot in scenes/robots, each solved from the scene alone: how many
// equilibria each rung of the ladder finds, which solves fail, and whether what converged is in
// balance. Writes FOLDER/robustness.md. Ends with 1 if a solution that was called converged is not
// one.
//   cprsim_robustness [--quick] [--vectors N] [--others M] [--seed S] [--jobs J] [--only NAME]
//                     FOLDER
// M vectors for robots that are neither planar nor the published one; N if not given.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "engine/study/workspace.h"
#include "scenes/loader/load.h"
#include "tests/bench/equilibrium_check.h"

namespace cprsim {
namespace {

constexpr double kBalanced = 1e-6;    // of the force scale; solves are asked for 1e-9 or less
constexpr double kClosed = 1e-6;      // of the robot's length, or rad
constexpr double kLengthRange = 0.2;  // of a rod's own length, either way
constexpr double kSlideRange = 0.2;   // of the longest rod, either way
constexpr double kTurnRange = 0.7853981633974483;  // 45 degrees, either way
constexpr int kShown = 3;                          // failing vectors that are written out

struct Options {
  std::string folder, only;
  std::size_t vectors = 10000;
  std::size_t others = 0;  ///< 0: as many
  unsigned seed = 1;
  int jobs = 1;
};

struct Outcome {
  std::string name, box;
  std::size_t drives = 0, vectors = 0, failed = 0, wrong = 0;
  std::map<SolveStage, std::size_t> by_stage;
  std::map<std::string, std::size_t> reasons;
  std::vector<std::size_t> examples;  ///< indices of failing vectors
  EquilibriumCheck worst;
  int most_iterations = 0;
  double cpu_seconds = 0;
};

std::string text(const char* format, double value) {
  char buffer[48];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

/// Robots whose lengths are constants: every length is a drive.
void drive_all_lengths(Scene& scene) {
  if (!scene.drives.empty()) return;
  for (std::size_t i = 0; i < scene.rods.size(); ++i) {
    DriveSpec drive;
    drive.quantity = DriveQuantity::kLength;
    drive.rod = static_cast<int>(i);
    ProfileTerm term;
    term.value = scene.rods[i].length;
    drive.profile.terms.push_back(term);
    scene.drives.push_back(drive);
  }
}

/// The joint's limits, or a range around the scene's own value. `box` collects how it was chosen.
WorkspaceAxis axis_of(const StaticStudy& study, std::size_t i, std::map<std::string, int>& box) {
  const Scene& scene = study.scene();
  const DriveSpec& drive = scene.drives[i];
  const Parameter& parameter = study.drives()[i];
  WorkspaceAxis axis;
  axis.name = parameter.name;
  axis.unit = parameter.unit;
  axis.drive = static_cast<int>(i);
  const double own = study.value(parameter);
  double range = kTurnRange;
  std::string how = "±45°";
  if (drive.quantity == DriveQuantity::kLength) {
    range = kLengthRange * own;
    how = "length ±20 %";
  } else if (parameter.unit == "m") {
    double longest = 0;
    for (const RodSpec& rod : scene.rods)
      longest = std::max(longest, rod.length);
    range = kSlideRange * longest;
    how = "slider ±20 % of the rods";
  }
  axis.low = own - range;
  axis.high = own + range;
  if (drive.joint >= 0) {
    const JointSpec& joint = scene.joints[static_cast<std::size_t>(drive.joint)];
    if (std::isfinite(joint.lower) && std::isfinite(joint.upper)) {
      axis.low = joint.lower;
      axis.high = joint.upper;
      how = "limits";
    }
  }
  ++box[how];
  return axis;
}

void note(const StaticStudy& study, const SolveReport& report, std::size_t index, Outcome& out) {
  out.most_iterations = std::max(out.most_iterations, report.iterations);
  if (!report.converged()) {
    ++out.failed;
    ++out.reasons[std::string(to_string(report.status)) + ", last tried " +
                  to_string(report.stage)];
    out.examples.push_back(index);
    return;
  }
  ++out.by_stage[report.stage];
  const EquilibriumCheck check = check_equilibrium(study);
  out.worst.imbalance = std::max(out.worst.imbalance, check.imbalance);
  out.worst.gap = std::max(out.worst.gap, check.gap);
  if (!(check.imbalance < kBalanced) || !(check.gap < kClosed)) ++out.wrong;
}

Outcome try_robot(const std::filesystem::path& path, const Options& options) {
  const LoadResult loaded = load_scene(path.string());
  if (!loaded.scene) throw std::runtime_error(path.string() + " is not a valid scene");
  Scene scene = *loaded.scene;
  drive_all_lengths(scene);
  Outcome out;
  out.name = path.stem().string();
  const StaticStudy first(scene);
  std::map<std::string, int> box;
  std::vector<WorkspaceAxis> axes;
  for (std::size_t i = 0; i < first.drives().size(); ++i)
    axes.push_back(axis_of(first, i, box));
  out.drives = axes.size();
  for (const auto& [how, number] : box)
    out.box += (out.box.empty() ? "" : ", ") + std::to_string(number) + " × " + how;
  const bool other = out.name.rfind("planar_", 0) != 0 && out.name != "slider_crank" &&
                     out.name != "csg_published";
  const std::size_t count = other && options.others > 0 ? options.others : options.vectors;
  const auto points = random_points(axes, count, options.seed);
  out.vectors = points.size();
  std::atomic<std::size_t> next{0};
  std::mutex one_at_a_time;
  const std::clock_t began = std::clock();
  const auto work = [&] {
    StaticStudy study(scene);
    for (std::size_t k = next++; k < points.size(); k = next++) {
      for (std::size_t i = 0; i < axes.size(); ++i)
        study.set(study.drives()[i], points[k][i]);
      const SolveReport report = study.solve();
      const std::lock_guard lock(one_at_a_time);
      note(study, report, k, out);
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < options.jobs; ++i)
    threads.emplace_back(work);
  work();
  for (std::thread& thread : threads)
    thread.join();
  out.cpu_seconds = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  std::sort(out.examples.begin(), out.examples.end());
  for (std::size_t i = 0; i < out.examples.size() && i < kShown; ++i) {
    std::printf("  %s fails at", out.name.c_str());
    for (std::size_t a = 0; a < axes.size(); ++a)
      std::printf(" %s=%.17g", axes[a].name.c_str(), points[out.examples[i]][a]);
    std::printf("\n");
  }
  return out;
}

std::size_t found(const Outcome& out, SolveStage stage) {
  const auto at = out.by_stage.find(stage);
  return at == out.by_stage.end() ? 0 : at->second;
}

constexpr SolveStage kStages[] = {SolveStage::kNewton, SolveStage::kLevenbergMarquardt,
                                  SolveStage::kContinuation, SolveStage::kRelaxation};

std::string row_of(const Outcome& out) {
  std::string row = "| " + out.name + " | " + out.box + " | " + std::to_string(out.vectors);
  for (const SolveStage stage : kStages)
    row += " | " + std::to_string(found(out, stage));
  return row + " | " + std::to_string(out.failed) + " | " + std::to_string(out.wrong) + " | " +
         text("%.1e", out.worst.imbalance) + " | " + text("%.1e", out.worst.gap) + " | " +
         text("%.1f", 1e3 * out.cpu_seconds / static_cast<double>(out.vectors)) + " |\n";
}

void write_page(const std::vector<Outcome>& outcomes, const Options& options) {
  std::ofstream page(options.folder + "/robustness.md");
  page
      << "# Random drives, from the scene alone\n\n"
         "Made by `cprsim_robustness --vectors "
      << options.vectors
      << (options.others > 0 ? " --others " + std::to_string(options.others) : "") << " --seed "
      << options.seed
      << "` (tests/bench/robustness.cpp). Every robot of scenes/robots is given random drive "
         "vectors, evenly distributed in a box: the limits of its joints or, where the scene sets "
         "none, the stated range around the values that the scene begins with. Each vector is "
         "solved from the scene alone, without the solutions before it, and ends in a converged "
         "equilibrium or in a report that says why not. The columns Newton to relaxation count "
         "which rung of the ladder (engine/solve/newton.h) found the equilibrium (before Newton's "
         "method proper, "
         "rods that must be brought together are soft for a few steps).\n\n"
         "What converged is checked from observed numbers alone (tests/bench/equilibrium_check.h): "
         "the sum of the forces and moments that rods, joints, weights and loads exert on every "
         "body and on every rod, over the robot's force scale EI / L², and how far parts are "
         "apart that are held together, over its length. `wrong` counts converged solutions "
         "above 1e-6.\n\n"
         "| robot | box | vectors | Newton | Levenberg-Marquardt | continuation | relaxation | "
         "failed | wrong | worst imbalance | worst gap | ms a vector |\n"
         "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::size_t all = 0, failed = 0, wrong = 0;
  for (const Outcome& out : outcomes) {
    page << row_of(out);
    all += out.vectors;
    failed += out.failed;
    wrong += out.wrong;
  }
  page << "\n"
       << all << " vectors: " << all - failed << " converged, " << failed << " ended in a report, "
       << wrong << " called converged without being so.\n";
  if (failed > 0)
    page << "\n## What the reports say\n\n| robot | report | vectors |\n|---|---|---|\n";
  for (const Outcome& out : outcomes)
    for (const auto& [why, number] : out.reasons)
      page << "| " << out.name << " | " << why << " | " << number << " |\n";
  if (!page.flush()) throw std::runtime_error("cannot write " + options.folder + "/robustness.md");
}

Options parse(int count, char** words) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const auto value = [&] {
      if (++i >= count) throw std::runtime_error(word + " needs a value");
      return std::string(words[i]);
    };
    if (word == "--quick")
      options.vectors = 20;
    else if (word == "--vectors")
      options.vectors = std::stoul(value());
    else if (word == "--others")
      options.others = std::stoul(value());
    else if (word == "--seed")
      options.seed = static_cast<unsigned>(std::stoul(value()));
    else if (word == "--jobs")
      options.jobs = std::stoi(value());
    else if (word == "--only")
      options.only = value();
    else
      options.folder = word;
  }
  if (options.folder.empty())
    throw std::runtime_error(
        "cprsim_robustness [--quick] [--vectors N] [--others M] [--seed S] [--jobs J] [--only "
        "NAME] "
        "FOLDER");
  return options;
}

int run(const Options& options) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(CPRSIM_SOURCE_DIR) + "/scenes/robots"))
    if (entry.path().extension() == ".xml" &&
        (options.only.empty() || entry.path().stem() == options.only))
      paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Outcome> outcomes;
  std::size_t wrong = 0;
  for (const std::filesystem::path& path : paths) {
    outcomes.push_back(try_robot(path, options));
    wrong += outcomes.back().wrong;
    std::printf("%s", row_of(outcomes.back()).c_str());
    std::fflush(stdout);
  }
  write_page(outcomes, options);
  return paths.empty() || wrong > 0 ? 1 : 0;
}

}  // namespace
}  // namespace cprsim

int main(int count, char** words) {
  try {
    return cprsim::run(cprsim::parse(count, words));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cprsim_robustness: %s\n", error.what());
    return 2;
  }
}
