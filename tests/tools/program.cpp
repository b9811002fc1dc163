// SPDX-License-Identifier: BSD-3-Clause
#include "tests/tools/program.h"

#include <sys/wait.h>

#include <cstdlib>

namespace cprsim {

Answer ProgramTest::run(const std::string& words) const {
  const std::string command = "cd '" + folder_.path().string() +
                              "' && unset GITHUB_ACTIONS && '" CPRSIM_BINARY_DIR "/bin/cprsim' " +
                              words + " >out.txt 2>err.txt";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder_ / "out.txt"),
          contents(folder_ / "err.txt")};
}

nlohmann::json ProgramTest::json(const std::string& path) const {
  return nlohmann::json::parse(contents(folder_ / path));
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace cprsim
