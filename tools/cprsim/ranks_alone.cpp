// SPDX-License-Identifier: BSD-3-Clause
// Without MPI.
#include "tools/cprsim/ranks.h"

namespace cprsim {

Ranks::Ranks() = default;

Ranks::~Ranks() = default;

void Ranks::meet() const {}

std::string Ranks::tell(const std::string& text) const {
  return text;
}

void Ranks::give_up(int) const {}

}  // namespace cprsim
