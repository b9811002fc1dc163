// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/output_folder.h"

#include <gtest/gtest.h>

#include "tests/tools/scratch_folder.h"
#include "tools/sinks/output_file.h"

namespace cprsim {
namespace {

constexpr const char* kOurs =
    R"({"schema": "cprsim-run/1", "files": [{"name": "a.csv"}, {"name": "a_vtk/"},
        {"name": "../outside.csv"}, {"name": "/tmp/absolute.csv"}]})";

TEST(OutputFolder, IsCreatedWithItsParents) {
  const ScratchFolder scratch;
  const OutputFolder folder(scratch / "out/scene");
  EXPECT_TRUE(std::filesystem::is_directory(scratch / "out/scene"));
}

TEST(OutputFolder, RefusesFilesThatItDidNotWriteAndTouchesNone) {
  const ScratchFolder scratch;
  spill(scratch / "thesis.tex", "years of work");
  EXPECT_THROW(OutputFolder folder(scratch.path()), OutputError);
  spill(scratch / "run.json", "{\"schema\": \"something else\"}");
  EXPECT_THROW(OutputFolder folder(scratch.path()), OutputError);
  EXPECT_EQ(contents(scratch / "thesis.tex"), "years of work");
}

TEST(OutputFolder, RemovesTheFilesOfAnEarlierRunAndOnlyThose) {
  const ScratchFolder scratch;
  std::filesystem::create_directories(scratch / "out/a_vtk");
  for (const char* name : {"out/a.csv", "out/a_vtk/000000.vtp", "out/notes.txt", "outside.csv"}) {
    spill(scratch / name, "x");
  }
  spill(scratch / "out/run.json", kOurs);
  const OutputFolder folder(scratch / "out");
  EXPECT_FALSE(std::filesystem::exists(scratch / "out/a.csv"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "out/a_vtk"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "out/run.json"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "out/notes.txt"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "outside.csv"));
}

TEST(OutputFolder, BelongsToOneRunAtATime) {
  const ScratchFolder scratch;
  {
    const OutputFolder first(scratch / "out");
    EXPECT_THROW(OutputFolder second(scratch / "out"), OutputError);
  }
  EXPECT_NO_THROW(OutputFolder third(scratch / "out"));
}

}  // namespace
}  // namespace cprsim
