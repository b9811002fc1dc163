// SPDX-License-Identifier: BSD-3-Clause
// Scenes for tests, written as text.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "scenes/loader/load.h"

namespace cprsim {

/// A valid scene: a base welded to the world, a plate, one rod between them. `model` is added to
/// the model, `world` to the world.
inline std::string scene_text(const std::string& model = "", const std::string& world = "") {
  return R"(<?xml version="1.0"?>
<sdf version="1.11" xmlns:cprsim="urn:cprsim:1">
  <world name="w">
    <physics name="default" type="bullet"><max_step_size>0.01</max_step_size></physics>
    <cprsim:simulation mode="dynamic"><duration>1</duration></cprsim:simulation>
    <cprsim:effects><gravity/></cprsim:effects>
    <model name="robot">
      <link name="base"/>
      <joint name="ground" type="fixed"><parent>world</parent><child>base</child></joint>
      <link name="plate">
        <pose>0 0 0.4 0 0 0</pose>
        <inertial><mass>0.1</mass><inertia><ixx>2e-4</ixx><iyy>2e-4</iyy><izz>4e-4</izz></inertia></inertial>
      </link>
      <cprsim:rod_class name="steel">
        <cross_section><circle><radius>0.001</radius></circle></cross_section>
        <material><density>8000</density><youngs_modulus>200e9</youngs_modulus><shear_modulus>80e9</shear_modulus></material>
      </cprsim:rod_class>
      <cprsim:rod name="leg" class="steel">
        <base attached_to="base" joint="fixed"/>
        <tip attached_to="plate" joint="fixed"/>
        <length>0.4</length>
      </cprsim:rod>
)" + model +
         "    </model>\n" + world + "  </world>\n</sdf>\n";
}

inline LoadResult load_text(const std::string& text, const LoadOptions& options = {}) {
  return load_scene_text(text, "test.xml", options);
}

/// Codes of all errors, ascending, without repetition.
inline std::vector<std::string> error_codes(const LoadResult& result) {
  std::set<std::string> codes;
  for (const Diagnostic& d : result.diagnostics)
    if (d.severity == Severity::kError) codes.insert(d.code);
  return {codes.begin(), codes.end()};
}

inline bool has_code(const LoadResult& result, const std::string& code) {
  return std::any_of(result.diagnostics.begin(), result.diagnostics.end(),
                     [&](const Diagnostic& d) { return d.code == code; });
}

inline std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// All scenes that the project ships.
inline std::vector<std::filesystem::path> shipped_scenes() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::string(CPRSIM_SOURCE_DIR) + "/scenes"))
    if (entry.path().extension() == ".xml") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace cprsim
