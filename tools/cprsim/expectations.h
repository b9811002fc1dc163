// SPDX-License-Identifier: BSD-3-Clause
// Watches a run for what the scene's <cprsim:expect> elements demand of it.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/observe.h"
#include "tools/cprsim/trajectory_match.h"
#include "tools/sinks/sink.h"

namespace cprsim {

enum class Verdict {
  kMet,
  kNotMet,
  kNotReached  ///< the run ended before the instant it speaks of
};

const char* to_string(Verdict verdict);

/// One line of an <cprsim:expect>: the value that came nearest to breaking it, or broke it most.
struct CheckResult {
  std::string kind;  ///< value, bound, drift, match, event, converged
  Verdict verdict = Verdict::kNotReached;
  Place place;
  std::string channel;  ///< empty for converged
  double value = 0, time = 0;
  std::string limit;  ///< "max 12", "0.3 within 0.001"
};

struct ExpectResult {
  std::string name;
  Verdict verdict = Verdict::kMet;
  std::vector<CheckResult> checks;
};

class Expectations : public Sink {
 public:
  /// @throws TableError, PairingError for what a <match> names
  explicit Expectations(const Scene& scene);

  void begin(const Snapshot& start) override;

  void resume(const Snapshot& now) override;

  void step(const Snapshot& before, const Snapshot& now) override;
  void visit(Archive& archive) override;

  void finish() override {}

  std::vector<WrittenFile> files() const override { return {}; }

  /// @param converged the run came to its end without a failed step
  std::vector<ExpectResult> results(bool converged) const;

 private:
  /// One expectation and the worst that was seen of it.
  struct Watch {
    Watch(const Scene& scene, const Expectation& expected);

    const Expectation& expected;
    ChannelReader reader;
    bool of_steps = false;  ///< solver channels describe a step: not interpolated
    bool reached_end = false;
    std::optional<TrajectoryMatch> match;
    bool touched = false, happened = false;                   ///< event
    std::vector<double> first;                                ///< drift: the values at `from`
    double worst = -std::numeric_limits<double>::infinity();  ///< violation, > 0 is one
    CheckResult at_worst;
  };

  void look(Watch& watch, const Snapshot& snapshot) const;
  void follow(Watch& watch, const Snapshot& before, const Snapshot& now) const;
  void follow_value(Watch& watch, const Snapshot& before, const Snapshot& now) const;
  void follow_event(Watch& watch, const Snapshot& now) const;
  CheckResult result_of(const Watch& watch, bool converged) const;
  double end() const;

  const Scene& scene_;
  std::vector<std::vector<Watch>> watches_;  ///< as Scene::expects
};

}  // namespace cprsim
