// SPDX-License-Identifier: BSD-3-Clause
// What the program executes for a scene: nothing of effects that are not listed, nothing of
// libraries that such a scene does not need. Beside each check stands a scene that does need it, so
// that a changed name cannot make the check empty.
#include <gtest/gtest.h>

#include "tests/effects/callgrind.h"
#include "tests/tools/scratch_folder.h"

namespace cprsim {
namespace {

constexpr const char* kSwing = R"(<?xml version="1.0"?>
<sdf version="1.11" xmlns:cprsim="urn:cprsim:1">
  <world name="swing">
    <physics name="default" type="bullet">
      <max_step_size>0.01</max_step_size>
      <cprsim:solver method="METHOD"><time scheme="bdf2" step="0.01"/></cprsim:solver>
    </physics>
    <cprsim:simulation mode="dynamic"><duration>0.1</duration>PLANAR<initial solve="static"/></cprsim:simulation>
    <cprsim:effects>EFFECTS</cprsim:effects>
    <model name="m">
      <link name="ground"><collision name="floor"><geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link>
      <joint name="weld" type="fixed"><parent>world</parent><child>ground</child></joint>
      <cprsim:rod name="beam">
        <base attached_to="ground" joint="fixed"><pose>0 0 0.01 0 1.5 0</pose></base>
        <length>0.4</length>
        <cross_section s="0"><circle><radius>0.002</radius></circle></cross_section>
        <material><density>8000</density><youngs_modulus>200e9</youngs_modulus><shear_modulus>80e9</shear_modulus></material>
        ROD
      </cprsim:rod>
      <cprsim:load at="beam::tip"><force>0.2 0 0.1</force><step from="1" to="0" at="0.03"/></cprsim:load>
      MODEL
    </model>
    WORLD
  </world>
</sdf>
)";

/// What a scene has beyond the plain one.
struct Extra {
  std::string method = "shooting", effects = "", rod = "", model = "", world = "", planar = "";
};

std::string swing(const Extra& extra) {
  std::string text = kSwing;
  const auto fill = [&](const std::string& word, const std::string& by) {
    text.replace(text.find(word), word.size(), by);
  };
  fill("METHOD", extra.method);
  fill("PLANAR", extra.planar);
  fill("EFFECTS", extra.effects);
  fill("ROD", extra.rod);
  fill("MODEL", extra.model);
  fill("WORLD", extra.world);
  return text;
}

class TracedRun {
 public:
  explicit TracedRun(const Extra& extra) {
    const ScratchFolder folder;
    spill(folder / "swing.xml", swing(extra));
    costs_ =
        instructions_of("'" CPRSIM_BINARY_DIR "/bin/cprsim' run swing.xml -o out", folder.path());
    EXPECT_FALSE(costs_.empty()) << contents(folder / "err.txt");
  }

  /// In functions whose names hold any of these.
  long instructions(const std::vector<std::string>& names) const {
    long sum = 0;
    for (const FunctionCost& cost : costs_)
      if (any_in(names, cost.function)) sum += cost.instructions;
    return sum;
  }

  const std::vector<FunctionCost>& costs() const { return costs_; }

 private:
  static bool any_in(const std::vector<std::string>& names, const std::string& text) {
    for (const std::string& name : names)
      if (text.find(name) != std::string::npos) return true;
    return false;
  }

  std::vector<FunctionCost> costs_;
};

struct EffectCode {
  const char* name;
  std::vector<std::string> functions;  ///< that belong to it alone
  Extra scene;                         ///< that lists it
};

std::vector<EffectCode> effect_codes() {
  return {
      {"a fluid",
       {"cprsim::Immersion::"},
       {.method = "strain",  // valgrind 3.19 does not know an instruction of the other
        .effects = "<drag/>",
        .rod = "<drag><normal>1</normal><fluid_density>1000</fluid_density></drag>"}},
      {"tendons",
       {"cprsim::RodTendons::", "cprsim::Tendon::", "cprsim::TendonBorder::"},
       {.model =
            R"(<cprsim:tendon name="t" rod="beam"><parallel radius="0.01" angle="0"/></cprsim:tendon>
          <cprsim:drive tendon="t" quantity="tension"><constant value="1"/></cprsim:drive>)"}},
      {"varying sections",
       {"cprsim::SectionsAlong::"},
       {.rod = "<cross_section s=\"1\"><circle><radius>0.001</radius></circle></cross_section>"}},
      {"contact of rods",
       {"cprsim::RodContacts::", "cprsim::distance_to", "::meet_contact"},
       {.effects = "<contact/>"}},
      {"rotary inertia",
       {"Rotary", "(cprsim::CellLaw)3", "(cprsim::CellLaw)4"},
       {.effects = "<rotary_inertia/>"}},
  };
}

constexpr const char* kRods[] = {"ShootingRod::", "StrainRod::", "CollocationRod::",
                                 "PlanarRod::",   "CellLaw",     "BandedElimination",
                                 "evaluate_point"};

TEST(PlainScene, ExecutesNothingOfAnAbsentEffect) {
  if (!has_callgrind()) GTEST_SKIP() << kNoCallgrind;
  const std::vector<std::string> rods(std::begin(kRods), std::end(kRods));
  for (const Extra& extra :
       {Extra{.method = "shooting"}, Extra{.method = "strain"}, Extra{.method = "collocation"},
        Extra{.method = "shooting", .planar = "<planar normal=\"0 1 0\"/>"}}) {
    const TracedRun plain(extra);
    const auto work = static_cast<double>(plain.instructions(rods));
    EXPECT_GT(work, 3e5);
    // a question whether there is any, once a solve
    for (const EffectCode& effect : effect_codes())
      EXPECT_LT(static_cast<double>(plain.instructions(effect.functions)), 2e-3 * work)
          << effect.name << " with " << extra.method << extra.planar;
  }
  for (const EffectCode& effect : effect_codes())
    EXPECT_GT(TracedRun(effect.scene).instructions(effect.functions), 10000) << effect.name;
}

struct Library {
  std::vector<std::string> files;  ///< parts of their paths
  std::string functions;           ///< how their names begin, where it is linked into the program
  Extra scene;                     ///< that needs it

  long instructions(const std::vector<FunctionCost>& costs) const {
    long sum = 0;
    for (const FunctionCost& cost : costs) {
      bool own = !functions.empty() && cost.function.starts_with(functions);
      for (const std::string& file : files)
        own = own || cost.object.find(file) != std::string::npos;
      if (own) sum += cost.instructions;
    }
    return sum;
  }
};

std::vector<Library> libraries() {
  return {{{"libBullet", "libLinearMath"},
           "",
           {.model = R"(<link name="ball"><pose>0 0 2 0 0 0</pose><inertial><mass>1</mass><inertia>
                <ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>
                <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>)"}},
          {{"libhdf5"},
           "H5",
           {.world = R"(<cprsim:record rate="100" prefix="r"><channel>m::beam.tip.position</channel>
                <hdf5/></cprsim:record>)"}},
          {{"libGL", "libEGL", "libOpenGL", "libepoxy", "libgallium"}, "", {}},
          {{"libassimp"}, "", {}}};
}

// What a library executes while it is loaded is what it executes when the program only tells its
// version.
TEST(PlainScene, UsesNoLibraryThatItDoesNotNeed) {
  if (!has_callgrind()) GTEST_SKIP() << kNoCallgrind;
  const TracedRun plain({});
  const ScratchFolder folder;
  const std::vector<FunctionCost> loaded =
      instructions_of("'" CPRSIM_BINARY_DIR "/bin/cprsim' --version", folder.path());
  ASSERT_FALSE(loaded.empty());
  for (const Library& library : libraries())
    EXPECT_EQ(library.instructions(plain.costs()), library.instructions(loaded))
        << library.files[0];
}

TEST(PlainScene, IsComparedWithScenesThatUseLibraries) {
  if (!has_callgrind()) GTEST_SKIP() << kNoCallgrind;
  for (const Library& library : libraries()) {
    if (library.scene.model.empty() && library.scene.world.empty()) continue;
    EXPECT_GT(library.instructions(TracedRun(library.scene).costs()), 50000) << library.files[0];
  }
}

}  // namespace
}  // namespace cprsim
