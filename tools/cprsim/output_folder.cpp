// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/sinks/output_file.h"

namespace cprsim {

namespace fs = std::filesystem;

namespace {

/// A name from a run.json, only if it stays inside the folder.
bool is_inside(const fs::path& name) {
  if (name.empty() || name.is_absolute()) return false;
  for (const fs::path& part : name) {
    if (part == "..") return false;
  }
  return true;
}

/// The files that an earlier run listed.
std::vector<std::string> files_of_earlier_run(const fs::path& path, const std::string& schema) {
  std::ifstream stream(path);
  const nlohmann::json report = nlohmann::json::parse(stream, nullptr, false);
  if (!report.is_object() || report.value("schema", "").rfind(schema, 0) != 0) {
    throw OutputError(path.string() + " was not written by cprsim; choose another folder with -o",
                      "E702");
  }
  std::vector<std::string> names;
  for (const nlohmann::json& file : report.value("files", nlohmann::json::array())) {
    const std::string name = file.value("name", "");
    if (is_inside(name)) names.push_back(name);
  }
  return names;
}

/// Frames are numbered files; nothing else in their folder is ours.
void remove_frames(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string extension = entry.path().extension();
    if (extension == ".vtp" || extension == ".png" || extension == ".part") {
      fs::remove(entry.path(), ignored);
    }
  }
  fs::remove(folder, ignored);
}

/// Of a run that was killed before it could give its report a name.
bool holds_only_parts(const fs::path& folder) {
  const auto is_part = [](const fs::directory_entry& entry) {
    return entry.path().extension() == ".part";
  };
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(), is_part);
}

/// Before anything of an earlier run is removed: the folder takes files, and the disk a report.
void prove_writable(const fs::path& folder) {
  constexpr std::size_t kRoom = 1 << 16;
  const fs::path trial = folder / "trial.part";
  const auto remove = [&] {
    std::error_code ignored;
    fs::remove(trial, ignored);
  };
  try {
    OutputFile file(folder / "trial");
    file.write(std::string(kRoom, ' '));
    file.sync();
  } catch (const OutputError&) {
    remove();
    throw;
  }
  remove();
}

}  // namespace

OutputFolder::OutputFolder(fs::path path, ReportFile report, bool keep)
    : path_(std::move(path)), report_(std::move(report)) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) throw OutputError("cannot create " + path_.string() + ": " + error.message());
  lock_.take(path_);
  if (fs::exists(path_ / report_.name)) {
    prove_writable(path_);
    if (!keep) remove_earlier_run();
  } else if (!holds_only_parts(path_)) {
    throw OutputError(path_.string() + " holds files but no " + report_.name +
                          ", so cprsim did not write them and leaves them "
                          "alone; choose another folder with -o",
                      "E702");
  }
}

OutputFolder::Lock::~Lock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFolder::Lock::take(const fs::path& folder) {
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) {
    throw OutputError("cannot open " + folder.string() + ": " + std::strerror(errno));
  }
  // file systems without locks are used without one
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  throw OutputError("another run is writing to " + folder.string() +
                        "; wait for it or choose another folder with -o",
                    "E702");
}

void OutputFolder::remove_earlier_run() const {
  std::error_code ignored;
  for (const std::string& name : files_of_earlier_run(path_ / report_.name, report_.schema)) {
    const fs::path file = path_ / name;
    if (name.back() == '/') {
      remove_frames(file.parent_path());
    } else {
      fs::remove(file, ignored);
      fs::remove(file.string() + ".part", ignored);
    }
  }
  fs::remove(path_ / report_.name, ignored);
}

fs::path choose_output_folder(const std::string& option, const std::string& label) {
  if (!option.empty()) return option;
  const char* base = std::getenv("CPRSIM_OUTPUT_DIR");
  return fs::path(base != nullptr && *base != '\0' ? base : "out") / label;
}

}  // namespace cprsim
