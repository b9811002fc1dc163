// SPDX-License-Identifier: BSD-3-Clause
// What an absent effect costs in a section of a rod: cells by the kernel as it is beside cells by
// one that was compiled without the laws of rotary inertia, varying sections, fluids and tendons.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/effects/callgrind.h"
#include "tests/tools/scratch_folder.h"

namespace cprsim {
namespace {

struct Measured {
  std::string name, bytes;
  long shipped = 0, bare = 0;
};

std::vector<Measured> measured_kernels() {
  const ScratchFolder folder;
  std::string output;
  const std::vector<long> counts =
      instructions_of_calls("'" CPRSIM_BINARY_DIR "/bin/cprsim_section_costs' kernels",
                            "measured_cell", folder.path(), output);
  std::istringstream lines(output);
  std::vector<Measured> all;
  std::size_t call = 0;
  for (std::string line; std::getline(lines, line) && call < counts.size(); ++call) {
    std::istringstream words(line);
    Measured one;
    std::string kernel;
    std::getline(std::getline(std::getline(words, one.name, ';'), kernel, ';'), one.bytes);
    if (kernel == "shipped") all.push_back(one);
    (kernel == "shipped" ? all.back().shipped : all.back().bare) = counts[call];
  }
  return all;
}

TEST(PlainKernel, ExecutesNotAThousandthMoreThanOneWithoutAnyEffect) {
  if (!has_callgrind()) GTEST_SKIP() << kNoCallgrind;
  const std::vector<Measured> all = measured_kernels();
  ASSERT_EQ(all.size(), 8u);
  for (const Measured& at : all) {
    EXPECT_EQ(at.bytes, "same") << at.name;
    EXPECT_GT(at.bare, 1000) << at.name;
    EXPECT_LE(static_cast<double>(at.shipped), 1.001 * static_cast<double>(at.bare))
        << at.name << ": " << at.shipped << " instructions, " << at.bare << " without any effect";
  }
}

/// One sweep of a rod of costed_rods.h.
struct Sweep {
  long instructions = 0;
  std::string found;
};

Sweep measured_sweep(const std::string& program, const std::string& method,
                     const std::string& name) {
  const ScratchFolder folder;
  Sweep sweep;
  const std::vector<long> counts = instructions_of_calls(
      "'" CPRSIM_BINARY_DIR "/bin/" + program + "' " + method + " '" + name + "'", "measured_sweep",
      folder.path(), sweep.found);
  if (!counts.empty()) sweep.instructions = counts.front();
  return sweep;
}

// Of strains and of splines: a rod beside one of a program in which tendons, fluids, loads along
// rods, disks and contact are compiled out.
TEST(PlainRod, ExecutesNotAThousandthMoreThanOneWithoutAnyEffect) {
  if (!has_callgrind()) GTEST_SKIP() << kNoCallgrind;
  for (const char* method : {"strain", "collocation"})
    for (const char* name : {"none, at rest", "none, moving", "gravity", "extension, at rest",
                             "extension, moving", "shear, at rest", "planar, at rest"}) {
      SCOPED_TRACE(std::string(method) + ", " + name);
      const Sweep shipped = measured_sweep("cprsim_section_costs", method, name),
                  bare = measured_sweep("cprsim_bare_section_costs", method, name);
      EXPECT_EQ(shipped.found, bare.found);
      EXPECT_GT(bare.instructions, 20000);
      EXPECT_LE(static_cast<double>(shipped.instructions),
                1.001 * static_cast<double>(bare.instructions))
          << shipped.instructions << " instructions, " << bare.instructions
          << " without any effect";
    }
}

// Products and sums are fused nowhere, whatever the machine could do.
TEST(PlainKernel, GivesTheSameBytesByEveryCopy) {
  const ScratchFolder folder;
  const std::string command = "'" CPRSIM_BINARY_DIR "/bin/cprsim_section_costs' copies > '" +
                              (folder / "out.txt").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(contents(folder / "out.txt"), "0\n");
}

TEST(PlainKernel, CountsTheSameInstructionsAgain) {
  if (!has_callgrind()) GTEST_SKIP() << kNoCallgrind;
  const std::vector<Measured> once = measured_kernels(), again = measured_kernels();
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i)
    EXPECT_EQ(once[i].shipped, again[i].shipped) << once[i].name;
}

}  // namespace
}  // namespace cprsim
