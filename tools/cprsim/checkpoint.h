// SPDX-License-Identifier: BSD-3-Clause
// A run's state as a file: a few lines for people, then the numbers. What --checkpoint-every,
// signals and failures write, and --from reads.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace cprsim {

struct Checkpoint {
  std::string scene_hash;  ///< of the scene's files
  std::string program;     ///< version that wrote it
  double time = 0;         ///< s
  std::string simulation;  ///< as Simulation::visit() writes it
  std::string outputs;     ///< as Outputs::visit() writes it
};

std::string to_text(const Checkpoint& checkpoint);

/// @throws StateError for what to_text() did not write, or was changed since
Checkpoint parse_checkpoint(std::string_view text);

/// @throws StateError with the file's name; only regular files of at most 1 GiB are read
Checkpoint read_checkpoint(const std::filesystem::path& path);

}  // namespace cprsim
