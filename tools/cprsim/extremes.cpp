// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/extremes.h"

#include <algorithm>
#include <cmath>

namespace cprsim {

void Extremes::begin(const Snapshot& start) {
  note(start);
}

void Extremes::step(const Snapshot&, const Snapshot& now) {
  note(now);
}

void Extremes::note(const Snapshot& now) {
  energy_ = now.energy;
  worst_balance_ = std::max(worst_balance_, std::abs(now.energy.balance));
  largest_work_ = std::max(largest_work_, std::abs(now.energy.work));
  largest_kinetic_ = std::max(largest_kinetic_, now.energy.kinetic);
  deepest_penetration_ = std::max(deepest_penetration_, now.contact.penetration);
}

void Extremes::visit(Archive& archive) {
  cprsim::visit(energy_, archive);
  for (double* x : {&worst_balance_, &largest_work_, &largest_kinetic_, &deepest_penetration_})
    archive(*x);
}

std::optional<double> Extremes::relative_balance() const {
  // an equilibrium that stays one exchanges round-off
  const double stored =
      std::abs(energy_.elastic) + std::abs(energy_.gravity) + std::abs(energy_.magnetic);
  if (exchanged() <= 1e-12 * stored) return std::nullopt;
  return worst_balance_ / exchanged();
}

double Extremes::exchanged() const {
  return std::max({largest_work_, largest_kinetic_, std::abs(energy_.dissipated)});
}

}  // namespace cprsim
