// SPDX-License-Identifier: BSD-3-Clause
// The folder of a command's results. A folder that the command wrote before (it has a run.json, or
// what else its report is called) is used again after the files listed there are removed; one with
// anything else in it is refused.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/sinks/sink.h"

namespace cprsim {

/// By which a folder is known as ours: lists what was written beside it.
struct ReportFile {
  std::string name = "run.json";
  std::string schema = "cprsim-run/";  ///< what "schema" in it begins with
};

class OutputFolder {
 public:
  /// Creates or empties the folder (`keep`: leaves what is ours in it) and locks it against a
  /// second run. @throws OutputError
  explicit OutputFolder(std::filesystem::path path, ReportFile report = {}, bool keep = false);

  const std::filesystem::path& path() const { return path_; }

 private:
  /// Held as long as the folder is in use; the system lets go of it if the process dies.
  class Lock {
   public:
    Lock() = default;
    ~Lock();
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;
    void take(const std::filesystem::path& folder);

   private:
    int descriptor_ = -1;
  };

  void remove_earlier_run() const;

  std::filesystem::path path_;
  ReportFile report_;
  Lock lock_;
};

/// -o if given, else CPRSIM_OUTPUT_DIR/<label> or out/<label>.
std::filesystem::path choose_output_folder(const std::string& option, const std::string& label);

}  // namespace cprsim
