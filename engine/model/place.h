// SPDX-License-Identifier: BSD-3-Clause
// Where in a scene file something was said, so that any later complaint can point there.
#pragma once

namespace cprsim {

/// A position in Scene::files; line and column count from 1, 0 means unknown.
struct Place {
  int file = -1;
  int line = 0;
  int column = 0;

  bool known() const { return line > 0; }
};

}  // namespace cprsim
