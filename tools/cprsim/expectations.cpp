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
    case ExpectKind::kMatch:
      return "match";
    case ExpectKind::kEvent:
      return "event";
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

const char* event_name(EventKind kind) {
  switch (kind) {
    case EventKind::kContact:
      return "contact";
    case EventKind::kSeparation:
      return "separation";
    case EventKind::kLimit:
      return "limit";
  }
  return "";
}

/// "contact between 0.1 s and 0.6 s"
std::string event_text(const Expectation& expected, double end) {
  const double before = expected.to < 0 ? end : expected.to;
  return std::string(event_name(expected.event)) + " between " + shortest(expected.from) +
         " s and " + shortest(before) + " s";
}

/// Of RMS and maximum the one that is broken most, in terms of its limit.
void hold_against(const Expectation& expected, const QuantityComparison& comparison,
                  CheckResult& result) {
  const ErrorNumbers& n = comparison.numbers;
  const double over_rms = expected.rms ? n.rms / *expected.rms : 0;
  const double over_max = expected.max ? n.max / *expected.max : 0;
  const bool by_rms = over_rms > over_max;
  result.value = by_rms ? n.rms : n.max;
  result.time = n.max_time;
  result.limit = (by_rms ? "RMS error at most " + shortest(*expected.rms)
                         : "error at most " + shortest(*expected.max)) +
                 " over " + std::to_string(comparison.time.size()) + " instants";
  const bool kept = std::max(over_rms, over_max) <= 1;  // not a number is never kept
  result.verdict = kept ? Verdict::kMet : Verdict::kNotMet;
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
  if (what.kind == ExpectKind::kMatch) match.emplace(scene, what);
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

void Expectations::resume(const Snapshot& now) {
  for (std::vector<Watch>& watches : watches_)
    for (Watch& watch : watches)
      if (watch.match) watch.match->begin(now);
}

void Expectations::visit(Archive& archive) {
  constexpr std::size_t kMostChannels = 100'000;
  for (std::vector<Watch>& watches : watches_)
    for (Watch& watch : watches) {
      watch.reader.visit(archive);
      for (bool* x : {&watch.reached_end, &watch.touched, &watch.happened})
        archive(*x);
      if (watch.match) watch.match->visit(archive);
      watch.first.resize(archive.count(watch.first.size(), kMostChannels));
      archive.doubles(watch.first);
      archive(watch.worst);
      archive(watch.at_worst.channel);
      archive(watch.at_worst.value);
      archive(watch.at_worst.time);
      archive(watch.at_worst.limit);
    }
}

double Expectations::end() const {
  return scene_.simulation.mode == Mode::kStatic ? 0 : scene_.simulation.duration;
}

void Expectations::follow(Watch& watch, const Snapshot& before, const Snapshot& now) const {
  switch (watch.expected.kind) {
    case ExpectKind::kConverged:
      return;
    case ExpectKind::kMatch:
      if (&before == &now)
        watch.match->begin(now);
      else
        watch.match->step(before, now);
      watch.reached_end = now.time >= watch.match->last_instant() - kRoundOff * now.time;
      return;
    case ExpectKind::kEvent:
      return follow_event(watch, now);
    default:
      return follow_value(watch, before, now);
  }
}

void Expectations::follow_event(Watch& watch, const Snapshot& now) const {
  const Expectation& expected = watch.expected;
  const double to = expected.to < 0 ? end() : expected.to;
  watch.reached_end = now.time >= to * (1 - kRoundOff);
  if (watch.happened) return;
  const std::vector<double>& values = watch.reader.read(now);
  const auto acts =
      std::find_if(values.begin(), values.end(), [](double value) { return value != 0; });
  const bool touches = acts != values.end();
  watch.happened = expected.event == EventKind::kSeparation ? watch.touched && !touches : touches;
  watch.touched = watch.touched || touches;
  if (!watch.happened) return;
  const auto index = touches ? static_cast<std::size_t>(acts - values.begin()) : 0;
  watch.at_worst.channel = expected.channels[index].name;
  watch.at_worst.value = values[index];
  watch.at_worst.time = now.time;
  watch.at_worst.limit = event_text(expected, end());
  watch.worst = now.time < expected.from || now.time > to ? 1 : 0;
}

void Expectations::follow_value(Watch& watch, const Snapshot& before, const Snapshot& now) const {
  const Expectation& expected = watch.expected;
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
  const double to = expected.to < 0 ? end() : expected.to;
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
  const Expectation& expected = watch.expected;
  if (expected.kind == ExpectKind::kMatch) {
    result.channel = expected.channels.front().name;
    if (expected.channels.size() > 1) result.channel.resize(result.channel.rfind('.'));
    const auto comparison = watch.match->compare();
    if (comparison) hold_against(expected, *comparison, result);
    // what is broken is broken, however much was left to come
    if (!watch.reached_end && result.verdict == Verdict::kMet)
      result.verdict = Verdict::kNotReached;
    return result;
  }
  if (expected.kind == ExpectKind::kEvent && !watch.happened) {
    result.verdict = watch.reached_end ? Verdict::kNotMet : Verdict::kNotReached;
    result.limit = event_text(expected, end());
    return result;
  }
  if (watch.expected.kind == ExpectKind::kConverged) {
    result.verdict = converged ? Verdict::kMet : Verdict::kNotMet;
  } else if (watch.worst > 0) {
    result.verdict = Verdict::kNotMet;
  } else {
    const bool seen = watch.reached_end || watch.happened;
    result.verdict = seen ? Verdict::kMet : Verdict::kNotReached;
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
