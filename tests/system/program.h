// SPDX-License-Identifier: BSD-3-Clause
// The program run in a folder of its own, as from a shell, and killed if a test wants that.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>

#include <string>
#include <vector>

#include "tests/tools/scratch_folder.h"

namespace cprsim {

/// A cantilever that swings, in 2,000 steps, with an energy and a quaternion to compare bytes of.
constexpr const char* kSwing = R"(<?xml version="1.0"?>
<sdf version="1.11" xmlns:cprsim="urn:cprsim:1">
  <world name="swing">
    <physics name="default" type="bullet">
      <max_step_size>0.001</max_step_size>
      <cprsim:solver method="shooting"><space points="4"/><time scheme="SCHEME" TIME/></cprsim:solver>
    </physics>
    <cprsim:simulation mode="dynamic"><duration>2</duration><initial solve="static"/></cprsim:simulation>
    <cprsim:effects><gravity/><damping/><rotary_inertia/></cprsim:effects>
    <model name="m">
      <cprsim:rod name="beam">
        <base attached_to="world" joint="fixed"><pose>0 0 1 0.3 1.2 0</pose></base>
        <tip attached_to="bob" joint="fixed"/>
        <length>0.4</length>
        <cross_section><circle><radius>0.002</radius></circle></cross_section>
        <material><density>8000</density><youngs_modulus>200e9</youngs_modulus><shear_modulus>80e9</shear_modulus></material>
        <damping><bending>2e-4</bending><torsion>2e-4</torsion></damping>
      </cprsim:rod>
      <link name="bob"><pose>0.37 -0.1 1.14 0.3 1.2 0</pose>
        <inertial><mass>0.05</mass><inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial></link>
      <cprsim:load at="bob"><force>0.2 0.1 0</force><step from="1" to="0" at="0.3"/></cprsim:load>
    </model>
    <cprsim:record rate="1000" prefix="swing">
      <channel>m::bob.position</channel><channel>m::bob.orientation</channel>
      <channel>m::beam.base.wrench</channel><channel>energy.*</channel><csv/>
    </cprsim:record>
  </world>
</sdf>
)";

std::string replaced(std::string text, const std::string& from, const std::string& to);

std::string swing(const std::string& scheme = "esdirk32",
                  const std::string& time = "step=\"0.001\"");

struct Outcome {
  int code = -1;  ///< -1: killed by a signal
  std::string out, err;
};

class Program : public testing::Test {
 protected:
  /// Words as one would type them; `before` goes in front of the program: variables, ulimit, ...
  Outcome run(const std::string& words, const std::string& before = "") const;

  /// Starts `cprsim FIRST SECOND ...` and sends it a signal after so many milliseconds.
  /// @return the status of waitpid
  int run_and_signal(std::vector<std::string> words, int signal, int milliseconds) const;

  static bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }

  ScratchFolder folder_;
};

}  // namespace cprsim
