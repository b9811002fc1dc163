// SPDX-License-Identifier: BSD-3-Clause
// A program that was built without an optional library says so, and what to install.
#include <gtest/gtest.h>

#include "tests/tools/synthetic.h"
#include "tools/series/read_series.h"
#include "tools/sinks/array_writer.h"
#include "tools/sinks/output_file.h"

namespace cprsim {
namespace {

template <class Error, class Act>
void expect_advice(const std::string& package, Act&& act) {
  try {
    act();
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("install " + package), std::string::npos);
  }
}

TEST(WithoutLibraries, WritingAndReadingNameThePackage) {
  const Scene scene = synthetic_scene();
  expect_advice<OutputError>("libhdf5-dev", [&] { make_hdf5_writer("run.h5", scene); });
  expect_advice<TableError>("libhdf5-dev", [&] { read_series("run.h5"); });
  expect_advice<OutputError>("libminizip-dev", [&] { make_npz_writer("run.npz", scene); });
  EXPECT_EQ(hdf5_version(), "");
  EXPECT_FALSE(writes_npz());
}

}  // namespace
}  // namespace cprsim
