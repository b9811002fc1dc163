// SPDX-License-Identifier: BSD-3-Clause
// Which cprsim this is, written at build time.
#pragma once

namespace cprsim {

struct Version {
  const char* number;    ///< 0.1.0
  const char* revision;  ///< git describe, or "unknown" outside a clone
  const char* build;     ///< build type and compiler
};

/// The version of this program.
const Version& version();

}  // namespace cprsim
