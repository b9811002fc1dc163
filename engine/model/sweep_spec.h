// SPDX-License-Identifier: BSD-3-Clause
// A study that a scene asks for: values to vary, what to compare, what to compare it with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/model/channel.h"
#include "engine/model/place.h"

namespace cprsim {

/// How deviations over time become one number.
enum class Norm { kMax, kRms, kFinal };

struct SweepVary {
  std::string path;  ///< as for --set
  std::vector<std::string> values;
};

struct SweepMeasure {
  std::string name;               ///< as written, e.g. robot::platform.position
  std::vector<Channel> channels;  ///< one, or the components of a vector
  Norm norm = Norm::kMax;
};

struct SweepSpec {
  // Compiled once, in scene.cpp: dozens of files make and copy one.
  SweepSpec();
  SweepSpec(const SweepSpec&);
  SweepSpec(SweepSpec&&) noexcept;
  SweepSpec& operator=(const SweepSpec&);
  SweepSpec& operator=(SweepSpec&&) noexcept;
  ~SweepSpec();

  std::string name;
  Place place;
  std::vector<SweepVary> vary;
  std::optional<std::string> reference;  ///< value of the first path that counts as exact
  std::vector<SweepMeasure> measures;
};

}  // namespace cprsim
