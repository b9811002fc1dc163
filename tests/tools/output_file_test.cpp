// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/output_file.h"

#include <gtest/gtest.h>

#include "tests/tools/scratch_folder.h"

namespace cprsim {
namespace {

TEST(OutputFile, HasItsNameOnlyOnceItIsComplete) {
  const ScratchFolder folder;
  {
    OutputFile file(folder / "a.txt");
    file.write("all of it");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
    EXPECT_TRUE(std::filesystem::exists(folder / "a.txt.part"));
    file.commit();
  }
  EXPECT_EQ(contents(folder / "a.txt"), "all of it");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt.part"));
}

TEST(OutputFile, LeavesAnOlderFileAloneUntilThen) {
  const ScratchFolder folder;
  spill(folder / "a.txt", "old");
  {
    OutputFile file(folder / "a.txt");
    file.write("new");
  }
  EXPECT_EQ(contents(folder / "a.txt"), "old");
}

TEST(OutputFile, FlushesWholeBlocksSoThatACrashKeepsThem) {
  const ScratchFolder folder;
  OutputFile file(folder / "a.txt");
  for (int i = 0; i < 1000; ++i)
    file.write(std::string(100, 'x'));
  EXPECT_GT(contents(folder / "a.txt.part").size(), 60000u);  // all but the last block of 64 KiB
}

TEST(OutputFile, NamesTheFileAndTheReasonWhenItCannotWrite) {
  const ScratchFolder folder;
  try {
    OutputFile file(folder / "missing/a.txt");
    FAIL() << "no complaint";
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("missing/a.txt"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos);
  }
}

TEST(OutputFile, ReportsAFullDisk) {
  if (!std::filesystem::exists("/dev/full")) return;
  const ScratchFolder folder;
  std::filesystem::create_symlink("/dev/full", folder / "a.txt.part");
  OutputFile file(folder / "a.txt");
  file.write("x");
  EXPECT_THROW(file.commit(), OutputError);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
}

}  // namespace
}  // namespace cprsim
