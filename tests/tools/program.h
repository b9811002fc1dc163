// SPDX-License-Identifier: BSD-3-Clause
// The program as people and scripts meet it: words in; exit code, streams and files out.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/scratch_folder.h"

namespace cprsim {

struct Answer {
  int code = -1;
  std::string out, err;

  bool says(const std::string& part) const { return out.find(part) != std::string::npos; }

  bool complains(const std::string& part) const { return err.find(part) != std::string::npos; }
};

/// A test that runs the program in a folder of its own.
class ProgramTest : public testing::Test {
 protected:
  /// `words` as one would type them in a shell.
  Answer run(const std::string& words) const;

  nlohmann::json json(const std::string& path) const;

  bool exists(const std::string& path) const { return std::filesystem::exists(folder_ / path); }

  /// A file of the source tree, e.g. scenes/robots/planar_rfrfr.xml.
  static std::string shipped(const std::string& path) {
    return std::string(CPRSIM_SOURCE_DIR "/") + path;
  }

  ScratchFolder folder_;
};

/// The text with one part in it replaced.
std::string with(std::string text, const std::string& from, const std::string& to);

}  // namespace cprsim
