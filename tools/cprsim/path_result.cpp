// SPDX-License-Identifier: BSD-3-Clause
// path.csv, path.json and the summary of `cprsim path`.
#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/run/observe.h"
#include "tools/cprsim/path_words.h"
#include "tools/cprsim/version.h"
#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kPerDegree = 180 / std::numbers::pi;

const std::string& link_name(const StaticStudy& study, std::size_t body) {
  const int link = study.robot().bodies[body].links.front();
  return study.scene().bodies[static_cast<std::size_t>(link)].name;
}

/// Position and angles of the moving links at a state.
Json pose_json(StaticStudy& study, const StaticStudy::State& state) {
  study.restore(state);
  Json json = Json::object();
  for (std::size_t b = 0; b < study.robot().bodies.size(); ++b) {
    const int link = study.robot().bodies[b].links.front();
    const Pose X = study.robot().link_pose(static_cast<std::size_t>(link));
    const Vec3 angles = angles_of(X.R);
    json[link_name(study, b)] = {{"position", {X.p.x(), X.p.y(), X.p.z()}},
                                 {"angles_rad", {angles.x(), angles.y(), angles.z()}}};
  }
  return json;
}

Json drives_json(const StaticStudy& study, const StaticStudy::State& state) {
  Json json = Json::object();
  for (std::size_t i = 0; i < study.drives().size(); ++i)
    json[study.drives()[i].name] = state.drives[i];
  return json;
}

Json event_json(StaticStudy& study, const PathEvent& event, const PathScale& scale) {
  Json json = {{"kind", to_string(event.kind)},
               {"parameter", scale.value(event.point.lambda)},
               {"arclength", event.point.s},
               {"unstable_before", event.before},
               {"unstable_after", event.after},
               {"softest_N_per_m", event.point.softest},
               {"drives", drives_json(study, event.point.state)},
               {"pose", pose_json(study, event.point.state)},
               {"critical_motion", Json::object()}};
  for (std::size_t b = 0; b < event.bodies.size(); ++b) {
    const Vec6& m = event.bodies[b];
    json["critical_motion"][link_name(study, b)] = {{"rotation", {m[0], m[1], m[2]}},
                                                    {"translation_m", {m[3], m[4], m[5]}}};
  }
  return json;
}

std::string pose_text(StaticStudy& study, const StaticStudy::State& state) {
  study.restore(state);
  std::string text;
  for (std::size_t b = 0; b < study.robot().bodies.size(); ++b) {
    const int link = study.robot().bodies[b].links.front();
    const Pose X = study.robot().link_pose(static_cast<std::size_t>(link));
    const Vec3 a = kPerDegree * angles_of(X.R);
    text += fmt::format(
        "      {} at ({:.6f} {:.6f} {:.6f}) m, roll pitch yaw ({:.4f} {:.4f} {:.4f}) deg\n",
        link_name(study, b), X.p.x(), X.p.y(), X.p.z(), a.x(), a.y(), a.z());
  }
  return text;
}

}  // namespace

std::vector<PathRow> rows_of(const Path& path) {
  std::vector<PathRow> rows;
  std::size_t e = 0;
  for (const PathPoint& point : path.points) {
    for (; e < path.events.size() && path.events[e].point.s <= point.s; ++e)
      rows.push_back({&path.events[e].point, &path.events[e]});
    rows.push_back({&point, nullptr});
  }
  return rows;
}

std::string path_csv(StaticStudy& study, const PathResult& result, const PathScale& scale,
                     const std::vector<Channel>& channels) {
  std::string text =
      fmt::format("path,event,arclength [1],{} [{}],verdict,unstable [1],softest [N/m]", scale.name,
                  scale.unit);
  for (const Parameter& drive : study.drives())
    text += fmt::format(",{} [{}]", drive.name, drive.unit);
  for (const Channel& channel : channels)
    text += fmt::format(",{} [{}]", channel.name, channel.unit);
  text += "\n";
  for (const NamedPath& named : result.paths)
    for (const PathRow& row : rows_of(named.path)) {
      const PathPoint& p = *row.point;
      text += fmt::format("{},{},{},{},{},{},{}", named.name,
                          row.event != nullptr ? to_string(row.event->kind) : "", shortest(p.s),
                          shortest(scale.value(p.lambda)), to_string(p.verdict),
                          row.unstable_after(), shortest(p.softest));
      for (const double value : p.state.drives)
        text += "," + shortest(value);
      study.restore(p.state);
      const Snapshot now = study.snapshot();
      for (const Channel& channel : channels)
        text += "," + shortest(evaluate(channel, study.scene(), now));
      text += "\n";
    }
  return text;
}

std::string path_json(StaticStudy& study, const PathResult& result, const PathScale& scale,
                      const PathWords& words) {
  Json json = {
      {"schema", "cprsim-path/1"},
      {"version", version().number},
      {"scene", {{"path", words.path}, {"name", study.scene().name}, {"hash", study.scene().hash}}},
      {"parameter",
       {{"name", scale.name}, {"unit", scale.unit}, {"from", scale.from}, {"to", scale.to}}},
      {"seconds", result.seconds},
      {"paths", Json::array()},
      {"releases", Json::array()},
      {"files", Json::array()}};
  for (const NamedPath& named : result.paths) {
    Json one = {{"name", named.name},
                {"end", to_string(named.path.end)},
                {"points", named.path.points.size()},
                {"refused_steps", named.path.refused},
                {"events", Json::array()}};
    for (const PathEvent& event : named.path.events)
      one["events"].push_back(event_json(study, event, scale));
    json["paths"].push_back(one);
  }
  for (const NamedRelease& named : result.releases) {
    const Release& r = named.release;
    json["releases"].push_back({{"event", named.event},
                                {"side", named.side},
                                {"parameter", scale.value(named.lambda)},
                                {"status", to_string(r.solve.status)},
                                {"verdict", to_string(r.end.verdict)},
                                {"moved", r.moved},
                                {"drives", drives_json(study, r.end.state)},
                                {"pose", pose_json(study, r.end.state)}});
  }
  for (const std::string& file : result.files)
    json["files"].push_back({{"name", file}});
  return json.dump(2) + "\n";
}

std::string path_text(StaticStudy& study, const PathResult& result, const PathScale& scale,
                      const std::string& label, const std::string& folder) {
  const std::string unit = scale.unit == "1" ? "" : " " + scale.unit;
  std::string text = fmt::format("{}: {} from {:.6g} to {:.6g}{}\n", label, scale.name, scale.from,
                                 scale.to, unit);
  for (const NamedPath& named : result.paths) {
    const Path& path = named.path;
    text +=
        fmt::format("  {:<12} {} points, {}", named.name, path.points.size(), to_string(path.end));
    if (!path.points.empty())
      text += fmt::format(" at {:.8g}{}", scale.value(path.points.back().lambda), unit);
    text += path.events.empty() ? ", no events\n" : "\n";
    if (path.events.empty()) continue;
    text += fmt::format("    {:<13} {:>20}  {:>10}  {}\n", "event", "[" + scale.unit + "]",
                        "arclength", "unstable directions");
    for (const PathEvent& event : path.events)
      text +=
          fmt::format("    {:<13} {:>20.12g}  {:>10.5g}  {} -> {}\n", to_string(event.kind),
                      scale.value(event.point.lambda), event.point.s, event.before, event.after);
  }
  for (const NamedRelease& named : result.releases) {
    const Release& r = named.release;
    text += fmt::format("  let go at {:.8g}{} after {}, side {:+d}: {}, {}, moved by {:.4g}\n",
                        scale.value(named.lambda), unit, named.event, named.side,
                        to_string(r.solve.status), to_string(r.end.verdict), r.moved);
    text += pose_text(study, r.end.state);
  }
  text += fmt::format("  wrote        {}/{{", folder);
  for (std::size_t i = 0; i < result.files.size(); ++i)
    text += (i > 0 ? "," : "") + result.files[i];
  return text + "}\n";
}

}  // namespace cprsim
