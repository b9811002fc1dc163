// SPDX-License-Identifier: BSD-3-Clause
// cprsim identify: values of a scene from measurements.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/identify_model.h"
#include "tools/cprsim/identify_result.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/output_folder.h"
#include "tools/cprsim/stopwatch.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

/// Length of each column of the difference between derivatives with one step and with three.
bool derivative_errors(SceneFit& model, const FitReport& fit, MatX& J, VecX& errors) {
  MatX coarse;
  if (!model.derivative(fit.z, fit.r, model.step(), J) ||
      !model.derivative(fit.z, fit.r, 3 * model.step(), coarse))
    return false;
  errors = (coarse - J).colwise().norm().transpose();
  return true;
}

/// A direction in which nothing measured changes, as ratios of changes of the values.
std::string combination_text(const VecX& direction, const Study& study, const VecX& z) {
  constexpr double kNegligible = 1e-3;
  const double largest = direction.cwiseAbs().maxCoeff();
  std::string text;
  int count = 0;
  for (Eigen::Index j = 0; j < direction.size(); ++j) {
    if (std::abs(direction[j]) < kNegligible * largest) continue;
    const FitParameter& p = study.values[static_cast<std::size_t>(j)].parameter;
    const double value = p.value(z[j]);
    // in per cent of the value where it has a size
    const double change = direction[j] / largest * p.slope(z[j]);
    text += text.empty() ? "" : " with ";
    text += value != 0 ? fmt::format("{} {:+.4g} %", p.name, change / std::abs(value))
                       : fmt::format("{} {:+.4g}", p.name, 0.01 * change);
    ++count;
  }
  return count == 1
             ? text.substr(0, text.rfind(' ', text.size() - 3)) + ": nothing measured depends on it"
             : text + " changes nothing measured";
}

/// A value without influence goes back to its start, and the rest of the search is judged without
/// it: its column is nothing but the error of the differences, which never settles.
void set_aside(IdentifyResult& result, FitOptions search) {
  std::vector<bool> held = result.fit.at_bound;
  for (std::size_t j = 0; j < held.size(); ++j) {
    if (result.confidence.observable[j] != Observability::kNoInfluence) continue;
    held[j] = true;
    result.fit.at_bound[j] = false;
    result.fit.z[static_cast<Eigen::Index>(j)] = 1;
  }
  search.rank_tolerance = result.confidence.rank_tolerance;
  if (result.fit.status == FitStatus::kStalled && settled(result.fit.J, result.fit.r, held, search))
    result.fit.status = FitStatus::kConverged;
}

void judge(IdentifyResult& result, SceneFit& model, const Study& study, const FitOptions& search) {
  if (result.fit.J.size() == 0 || result.fit.status == FitStatus::kNoDerivative) return;
  VecX errors;
  MatX J;
  if (!derivative_errors(model, result.fit, J, errors)) {
    result.fit.status = FitStatus::kNoDerivative;
    return;
  }
  ConfidenceOptions options;
  options.sigma_known = study.sigma_known();
  options.level = result.level;
  options.derivative_error = errors;
  options.fixed = result.fit.at_bound;
  options.widest.resize(errors.size());
  for (Eigen::Index j = 0; j < errors.size(); ++j) {
    const bool bounded = study.values[static_cast<std::size_t>(j)].parameter.bounded();
    options.widest[j] = bounded ? 0.5 * (model.high()[j] - model.low()[j]) : 1;
    const double length = J.col(j).norm();
    if (length > 3 * errors[j] && !options.fixed[static_cast<std::size_t>(j)])
      result.derivative_error = std::max(result.derivative_error, errors[j] / length);
  }
  result.confidence = confidence(J, result.fit.r, options);
  // a value at a bound: would the data determine it if they were let?
  options.fixed.assign(options.fixed.size(), false);
  const Confidence free = confidence(J, result.fit.r, options);
  for (std::size_t j = 0; j < options.fixed.size(); ++j)
    if (result.fit.at_bound[j]) result.confidence.observable[j] = free.observable[j];
  for (const VecX& direction : result.confidence.combinations)
    result.combinations.push_back(combination_text(direction, study, result.fit.z));
  set_aside(result, search);
}

int exit_code_of(const IdentifyResult& result) {
  if (result.fit.status == FitStatus::kInterrupted) return 128 + stop_signal();
  if (!result.fit.converged()) return kExitSimulationFailed;
  const auto& observable = result.confidence.observable;
  for (std::size_t j = 0; j < observable.size(); ++j)
    if (result.fit.at_bound[j] || observable[j] != Observability::kObservable)
      return kExitExpectationFailed;
  return kExitDone;
}

void warn(const IdentifyResult& result, const Study& study, const Console& console) {
  if (!result.fit.converged()) {
    console.error(fmt::format("the search did not converge: {} after {} iterations{}",
                              to_string(result.fit.status), result.fit.iterations,
                              result.failure.empty() ? "" : "; last refusal: " + result.failure));
  }
  if (!result.has_confidence()) return;
  for (std::size_t j = 0; j < study.values.size(); ++j) {
    const std::string& name = study.values[j].parameter.name;
    if (result.fit.at_bound[j])
      console.warn(name + " ends " + bound_of(result, study, j) +
                   ", where the data push it: no interval; the others are as if it were known");
    switch (result.confidence.observable[j]) {
      case Observability::kNoInfluence:
        console.warn(name + " is not observable: nothing measured depends on it");
        break;
      case Observability::kTooUncertain:
        console.warn(name + " is not observable: its interval is wider than " +
                     (study.values[j].parameter.bounded() ? "its bounds" : "the value itself"));
        break;
      case Observability::kDependent:
      case Observability::kObservable:
        break;
    }
  }
  for (std::size_t c = 0; c < result.combinations.size(); ++c)
    if ((result.confidence.combinations[c].array() != 0).count() > 1)
      console.warn("not observable one by one: " + result.combinations[c]);
  const double chi = result.confidence.reduced_chi_square;
  if (study.sigma_known() && result.confidence.freedom > 0) {
    // Wilson and Hilferty: the cube root of chi-square / freedom is nearly normal
    const double spread = 2.0 / (9 * result.confidence.freedom);
    if ((std::cbrt(chi) - 1 + spread) / std::sqrt(spread) > 3.1)
      console.warn(
          fmt::format("the residuals are {:.3g} times what --sigma says: the model or the "
                      "sigmas are wrong, and the intervals too narrow",
                      std::sqrt(chi)));
  }
}

/// No residuals at the start: whose fault it is decides the exit code.
int no_start(const SceneFit& model, const Console& console) {
  console.error("no answer at the start: " + model.failure());
  return model.scene_refused() ? kExitSceneInvalid : kExitSimulationFailed;
}

void write_results(IdentifyResult& result, const Study& study, const IdentifyOptions& options,
                   const std::filesystem::path& folder, const Console& console) {
  write_file(folder / "residuals.csv", residuals_csv(result, study));
  result.files.emplace_back("residuals.csv");
  if (!options.no_plot) {
    const bool drawn = draw_residuals(study, folder, console);
    result.files.emplace_back("identify.gp");
    if (drawn) result.files.emplace_back("identify.svg");
  }
  result.files.emplace_back("identify.json");
  write_file(folder / "identify.json", identify_json(result, study, options));
}

}  // namespace

int identify_command(const Words& words) {
  const auto parsed = parse_identify_options(words);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const IdentifyOptions& options = std::get<IdentifyOptions>(parsed);
  const Console console(options.console);
  const auto prepared = prepare_study(options, console);
  if (const int* code = std::get_if<int>(&prepared)) return *code;
  const Study& study = std::get<Study>(prepared);
  const OutputFolder folder(choose_output_folder(options.output, study.label + "_identify"),
                            {"identify.json", "cprsim-identify/"});

  const Stopwatch watch;
  SceneFit model(study);
  IdentifyResult result;
  result.level = options.level;
  if (!model.residuals(model.start(), result.start_residuals)) return no_start(model, console);
  FitOptions search;
  search.max_iterations = options.max_iterations;
  search.go_on = [] { return stop_signal() == 0; };
  result.fit = fit(model, model.start(), model.low(), model.high(), search);
  if (result.fit.rejected > 0) result.failure = model.failure();
  judge(result, model, study, search);
  result.exit_code = exit_code_of(result);
  result.simulations = model.simulations();
  result.restarts = model.restarts();
  result.seconds = watch.seconds();

  write_results(result, study, options, folder.path(), console);
  if (console.json()) write_to_stdout(identify_json(result, study, options));
  console.say(identify_text(result, study, folder.path().string()));
  warn(result, study, console);
  return result.exit_code;
}

}  // namespace cprsim
