// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/identify_result.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/cprsim/version.h"
#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string values_text(const IdentifyResult& result, const Study& study) {
  const std::string percent = fmt::format("{:.6g} %", 100 * result.level);
  std::string text = fmt::format("  {:>14} {:>14} {:>11}  {:<29} {}\n", "start", "value",
                                 "std. error", percent + " interval", "of");
  for (std::size_t j = 0; j < study.values.size(); ++j) {
    const FitParameter& p = study.values[j].parameter;
    const Interval i = interval_of(result, study, j);
    if (result.determined(j)) {
      text += fmt::format("  {:>14.8g} {:>14.8g} {:>11.3g}  {:<29} {}\n", p.start, i.value, i.error,
                          fmt::format("{:.8g} .. {:.8g}", i.low, i.high), p.name);
    } else {
      text += fmt::format("  {:>14.8g} {:>14.8g} {:>11}  {:<29} {}\n", p.start, i.value, "-",
                          state_of(result, study, j), p.name);
    }
  }
  return text;
}

std::string columns_text(const IdentifyResult& result, const Study& study) {
  std::string text =
      fmt::format("  {:>14} {:>14} {:>6}  {}\n", "RMS before", "RMS after", "count", "measured");
  for (std::size_t m = 0; m < study.matches.size(); ++m) {
    long count = 0;
    for (const MeasuredCell& cell : study.cells)
      count += cell.match == m ? 1 : 0;
    const MatchedColumn& match = study.matches[m];
    text +=
        fmt::format("  {:>14.6g} {:>14.6g} {:>6}  {} [{}]\n", rms(study, result.start_residuals, m),
                    rms(study, result.fit.r, m), count, match.channel.name, match.channel.unit);
  }
  return text;
}

std::string correlation_text(const IdentifyResult& result, const Study& study) {
  if (study.values.size() < 2) return "";
  std::string text = "correlation\n";
  const MatX& C = result.confidence.correlation;
  for (Eigen::Index j = 0; j < C.rows(); ++j) {
    text += "  ";
    for (Eigen::Index k = 0; k < C.cols(); ++k)
      text += std::isnan(C(j, k)) ? fmt::format("{:>8}", "-") : fmt::format("{:>8.3f}", C(j, k));
    text += "  " + study.values[static_cast<std::size_t>(j)].parameter.name + "\n";
  }
  return text;
}

std::string counts_text(const Study& study) {
  std::string text = fmt::format("{} numbers in {} rows", study.cells.size(), study.rows.size());
  if (study.missing > 0) text += fmt::format(", {} missing", study.missing);
  if (study.rows_without_input > 0)
    text += fmt::format(", {} rows without an input", study.rows_without_input);
  if (study.rows_after_end > 0)
    text += fmt::format(", {} rows after the end of the run", study.rows_after_end);
  return text;
}

std::string quality_text(const IdentifyResult& result, const Study& study) {
  const Confidence& c = result.confidence;
  std::string text;
  if (study.sigma_known()) {
    text += fmt::format("  fit        chi-square {:.4g} for {} degrees of freedom\n",
                        result.fit.sum, c.freedom);
  } else if (c.freedom > 0) {
    text += fmt::format(
        "  fit        one standard deviation, estimated: {:.4g} {}, {} degrees of "
        "freedom\n",
        c.sigma, study.matches.front().channel.unit, c.freedom);
  } else {
    text += "  fit        as many values as data: nothing is left to estimate errors from\n";
  }
  text += fmt::format("  condition  {:.3g}; derivatives good to {:.1g}\n", c.condition,
                      result.derivative_error);
  return text;
}

}  // namespace

bool IdentifyResult::determined(std::size_t j) const {
  return has_confidence() && !fit.at_bound[j] &&
         confidence.observable[j] == Observability::kObservable &&
         std::isfinite(confidence.standard_error[static_cast<Eigen::Index>(j)]);
}

std::string bound_of(const IdentifyResult& result, const Study& study, std::size_t j) {
  if (!result.fit.at_bound[j]) return "";
  const FitParameter& p = study.values[j].parameter;
  const double value = p.value(result.fit.z[static_cast<Eigen::Index>(j)]);
  return value < 0.5 * (p.low + p.high) ? "at its lower bound" : "at its upper bound";
}

std::string state_of(const IdentifyResult& result, const Study& study, std::size_t j) {
  if (!result.has_confidence()) return "not found";
  switch (result.confidence.observable[j]) {
    case Observability::kNoInfluence:
      return "NOT OBSERVABLE: no influence";
    case Observability::kDependent:
      return "NOT OBSERVABLE: dependent";
    case Observability::kTooUncertain:
      return "NOT OBSERVABLE: too uncertain";
    case Observability::kObservable:
      break;
  }
  if (result.fit.at_bound[j]) return bound_of(result, study, j);
  const double error = result.confidence.standard_error[static_cast<Eigen::Index>(j)];
  return std::isnan(error) ? "no error estimate" : "observable";
}

Interval interval_of(const IdentifyResult& result, const Study& study, std::size_t j) {
  const auto k = static_cast<Eigen::Index>(j);
  const FitParameter& p = study.values[j].parameter;
  const double z = result.fit.z.size() > 0 ? result.fit.z[k] : 1;
  Interval interval{p.value(z), kNan, kNan, kNan};
  if (!result.determined(j)) return interval;
  const double half = result.confidence.half_width[k];
  interval.error = std::abs(p.slope(z)) * result.confidence.standard_error[k];
  interval.low = p.extended(z - half);
  interval.high = p.extended(z + half);
  return interval;
}

double rms(const Study& study, const VecX& residuals, std::size_t match) {
  double sum = 0;
  long count = 0;
  const double sigma = study.matches[match].sigma.value_or(1);
  for (std::size_t i = 0; i < study.cells.size(); ++i) {
    if (study.cells[i].match != match) continue;
    const double r = residuals[static_cast<Eigen::Index>(i)] * sigma;
    sum += r * r;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : kNan;
}

std::string identify_text(const IdentifyResult& result, const Study& study,
                          const std::string& folder) {
  std::string text =
      fmt::format("{}: {} from {}, {} in {} iterations, {} simulations, {:.2g} s\n", study.label,
                  counts_text(study), study.table.path, to_string(result.fit.status),
                  result.fit.iterations, result.simulations, result.seconds);
  text += values_text(result, study) + columns_text(result, study);
  if (result.has_confidence()) {
    text += quality_text(result, study) + correlation_text(result, study);
    for (const std::string& combination : result.combinations)
      text += "  undetermined: " + combination + "\n";
  }
  std::string files;
  for (const std::string& file : result.files)
    files += (files.empty() ? "" : ",") + file;
  return text + "  wrote      " + folder + "/{" + files + "}\n";
}

std::string identify_json(const IdentifyResult& result, const Study& study,
                          const IdentifyOptions& options) {
  Json json = {{"schema", "cprsim-identify/1"},
               {"version", version().number},
               {"revision", version().revision},
               {"scene", {{"path", options.path}, {"hash", study.hash}}},
               {"data", options.data},
               {"status", to_string(result.fit.status)},
               {"exit_code", result.exit_code},
               {"kind", study.dynamic() ? "record" : "equilibria"},
               {"numbers", study.cells.size()},
               {"rows", study.rows.size()},
               {"missing", study.missing},
               {"rows_without_input", study.rows_without_input},
               {"rows_after_end", study.rows_after_end},
               {"iterations", result.fit.iterations},
               {"simulations", result.simulations},
               {"rejected_trials", result.fit.rejected},
               {"restarts", result.restarts},
               {"sum_before", result.fit.start_sum},
               {"sum_after", result.fit.sum},
               {"sigma_known", study.sigma_known()}};
  json["options"] = Json::array();
  for (const auto& [name, value] : given(options.scene))
    json["options"].push_back({{"name", name}, {"value", value}});
  if (!result.failure.empty()) json["last_failure"] = result.failure;
  if (result.has_confidence()) {
    const Confidence& c = result.confidence;
    json["degrees_of_freedom"] = c.freedom;
    json["sigma"] = study.sigma_known() ? Json(nullptr) : number(c.sigma);
    json["reduced_chi_square"] = number(c.reduced_chi_square);
    json["condition"] = number(c.condition);
    json["derivative_error"] = result.derivative_error;
    json["confidence_level"] = result.level;
  }
  json["values"] = Json::array();
  for (std::size_t j = 0; j < study.values.size(); ++j) {
    const FitParameter& p = study.values[j].parameter;
    const Interval i = interval_of(result, study, j);
    json["values"].push_back({{"paths", study.values[j].paths},
                              {"start", p.start},
                              {"lower_bound", number(p.low)},
                              {"upper_bound", number(p.high)},
                              {"scale", p.logarithmic() ? "logarithmic" : "linear"},
                              {"value", i.value},
                              {"determined", result.determined(j)},
                              {"state", state_of(result, study, j)},
                              {"standard_error", number(i.error)},
                              {"interval", {number(i.low), number(i.high)}}});
  }
  json["correlation"] = Json::array();
  const MatX& C = result.confidence.correlation;
  for (Eigen::Index j = 0; j < C.rows(); ++j) {
    Json row = Json::array();
    for (Eigen::Index k = 0; k < C.cols(); ++k)
      row.push_back(number(C(j, k)));
    json["correlation"].push_back(std::move(row));
  }
  json["undetermined_combinations"] = result.combinations;
  json["measured"] = Json::array();
  for (std::size_t m = 0; m < study.matches.size(); ++m) {
    const MatchedColumn& match = study.matches[m];
    json["measured"].push_back({{"column", match.column},
                                {"channel", match.channel.name},
                                {"unit", match.channel.unit},
                                {"sigma", match.sigma ? Json(*match.sigma) : Json(nullptr)},
                                {"rms_before", number(rms(study, result.start_residuals, m))},
                                {"rms_after", number(rms(study, result.fit.r, m))}});
  }
  json["files"] = Json::array();
  for (const std::string& file : result.files)
    json["files"].push_back({{"name", file}});
  json["timings"] = {{"total", result.seconds}};
  return json.dump(2) + "\n";
}

std::string residuals_csv(const IdentifyResult& result, const Study& study) {
  std::string text = std::string("line,") + (study.dynamic() ? "time [s]" : "row") +
                     ",channel,unit,measured,computed before,computed after,residual\n";
  for (std::size_t i = 0; i < study.cells.size(); ++i) {
    const MeasuredCell& cell = study.cells[i];
    const MatchedColumn& match = study.matches[cell.match];
    const double sigma = match.sigma.value_or(1);
    const auto k = static_cast<Eigen::Index>(i);
    const double after = result.fit.r[k] * sigma;
    const std::string at =
        study.dynamic() ? shortest(study.times[cell.row]) : std::to_string(cell.row + 1);
    const bool comma = match.channel.name.find(',') != std::string::npos;
    const std::string name = comma ? '"' + match.channel.name + '"' : match.channel.name;
    text += fmt::format("{},{},{},{},{},{},{},{}\n", study.table.lines[cell.row], at, name,
                        match.channel.unit, shortest(cell.value),
                        shortest(cell.value + result.start_residuals[k] * sigma),
                        shortest(cell.value + after), shortest(after));
  }
  return text;
}

}  // namespace cprsim
