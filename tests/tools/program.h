// SPDX-License-Identifier: BSD-3-Clause
// The program as people and scripts meet it: words in; exit code, streams and files out.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

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
  Answer run(const std::string& words) const {
    const std::string command = "cd '" + folder_.path().string() +
                                "' && unset GITHUB_ACTIONS && '" CPRSIM_BINARY_DIR "/bin/cprsim' " +
                                words + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder_ / "out.txt"),
            contents(folder_ / "err.txt")};
  }

  nlohmann::json json(const std::string& path) const {
    return nlohmann::json::parse(contents(folder_ / path));
  }

  bool exists(const std::string& path) const { return std::filesystem::exists(folder_ / path); }

  /// A file of the source tree, e.g. scenes/robots/planar_rfrfr.xml.
  static std::string shipped(const std::string& path) {
    return std::string(CPRSIM_SOURCE_DIR "/") + path;
  }

  ScratchFolder folder_;
};

/// The text with one part in it replaced.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace cprsim
