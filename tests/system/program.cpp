// SPDX-License-Identifier: BSD-3-Clause
#include "tests/system/program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

namespace cprsim {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string swing(const std::string& scheme, const std::string& time) {
  return replaced(replaced(kSwing, "SCHEME", scheme), "TIME", time);
}

Outcome Program::run(const std::string& words, const std::string& before) const {
  const std::string command = "cd '" + folder_.path().string() + "' && unset GITHUB_ACTIONS && " +
                              before + " '" + CPRSIM_BINARY_DIR + "/bin/cprsim' " + words +
                              " >out.txt 2>err.txt";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) && WEXITSTATUS(status) < 128 ? WEXITSTATUS(status) : -1,
          contents(folder_ / "out.txt"), contents(folder_ / "err.txt")};
}

int Program::run_and_signal(std::vector<std::string> words, int signal, int milliseconds) const {
  const pid_t child = fork();
  if (child == 0) {
    std::string name = std::string(CPRSIM_BINARY_DIR) + "/bin/cprsim";
    std::vector<char*> arguments{name.data()};
    for (std::string& word : words)
      arguments.push_back(word.data());
    arguments.push_back(nullptr);
    if (chdir(folder_.path().c_str()) != 0) _exit(99);
    execv(name.c_str(), arguments.data());
    _exit(99);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  kill(child, signal);
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return status;
}

}  // namespace cprsim
