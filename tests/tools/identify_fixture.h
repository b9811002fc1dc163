// SPDX-License-Identifier: BSD-3-Clause
// What the tests of `cprsim identify` share.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/scratch_folder.h"
#include "tools/cprsim/commands.h"

namespace cprsim {

using Json = nlohmann::json;

inline const std::string kScenes = std::string(CPRSIM_SOURCE_DIR) + "/scenes/mechanics/";
inline const std::string kStiffness = "wire::rod/material/youngs_modulus";
inline constexpr double kE = 200e9;  ///< of both scenes used

/// Runs `cprsim identify` in a folder of its own.
class IdentifyTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  int run(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    for (const char* word : {"-qq", "--no-plot", "-o"})
      words.emplace_back(word);
    words.push_back(path("out"));
    testing::internal::CaptureStderr();
    const int code = identify_command(words);
    errors_ = testing::internal::GetCapturedStderr();
    return code;
  }

  Json report() const { return Json::parse(contents(folder_ / "out/identify.json")); }

  bool complains(const std::string& part) const { return errors_.find(part) != std::string::npos; }

  ScratchFolder folder_;
  std::string errors_;
};

}  // namespace cprsim
