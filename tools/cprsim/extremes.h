// SPDX-License-Identifier: BSD-3-Clause
// What is kept of a run for its report: the energy balance and the deepest penetration.
#pragma once

#include <optional>

#include "tools/sinks/sink.h"

namespace cprsim {

class Extremes : public Sink {
 public:
  void begin(const Snapshot& start) override;

  void resume(const Snapshot&) override {}

  void step(const Snapshot& before, const Snapshot& now) override;
  void visit(Archive& archive) override;

  void finish() override {}

  std::vector<WrittenFile> files() const override { return {}; }

  /// At the last state.
  const EnergySample& energy() const { return energy_; }

  double worst_balance() const { return worst_balance_; }  ///< J, largest |balance| so far

  double largest_work() const { return largest_work_; }  ///< J, largest |work| so far

  double largest_kinetic() const { return largest_kinetic_; }

  double deepest_penetration() const { return deepest_penetration_; }

  /// The largest energy that was exchanged, to which the balance is compared: work, kinetic energy
  /// or dissipated energy. 0 if nothing moved.
  double exchanged() const;

  /// How much of it the balance misses at worst; nothing if nothing but round-off moved.
  std::optional<double> relative_balance() const;

 private:
  void note(const Snapshot& now);

  EnergySample energy_;
  double worst_balance_ = 0, largest_work_ = 0, largest_kinetic_ = 0, deepest_penetration_ = 0;
};

}  // namespace cprsim
