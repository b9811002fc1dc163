# SPDX-License-Identifier: BSD-3-Clause
# Writes version.cpp at build time, and only if it changed: cmake -DSOURCE= -DOUTPUT= -DNUMBER= -DBUILD= -P
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12
                OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT revision)
  set(revision unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/version.h"

namespace cprsim {

const Version& version() {
  static constexpr Version kVersion{"@NUMBER@", "@revision@", "@BUILD@"};
  return kVersion;
}

}  // namespace cprsim
]])
