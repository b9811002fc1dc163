// SPDX-License-Identifier: BSD-3-Clause
// Runs of a sweep as they are done, one line each: what an interruption leaves behind. The first
// line says which sweep it is.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tools/cprsim/sweep_result.h"

namespace cprsim {

class SweepJournal {
 public:
  SweepJournal(std::filesystem::path path, std::string signature)
      : path_(std::move(path)), signature_(std::move(signature)) {}

  /// Takes over what an earlier sweep has done. @throws UsageError if that was another sweep
  void resume(SweepResult& result) const;

  /// Writes what is known already, and waits for more. @throws OutputError
  void begin(const SweepResult& result);

  /// A run is done. @throws OutputError
  void add(std::size_t index, const SweepRun& run);
  void add_spread(const std::vector<double>& spread);

 private:
  void add_line(const std::string& line);

  std::filesystem::path path_;
  std::string signature_;
  std::ofstream stream_;
};

}  // namespace cprsim
