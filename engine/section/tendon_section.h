// SPDX-License-Identifier: BSD-3-Clause
// The tendons of a rod as one of its sections sees them: plain arrays, which the cell kernels read,
// too. Equations in engine/section/tendon_law.h.
#pragma once

namespace cprsim {

/// Where a tendon runs at a section, section axes.
struct TendonPlace {
  double r[3] = {}, r_s[3] = {};  ///< m, and by arc length
  bool there = false;             ///< not beyond its end
};

/// All tendons of a rod at one section.
struct TendonSection {
  int count = 0;
  const TendonPlace* places = nullptr;
  const double* tensions = nullptr;  ///< N

  // what the last evaluation found
  double* stretch = nullptr;                                   ///< |g| of each; 0 beyond its end
  double* directions = nullptr;                                ///< t, three of each
  double moment[3] = {}, force[3] = {};                        ///< Lambda, section axes
  double moment_u[9] = {}, moment_v[9] = {}, force_v[9] = {};  ///< (3), row-major
};

}  // namespace cprsim
