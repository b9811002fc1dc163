// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/expectations.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

/// Fraction of a step within which an instant counts as its end (times are sums of rounded steps).
constexpr double kRoundOff = 1e-9;

struct Limit {
  double violation = -std::numeric_limits<double>::infinity();
  std::string text;
};

const char* kind_name(ExpectKind kind) {
  switch (kind) {
    case ExpectKind::kValue:
      return "value";
    case ExpectKind::kBound:
      return "bound";
    case ExpectKind::kDrift:
      return "drift";
    case ExpectKind::kConverged:
      return "converged";
  }
  return "";
}

void tighten(Limit& limit, double violation, const std::string& text) {
  if (std::isnan(violation)) violation = std::numeric_limits<double>::infinity();
  if (violation > limit.violation) limit = {violation, text};
}

/// The limit of an expectation that `value` breaks most, or keeps with the least room.
Limit tightest_limit(const Expectation& expected, std::size_t channel, double value) {
  Limit limit;
  if (expected.kind == ExpectKind::kDrift) {
    const double below = expected.below.value_or(0);
    tighten(limit, value - below, "drift below " + shortest(below));
    return limit;
  }
  if (channel < expected.equals.size()) {
    const double target = expected.equals[channel], tolerance = expected.tolerance.value_or(0);
    tighten(limit, std::abs(value - target) - tolerance,
            shortest(target) + " within " + shortest(tolerance));
  }
  if (expected.above) tighten(limit, *expected.above - value, "above " + shortest(*expected.above));
  if (expected.below) tighten(limit, value - *expected.below, "below " + shortest(*expected.below));
  if (expected.min) tighten(limit, *expected.min - value, "min " + shortest(*expected.min));
  if (expected.max) tighten(limit, value - *expected.max, "max " + shortest(*expected.max));
  return limit;
}

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kMet:
      return "met";
    case Verdict::kNotMet:
      return "not met";
    case Verdict::kNotReached:
      return "not reached";
  }
  return "";
}

Expectations::Watch::Watch(const Scene& scene, const Expectation& what)
    : expected(what),
      reader(scene, what.channels),
      of_steps(std::any_of(what.channels.begin(), what.channels.end(), [](const Channel& channel) {
        return channel.entity == ChannelEntity::kSolver;
      })) {
  at_worst.kind = kind_name(what.kind);
  at_worst.place = what.place;
}

Expectations::Expectations(const Scene& scene) : scene_(scene) {
  for (const ExpectSpec& spec : scene.expects) {
    std::vector<Watch>& watches = watches_.emplace_back();
    for (const Expectation& expected : spec.all)
      watches.emplace_back(scene, expected);
  }
}

void Expectations::begin(const Snapshot& start) {
  for (std::vector<Watch>& watches : watches_) {
    for (Watch& watch : watches) {
      // the search for the start is no step, unless it is all there is
      if (watch.of_steps && scene_.simulation.mode != Mode::kStatic) continue;
      follow(watch, start, start);
    }
  }
}

void Expectations::step(const Snapshot& before, const Snapshot& now) {
  for (std::vector<Watch>& watches : watches_) {
    for (Watch& watch : watches)
      follow(watch, before, now);
  }
}

void Expectations::visit(Archive& archive) {
  constexpr std::size_t kMostChannels = 100'000;
  for (std::vector<Watch>& watches : watches_)
    for (Watch& watch : watches) {
      watch.reader.visit(archive);
      archive(watch.reached_end);
      watch.first.resize(archive.count(watch.first.size(), kMostChannels));
      archive.doubles(watch.first);
      archive(watch.worst);
      archive(watch.at_worst.channel);
      archive(watch.at_worst.value);
      archive(watch.at_worst.time);
      archive(watch.at_worst.limit);
    }
}

void Expectations::follow(Watch& watch, const Snapshot& before, const Snapshot& now) const {
  const Expectation& expected = watch.expected;
  if (expected.kind == ExpectKind::kConverged) return;
  const bool start = &before == &now;
  const double slack = kRoundOff * (now.time - before.time);
  const auto passes = [&](double t) {
    return t <= now.time + slack && (start ? t >= now.time : t > before.time + slack);
  };

  if (expected.kind == ExpectKind::kValue) {
    if (!passes(expected.at)) return;
    look(watch, watch.of_steps ? now : interpolate(before, now, expected.at));
    watch.reached_end = true;
    return;
  }
  const double end = scene_.simulation.mode == Mode::kStatic ? 0 : scene_.simulation.duration;
  const double to = expected.to < 0 ? end : expected.to;
  if (to < expected.from) return;  // --duration ends the run before
  if (!watch.of_steps && passes(expected.from))
    look(watch, interpolate(before, now, expected.from));
  if (now.time >= expected.from - slack && now.time <= to + slack) look(watch, now);
  if (passes(to)) {
    if (!watch.of_steps) look(watch, interpolate(before, now, to));
    watch.reached_end = true;
  }
}

void Expectations::look(Watch& watch, const Snapshot& snapshot) const {
  std::vector<double> values = watch.reader.read(snapshot);
  if (watch.expected.kind == ExpectKind::kDrift) {
    if (watch.first.empty()) watch.first = values;
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = std::abs(values[i] - watch.first[i]);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Limit limit = tightest_limit(watch.expected, i, values[i]);
    if (limit.violation <= watch.worst) continue;
    watch.worst = limit.violation;
    watch.at_worst.channel = watch.expected.channels[i].name;
    watch.at_worst.value = values[i];
    watch.at_worst.time = snapshot.time;
    watch.at_worst.limit = limit.text;
  }
}

CheckResult Expectations::result_of(const Watch& watch, bool converged) const {
  CheckResult result = watch.at_worst;
  if (watch.expected.kind == ExpectKind::kConverged) {
    result.verdict = converged ? Verdict::kMet : Verdict::kNotMet;
  } else if (watch.worst > 0) {
    result.verdict = Verdict::kNotMet;
  } else {
    result.verdict = watch.reached_end ? Verdict::kMet : Verdict::kNotReached;
  }
  return result;
}

std::vector<ExpectResult> Expectations::results(bool converged) const {
  std::vector<ExpectResult> results;
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    ExpectResult result;
    result.name = scene_.expects[i].name;
    for (const Watch& watch : watches_[i]) {
      result.checks.push_back(result_of(watch, converged));
      const Verdict verdict = result.checks.back().verdict;
      if (verdict == Verdict::kNotMet || result.verdict == Verdict::kMet) result.verdict = verdict;
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace cprsim
