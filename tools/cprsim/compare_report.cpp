// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/compare_report.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tools/cprsim/version.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegree = 180 / std::numbers::pi;

/// "0.31 %", or a dash where it makes no sense.
std::string percent(double part, double whole) {
  return whole > 0 ? fmt::format("{:.3g} %", 100 * part / whole) : "-";
}

/// What position errors are per cent of.
double length_of(const CompareReport& report, const QuantityComparison& comparison) {
  return comparison.quantity.unit == "m" ? report.length.value_or(0) : 0;
}

/// roll, pitch, yaw of R, as in SDF.
Vec3 rpy_of(const Mat3& R) {
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
          std::atan2(R(1, 0), R(0, 0))};
}

std::string table_of(const CompareReport& report) {
  std::size_t width = 8;
  for (const QuantityComparison& c : report.quantities)
    width = std::max(width, c.quantity.name.size() + shown_unit(c).size() + 3);
  std::string text =
      fmt::format("  {:<{}} {:>10} {:>10} {:>10} {:>10} {:>10} {:>11} {:>10}\n", "quantity", width,
                  "RMS", "max", "at [s]", "95 %", "final", "RMS/length", "RMS/range");
  for (const QuantityComparison& c : report.quantities) {
    const ErrorNumbers& n = c.numbers;
    const double f = shown_factor(c);
    text +=
        fmt::format("  {:<{}} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g} {:>11} {:>10}\n",
                    c.quantity.name + " [" + shown_unit(c) + "]", width, f * n.rms, f * n.max,
                    n.max_time, f * n.percentile_95, f * n.last,
                    percent(n.rms, length_of(report, c)), percent(n.rms, n.range));
  }
  return text;
}

std::string lag_text(const CompareReport& report) {
  if (!report.lag) return "";
  const double ms = 1000 * report.lag->seconds;
  const double gain = 100 * (1 - report.lag->after / std::max(report.lag->before, 1e-300));
  if (report.lag_applied)
    return fmt::format("lag        {:.4g} ms taken out (the run is that much late)\n", ms);
  if (gain < 1) return "";
  return fmt::format(
      "lag        the run is {:.4g} ms {}: errors would fall by {:.0f} % without it "
      "(--apply-lag)\n",
      std::abs(ms), ms > 0 ? "late" : "early", gain);
}

std::string vibration_text(const VibrationComparison& v) {
  std::string text = fmt::format(
      "vibration  {}: {:.4g} Hz, reference {:.4g} Hz ({:+.2g} %); amplitude {:.3g} of its", v.name,
      v.run.frequency, v.reference.frequency, 100 * (v.run.frequency / v.reference.frequency - 1),
      v.run.amplitude / v.reference.amplitude);
  if (v.run.damping_ratio && v.reference.damping_ratio)
    text += fmt::format("; damping ratio {:.3g}, reference {:.3g}", *v.run.damping_ratio,
                        *v.reference.damping_ratio);
  return text + "\n";
}

Json vibration_json(const Vibration& v) {
  Json json = {{"frequency", v.frequency}, {"amplitude", v.amplitude}};
  if (v.damping_ratio) json["damping_ratio"] = *v.damping_ratio;
  return json;
}

Json numbers_json(const CompareReport& report, const QuantityComparison& c) {
  const ErrorNumbers& n = c.numbers;
  const double f = shown_factor(c), length = length_of(report, c);
  Json json = {{"name", c.quantity.name},
               {"reference_name", c.reference.name},
               {"unit", shown_unit(c)},
               {"samples", c.time.size()},
               {"left_out", c.outside},
               {"rms", f * n.rms},
               {"mean", f * n.mean},
               {"median", f * n.median},
               {"percentile_95", f * n.percentile_95},
               {"max", f * n.max},
               {"max_time", n.max_time},
               {"final", f * n.last},
               {"bias", f * n.bias},
               {"range", f * n.range}};
  if (length > 0) {
    json["rms_percent_of_length"] = 100 * n.rms / length;
    json["max_percent_of_length"] = 100 * n.max / length;
  }
  if (n.range > 0) json["rms_percent_of_range"] = 100 * n.rms / n.range;
  return json;
}

}  // namespace

std::optional<VibrationComparison> compare_vibration(const QuantityComparison& c) {
  if (c.quantity.kind == QuantityKind::kAttitude || c.time.empty()) return std::nullopt;
  const auto along = [](const std::vector<QuantityValue>& values, std::size_t axis) {
    std::vector<double> all;
    for (const QuantityValue& value : values)
      all.push_back(value[static_cast<Eigen::Index>(axis)]);
    return all;
  };
  std::size_t axis = 0;
  double widest = -1;
  for (std::size_t i = 0; i < c.quantity.width(); ++i) {
    const std::vector<double> all = along(c.expected, i);
    const auto [least, most] = std::minmax_element(all.begin(), all.end());
    if (*most - *least <= widest) continue;
    widest = *most - *least;
    axis = i;
  }
  const auto run = find_vibration(c.time, along(c.value, axis)),
             reference = find_vibration(c.time, along(c.expected, axis));
  if (!run || !reference) return std::nullopt;
  static constexpr const char* kComponents[] = {".x", ".y", ".z"};
  return VibrationComparison{c.quantity.name + (c.quantity.width() == 3 ? kComponents[axis] : ""),
                             *run, *reference};
}

bool CompareReport::kept() const {
  return std::all_of(limits.begin(), limits.end(), [](const CheckedLimit& l) { return l.kept(); });
}

std::string shown_unit(const QuantityComparison& comparison) {
  if (comparison.quantity.kind == QuantityKind::kAttitude) return "deg";
  return comparison.quantity.unit.empty() ? "1" : comparison.quantity.unit;
}

double shown_factor(const QuantityComparison& comparison) {
  return comparison.quantity.kind == QuantityKind::kAttitude ? kDegree : 1;
}

std::string to_json(const CompareReport& report) {
  Json json = {{"schema", "cprsim-compare/1"},
               {"run", report.run_path},
               {"reference", report.reference_path},
               {"version", {{"number", version().number}, {"revision", version().revision}}},
               {"from", report.from},
               {"to", report.to},
               {"instants", report.instants},
               {"ignored", report.ignored},
               {"quantities", Json::array()},
               {"vibrations", Json::array()},
               {"limits", Json::array()},
               {"kept", report.kept()},
               {"files", Json::array()}};
  for (const char* name : {"compare.csv", "compare.gp", "compare.svg"})
    json["files"].push_back({{"name", name}});
  if (report.length) json["length"] = *report.length;
  if (report.lag) {
    json["lag"] = {{"seconds", report.lag->seconds},
                   {"applied", report.lag_applied},
                   {"mismatch", report.lag->before},
                   {"mismatch_without", report.lag->after}};
  }
  if (report.aligned) {
    const Vec3 &p = report.aligned->p, angles = rpy_of(report.aligned->R);
    json["aligned"] = {p.x(), p.y(), p.z(), angles.x(), angles.y(), angles.z()};
  }
  for (const QuantityComparison& c : report.quantities)
    json["quantities"].push_back(numbers_json(report, c));
  for (const VibrationComparison& v : report.vibrations)
    json["vibrations"].push_back({{"name", v.name},
                                  {"run", vibration_json(v.run)},
                                  {"reference", vibration_json(v.reference)}});
  for (const CheckedLimit& l : report.limits)
    json["limits"].push_back({{"quantity", l.quantity},
                              {"kind", l.kind},
                              {"unit", l.unit},
                              {"limit", l.limit},
                              {"value", l.value},
                              {"kept", l.kept()}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_summary(const CompareReport& report, const std::string& folder) {
  std::string text =
      fmt::format("{} against {}: {} instants, {:.6g} to {:.6g} s\n", report.run_path,
                  report.reference_path, report.instants, report.from, report.to);
  std::size_t left_out = 0;
  for (const QuantityComparison& c : report.quantities)
    left_out = std::max(left_out, c.outside);
  if (left_out > 0)
    text +=
        fmt::format("           {} of them left out: the run or a number is not there\n", left_out);
  text += table_of(report) + lag_text(report);
  for (const VibrationComparison& v : report.vibrations)
    text += vibration_text(v);
  if (report.aligned) {
    const Vec3 &p = report.aligned->p, angles = rpy_of(report.aligned->R);
    text += fmt::format(
        "aligned    by --ref-frame {:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g} (fitted: a fit hides "
        "calibration errors)\n",
        p.x(), p.y(), p.z(), angles.x(), angles.y(), angles.z());
  }
  if (!report.ignored.empty())
    text += fmt::format("ignored    {} of the reference: the run has no such quantity\n",
                        fmt::join(report.ignored, ", "));
  for (const CheckedLimit& l : report.limits)
    text +=
        fmt::format("{:<10} {} of {}: {:.4g} {}, allowed {:.4g}\n", l.kept() ? "kept" : "NOT KEPT",
                    l.kind, l.quantity, l.value, l.unit, l.limit);
  return text + fmt::format("wrote      {}/{{compare.json,compare.csv,compare.svg}}\n", folder);
}

}  // namespace cprsim
