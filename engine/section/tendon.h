// SPDX-License-Identifier: BSD-3-Clause
// The way of a tendon along its rod, frozen from the scene: offset and slope at any section.
#pragma once

#include <vector>

#include "engine/model/tendon_spec.h"
#include "engine/section/tendon_section.h"

namespace cprsim {

class Tendon {
 public:
  /// @param friction whether the scene lists tendon_friction
  explicit Tendon(const TendonSpec& spec, bool friction = false)
      : spec_(spec), friction_(friction ? spec.friction : 0) {}

  /// At the fraction s of a rod of this length. @param inside a fraction in the interior of the
  /// piece between two breaks to which s belongs: at a break itself there are two answers.
  TendonPlace at(double s, double inside, double length) const;

  /// Where the law of the section changes by a step: bends of the way and its end, 0 < s < 1.
  std::vector<double> breaks() const;

  double friction() const { return friction_; }

  double end() const { return spec_.termination; }

 private:
  TendonSpec spec_;
  double friction_ = 0;
};

}  // namespace cprsim
