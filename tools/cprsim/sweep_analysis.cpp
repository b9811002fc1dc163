// SPDX-License-Identifier: BSD-3-Clause
// Orders: two neighbours on a line, with errors e1 > e2 at resolutions r1, r2, show
//   p = log(e1 / e2) / |log(r1 / r2)|                                                      (1)
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/loader/values.h"
#include "tools/cprsim/sweep_result.h"

namespace cprsim {

namespace {

/// A tolerance is no resolution: what it does to the error is its controller's affair.
bool has_order(const std::string& refined) {
  return !refined.empty() && refined != "tolerance" && refined != "accuracy" &&
         refined != "residual" && refined != "order" && refined != "degree";
}

double value_of(const SweepPoint& point) {
  for (const auto& [name, value] : point.settings)
    if (name == point.refined) return parse_number(value).value_or(0);
  return 0;
}

void find_orders(SweepResult& result) {
  std::map<std::string, std::vector<std::size_t>> lines;
  for (std::size_t i = 0; i < result.runs.size(); ++i)
    if (result.runs[i].done() && has_order(result.plan.points[i].refined))
      lines[result.plan.points[i].line].push_back(i);
  for (const auto& [line, indices] : lines) {
    for (std::size_t k = 1; k < indices.size(); ++k) {
      const double e1 = result.runs[indices[k - 1]].errors[0],
                   e2 = result.runs[indices[k]].errors[0];
      const double r1 = value_of(result.plan.points[indices[k - 1]]),
                   r2 = value_of(result.plan.points[indices[k]]);
      const bool means_something =
          std::min(e1, e2) > result.resolved(0) && r1 > 0 && r2 > 0 && r1 != r2;
      if (means_something)
        result.runs[indices[k]].order = std::log(e1 / e2) / std::abs(std::log(r1 / r2));
    }
  }
}

void find_front(SweepResult& result) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < result.runs.size(); ++i)
    if (result.runs[i].done()) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return result.runs[a].cpu_seconds < result.runs[b].cpu_seconds;
  });
  double best = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    const double error = std::max(result.runs[i].errors[0], result.resolved(0));
    if (!(error < best)) continue;
    best = error;
    result.runs[i].cheapest = true;
  }
}

}  // namespace

double SweepResult::resolved(std::size_t measure) const {
  constexpr double kTimes = 3;
  return measure < reference_spread.size() ? kTimes * reference_spread[measure] : 0;
}

void analyse(SweepResult& result) {
  if (result.plan.reference_kind == ReferenceKind::kNone) return;
  find_orders(result);
  find_front(result);
}

std::vector<Decade> decades(const SweepResult& result) {
  double least = std::numeric_limits<double>::infinity(), largest = 0;
  for (const SweepRun& run : result.runs) {
    if (!run.done() || run.errors.empty()) continue;
    least = std::min(least, std::max(run.errors[0], result.resolved(0)));
    largest = std::max(largest, run.errors[0]);
  }
  std::vector<Decade> list;
  if (!(largest > 0) || !(least > 0)) return list;
  for (int power = static_cast<int>(std::ceil(std::log10(largest))); power >= -15; --power) {
    const double bound = std::pow(10, power);
    if (bound < least) break;
    const SweepRun* best = nullptr;
    for (const SweepRun& run : result.runs)
      if (run.done() && run.errors[0] <= bound && (!best || run.cpu_seconds < best->cpu_seconds))
        best = &run;
    if (best != nullptr)
      list.push_back({bound, static_cast<std::size_t>(best - result.runs.data())});
  }
  // a bound that the cheapest of the next one keeps as well says nothing new
  for (std::size_t k = 0; k + 1 < list.size();)
    if (list[k].run == list[k + 1].run)
      list.erase(list.begin() + static_cast<std::ptrdiff_t>(k));
    else
      ++k;
  return list;
}

}  // namespace cprsim
