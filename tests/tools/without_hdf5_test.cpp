// SPDX-License-Identifier: BSD-3-Clause
// A program that was built without HDF5 says so, and what to install.
#include <gtest/gtest.h>

#include "tests/tools/synthetic.h"
#include "tools/series/read_series.h"
#include "tools/sinks/array_writer.h"
#include "tools/sinks/output_file.h"

namespace cprsim {
namespace {

template <class Error, class Act>
void expect_advice(Act&& act) {
  try {
    act();
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("install libhdf5-dev"), std::string::npos);
  }
}

TEST(WithoutHdf5, WritingAndReadingNameThePackage) {
  const Scene scene = synthetic_scene();
  expect_advice<OutputError>([&] { make_hdf5_writer("run.h5", scene); });
  expect_advice<TableError>([&] { read_series("run.h5"); });
  EXPECT_EQ(hdf5_version(), "");
}

}  // namespace
}  // namespace cprsim
