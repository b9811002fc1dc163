// SPDX-License-Identifier: BSD-3-Clause
// cprsim new: a scene to start from, in which every effect stands as a comment.
#include <fmt/core.h>

#include <filesystem>

#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

// A line that begins with a comment around an element is an option: without the comment's marks it
// is valid (tests/tools/new_command_test.cpp takes away the marks of each, and of all).
constexpr std::string_view kStarterScene = R"xml(<?xml version="1.0"?>
<!-- A wire carries a ball above a floor. It is pulled aside, let go at t = 0.05 s and swings.

       cprsim SCENE               runs it: the results are in out/NAME
       cprsim info SCENE          stiffness, frequencies, and which effects would matter
       cprsim explain cprsim:rod  what may stand in an element

     SI units everywhere: m, kg, s, rad, N. Whatever begins with a comment around an element is an option:
     take the comment's marks away to have it. Nothing is computed that is not listed. -->
<sdf version="1.11" xmlns:cprsim="urn:cprsim:1">
  <world name="NAME">
    <gravity>0 0 -9.81</gravity>
    <physics name="default" type="bullet">
      <max_step_size>0.005</max_step_size>
      <cprsim:solver method="auto">
        <time scheme="esdirk32" tolerance="1e-7"/>
      </cprsim:solver>
    </physics>
    <cprsim:simulation mode="dynamic">
      <duration>1</duration>
      <initial solve="static"/> <!-- begins in equilibrium -->
      <!-- <planar normal="0 1 0"/> --> <!-- everything moves in the plane y = 0: several times faster; not with contact -->
    </cprsim:simulation>

    <!-- rods bend and twist; whatever else they do is an effect of this list -->
    <cprsim:effects>
      <!-- <gravity/> --> <!-- weight of rods and links -->
      <!-- <extension/> --> <!-- rods stretch -->
      <!-- <shear/> --> <!-- rods shear: matters for thick or soft ones -->
      <!-- <rotary_inertia/> --> <!-- sections resist being turned: matters at high frequencies -->
      <!-- <damping/> --> <!-- as <damping> of the rod says -->
      <!-- <drag/> --> <!-- of the fluid that <drag> of the rod describes, with buoyancy and added mass -->
      <!-- <contact/> --> <!-- of the wire and the ball with the floor -->
      <!-- <friction/> --> <!-- in contacts: list contact, too -->
      <!-- <self_contact/> --> <!-- of a rod with itself -->
      <!-- <tendon_friction/> --> <!-- of tendons that have <friction>, along rods that touch nothing -->
      <!-- <magnetic/> --> <!-- of <cprsim:magnetic_field> on the rod's <magnetization> -->
      <!-- <thermal/> --> <!-- the rod grows and bends as <temperature> says; a <rise> needs extension, too -->
    </cprsim:effects>
    <cprsim:magnetic_field><uniform>0 0 0.05</uniform></cprsim:magnetic_field> <!-- T; or <dipole> -->
    <light name="sun" type="directional"><direction>-0.4 0.3 -0.9</direction></light>

    <model name="bench">
      <static>true</static>
      <link name="ground">
        <collision name="floor"><geometry><plane><normal>0 0 1</normal><size>1 1</size></plane></geometry></collision>
        <visual name="floor">
          <geometry><plane><normal>0 0 1</normal><size>1 1</size></plane></geometry>
          <material><diffuse>0.8 0.8 0.78 1</diffuse></material>
        </visual>
      </link>
      <!-- a rod leaves its base along z of this frame: here along x of the world -->
      <frame name="clamp"><pose>0 0 0.2 0 1.5707963267948966 0</pose></frame>
    </model>

    <model name="robot">
      <link name="ball">
        <pose>0.3 0 0.2 0 1.5707963267948966 0</pose>
        <inertial><mass>0.005</mass><inertia><ixx>2e-7</ixx><iyy>2e-7</iyy><izz>2e-7</izz></inertia></inertial>
        <collision name="ball"><geometry><sphere><radius>0.01</radius></sphere></geometry></collision>
        <visual name="ball"><geometry><sphere><radius>0.01</radius></sphere></geometry></visual>
      </link>
      <cprsim:rod name="wire">
        <base attached_to="bench::clamp" joint="fixed"/> <!-- or revolute, ball, universal, free -->
        <tip attached_to="ball" joint="fixed"/>
        <length>0.3</length>
        <cross_section s="0"><circle><radius>0.001</radius></circle></cross_section>
        <!-- <cross_section s="1"><circle><radius>0.0006</radius></circle></cross_section> --> <!-- tapers towards the tip -->
        <material>
          <density>7850</density>
          <youngs_modulus>200e9</youngs_modulus>
          <shear_modulus>77e9</shear_modulus>
          <thermal_expansion>1.2e-5</thermal_expansion> <!-- 1/K -->
        </material>
        <damping> <!-- a time constant of 1 ms: 1e-3 s times E I, G J, E A, G A -->
          <bending>1.5708e-4</bending><torsion>1.2095e-4</torsion><axial>628.3</axial><shear>241.9</shear>
        </damping>
        <drag> <!-- of water -->
          <normal>1.2</normal><tangential>0.03</tangential><fluid_density>1000</fluid_density><added_mass>1</added_mass>
        </drag>
        <magnetization>0 0 3</magnetization> <!-- magnetic moment per length, A m: a remanence of 1.2 T along it -->
        <temperature><gradient>0 2000</gradient></temperature> <!-- K/m: 4 K from one side to the other -->
        <!-- <rest><curvature>0 2 0</curvature></rest> --> <!-- bent without load: 2/m about its y axis; or <helix>, or <file> -->
        <!-- <disks count="4"><radius>0.01</radius><mass>0.0005</mass></disks> --> <!-- rigid, across it -->
      </cprsim:rod>
      <!-- <cprsim:tendon name="cable" rod="wire"><parallel radius="0.008" angle="0"/><friction mu="0.1"/></cprsim:tendon><cprsim:drive tendon="cable" quantity="tension"><constant value="5"/></cprsim:drive> --> <!-- pulled with 5 N -->
      <cprsim:load at="ball"><force>0 0 0.2</force><step from="1" to="0" at="0.05"/></cprsim:load>
      <!-- <cprsim:load at="ball" expressed_in="ball"><force>0 0.1 0</force><torque>0 0 0.001</torque></cprsim:load> --> <!-- follows the ball -->
      <!-- <cprsim:load along="wire"><force>0 1 0</force></cprsim:load> --> <!-- 1 N/m all along it -->
      <!-- <cprsim:load at="wire(s=0.5)"><force>0 0 -0.1</force></cprsim:load> --> <!-- at a point of the rod -->
      <!-- <cprsim:load along="wire"><foundation><stiffness>20</stiffness><point>0 0 0.2</point><normal>0 0 1</normal></foundation></cprsim:load> --> <!-- springs all along, towards a plane -->
      <!-- <cprsim:load along="wire"><conducting_plane><charge>2e-7</charge><point>0 0 0</point><normal>0 0 1</normal></conducting_plane></cprsim:load> --> <!-- attracts the charged wire -->
      <!-- <cprsim:drive rod="wire" quantity="length"><smoothstep from="0.3" to="0.32" start="0.1" end="0.6"/></cprsim:drive> --> <!-- fed through its base -->
      <!-- <link name="bob"><pose>0.3 0 0.17 0 0 0</pose><inertial><mass>0.002</mass><inertia><ixx>1e-7</ixx><iyy>1e-7</iyy><izz>1e-7</izz></inertia></inertial></link><joint name="hinge" type="revolute"><pose>0 0 0.02 0 0 0</pose><parent>ball</parent><child>bob</child><axis><xyz>0 1 0</xyz><dynamics><damping>1e-5</damping><friction>1e-4</friction><spring_stiffness>1e-3</spring_stiffness></dynamics></axis></joint> --> <!-- hangs on a hinge that rubs, on a spring -->
    </model>

    <cprsim:camera name="view"><eye>0.15 -0.8 0.35</eye><look_at>0.15 0 0.17</look_at></cprsim:camera>
    <!-- <cprsim:video camera="view" fps="30" speed="0.25" file="NAME.mp4"/> -->
    <cprsim:record rate="200" prefix="NAME">
      <channel>robot::ball.position</channel>
      <channel>energy.*</channel>
      <csv/>
      <!-- <vtk/> --> <!-- for ParaView -->
      <!-- <hdf5/> --> <!-- for MATLAB, Python, Julia -->
      <!-- <npz/> --> <!-- for NumPy -->
      <!-- <gltf/> --> <!-- for Blender and browsers -->
    </cprsim:record>
    <cprsim:expect name="computed to the end"><converged/></cprsim:expect>
  </world>
</sdf>
)xml";

/// A name for the world and its files: letters, digits and underscores of the file's.
std::string world_name(const std::filesystem::path& path) {
  std::string name;
  for (const char c : path.stem().string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    name += plain ? c : '_';
  }
  const bool nameless = name.find_first_not_of('_') == std::string::npos;
  return nameless ? "scene" : name;
}

std::string starter_scene(const std::string& path) {
  std::string text(kStarterScene);
  const auto fill = [&](std::string_view word, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += by.size())
      text.replace(at, word.size(), by);
  };
  fill("SCENE", path);
  fill("NAME", world_name(path));
  return text;
}

}  // namespace

int new_command(const Words& words) {
  std::string path = "scene.xml";
  bool overwrite = false;
  CommandLine line("cprsim new",
                   "Writes a scene to start from: it runs as it is, and every effect stands in it "
                   "as a comment.\n\n"
                   "Examples\n"
                   "  cprsim new                 scene.xml\n"
                   "  cprsim new robots/arm.xml\n"
                   "  cprsim new - | less");
  std::vector<std::string> paths;
  line.arguments("FILE", paths, "The file; - writes to standard output (default scene.xml)", false);
  line.flag("--overwrite", overwrite, "Replaces a file of that name");
  if (const auto code = line.parse(words)) return *code;
  if (paths.size() > 1) {
    write_to_stderr("cprsim new: one file at a time\n");
    return kExitUsage;
  }
  if (!paths.empty()) path = paths[0];
  if (path == "-") {
    write_to_stdout(starter_scene("scene.xml"));
    return kExitDone;
  }
  if (!overwrite && std::filesystem::exists(path)) {
    write_to_stderr(fmt::format(
        "cprsim new: '{}' exists; give another name, or --overwrite to replace it\n", path));
    return kExitEnvironment;
  }
  write_file(path, starter_scene(path));
  write_to_stdout(fmt::format("wrote {}; next: cprsim {}\n", path, path));
  return kExitDone;
}

}  // namespace cprsim
