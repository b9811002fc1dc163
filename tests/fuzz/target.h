// SPDX-License-Identifier: BSD-3-Clause
// What every fuzz target is: a function of bytes that must neither crash nor hang nor claim what is
// not so. libFuzzer calls it with -DCPRSIM_FUZZ=ON; the tests call it with the files of corpus/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace cprsim {

/// Ends the program, which is how a fuzzer learns of a claim that does not hold.
inline void require(bool holds, const char* claim) {
  if (holds) return;
  std::fprintf(stderr, "fuzz target: not so: %s\n", claim);
  std::abort();
}

}  // namespace cprsim
