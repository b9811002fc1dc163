// SPDX-License-Identifier: BSD-3-Clause
// A run written, read back and gone on with is the run that was never interrupted, bit for bit:
// every shipped robot, every scheme, every method.
#include <gtest/gtest.h>

#include "engine/math/state_text.h"
#include "engine/run/simulation.h"
#include "engine/time/scheme.h"
#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

std::uint64_t hash_of(Simulation& simulation) {
  StateHash hash;
  simulation.visit(hash);
  return hash.value();
}

void advance(Simulation& simulation, int steps) {
  for (int k = 0; k < steps && simulation.status() == RunStatus::kRunning; ++k)
    simulation.advance();
}

/// Five steps, or those of a part of the run, then three more by the same simulation and by one
/// that reads its state.
void expect_same_after_restart(const Scene& scene, const std::string& what, double part = 0) {
  Simulation first(scene);
  first.start();
  advance(first, 5);
  while (first.status() == RunStatus::kRunning && first.time() < part * first.end_time())
    first.advance();
  ASSERT_NE(first.status(), RunStatus::kFailed) << what << ": " << first.failure();
  StateWriter written;
  first.visit(written);

  Simulation second(scene);
  StateReader reader(written.text());
  second.visit(reader);
  reader.finish();
  EXPECT_EQ(hash_of(second), hash_of(first)) << what;
  EXPECT_EQ(second.now().energy.total, first.now().energy.total) << what;
  EXPECT_EQ(second.now().contact.count, first.now().contact.count) << what;
  EXPECT_EQ(second.now().contact.force, first.now().contact.force) << what;
  advance(first, 3);
  advance(second, 3);
  EXPECT_EQ(second.time(), first.time()) << what;
  EXPECT_EQ(hash_of(second), hash_of(first)) << what;
  EXPECT_EQ(second.now().energy.work, first.now().energy.work) << what;
  EXPECT_EQ(second.now().energy.balance, first.now().energy.balance) << what;
}

LoadResult load(const std::filesystem::path& path) {
  return load_scene(path.string());
}

TEST(State, OfEveryShippedSceneGoesOnWhereItWas) {
  int moving = 0;
  for (const std::filesystem::path& path : shipped_scenes()) {
    const LoadResult loaded = load(path);
    ASSERT_TRUE(loaded.scene) << path;
    if (loaded.scene->simulation.mode == Mode::kStatic) continue;
    if (loaded.scene->rods.empty() && loaded.scene->joints.empty()) continue;
    if (!Simulation(*loaded.scene).has_visitable_state()) continue;  // free flight
    ++moving;
    expect_same_after_restart(*loaded.scene, path.filename());
  }
  EXPECT_GT(moving, 5);
}

// By then rods lie, stick and slide.
TEST(State, OfRodsInContactGoesOnWhereItWas) {
  int touching = 0;
  for (const std::filesystem::path& path : shipped_scenes()) {
    if (path.parent_path().filename() != "contact") continue;
    const LoadResult loaded = load(path);
    ASSERT_TRUE(loaded.scene) << path;
    if (loaded.scene->simulation.mode == Mode::kStatic ||
        !Simulation(*loaded.scene).has_visitable_state())
      continue;
    ++touching;
    for (const double part : {0.3, 0.6})
      expect_same_after_restart(*loaded.scene, path.filename(), part);
  }
  EXPECT_GT(touching, 10);
}

Scene with_every_effect() {
  const LoadResult loaded =
      load(std::string(CPRSIM_SOURCE_DIR) + "/scenes/robots/stewart_gough.xml");
  Scene scene = *loaded.scene;
  for (const Effect effect : {Effect::kGravity, Effect::kExtension, Effect::kShear,
                              Effect::kRotaryInertia, Effect::kDamping})
    scene.effects.set(effect, true);
  for (RodSpec& rod : scene.rods)
    if (!rod.damping) rod.damping = DampingSpec{1e-4, 1e-4, 1e-2, 1e-2, {}};
  scene.solver.points = 4;
  return scene;
}

TEST(State, GoesOnWithEverySchemeAndMethod) {
  for (const SchemeKind scheme :
       {SchemeKind::kBackwardEuler, SchemeKind::kBdf2, SchemeKind::kBdfAlpha,
        SchemeKind::kGeneralizedAlpha, SchemeKind::kTrBdf2, SchemeKind::kEsdirk32,
        SchemeKind::kEsdirk43, SchemeKind::kRadau5})
    for (const Method method : {Method::kShooting, Method::kStrain, Method::kCollocation})
      for (const bool fixed : {true, false}) {
        Scene scene = with_every_effect();
        scene.solver.method = method;
        scene.solver.scheme = scheme;
        scene.solver.step.reset();
        if (fixed) scene.solver.step = 1e-3;
        expect_same_after_restart(scene, std::string(to_string(scheme)));
      }
}

TEST(State, OfAnotherRobotOrDamagedIsRefused) {
  const Scene scene = with_every_effect();
  Simulation simulation(scene);
  simulation.start();
  StateWriter written;
  simulation.visit(written);
  const auto read = [](const Scene& into, std::string_view text) {
    Simulation other(into);
    StateReader reader(text);
    other.visit(reader);
    reader.finish();
  };
  EXPECT_NO_THROW(read(scene, written.text()));
  EXPECT_THROW(read(scene, written.text().substr(0, written.text().size() - 1)), StateError);
  EXPECT_THROW(read(scene, written.text() + "x"), StateError);
  EXPECT_THROW(read(scene, ""), StateError);
  Scene finer = scene;
  finer.solver.points = 5;
  EXPECT_THROW(read(finer, written.text()), StateError);
  Scene fewer = scene;
  fewer.rods.pop_back();
  EXPECT_THROW(read(fewer, written.text()), StateError);
}

/// Where in a state's text the numbers lie that are written one by one: all counts and indices are
/// among them.
class Landmarks final : public Archive {
 public:
  bool reading() const override { return false; }

  void bytes(void*, std::size_t size) override {
    for (std::size_t k = 0; k < size && size <= 8; ++k)
      places.push_back(at_ + k);
    at_ += size;
  }

  std::vector<std::size_t> places;

 private:
  std::size_t at_ = 0;
};

/// Reads a damaged state and goes on for some steps. @return whether it was refused
bool refused(const Scene& scene, const std::string& text) {
  Simulation simulation(scene);
  try {
    StateReader reader(text);
    simulation.visit(reader);
    reader.finish();
  } catch (const StateError& error) {
    EXPECT_NE(std::string(error.what()), "");
    return true;
  }
  advance(simulation, 2);
  return false;
}

// Of contacts a file holds indices of rods, bodies, cells and of each other. Whatever one byte is
// changed to, nothing is read or written beside the robot: with sanitizers this says more.
TEST(State, OfContactsWithAnyByteChangedIsRefusedOrGoesOn) {
  struct Case {
    const char* scene;
    int steps;  ///< after which something touches
  };

  constexpr std::size_t kEvery = 61;  // 1 takes four minutes

  for (const auto& [name, steps] : {Case{"contact/crossing", 15}, Case{"contact/gripper", 160},
                                    Case{"contact/stack", 100}, Case{"rods/bundle", 3}}) {
    LoadResult loaded = load(std::string(CPRSIM_SOURCE_DIR) + "/scenes/" + name + ".xml");
    ASSERT_TRUE(loaded.scene) << name;
    const Scene& scene = *loaded.scene;
    Simulation simulation(scene);
    simulation.start();
    advance(simulation, steps);
    ASSERT_EQ(simulation.status(), RunStatus::kRunning) << name;
    StateWriter written;
    simulation.visit(written);
    ASSERT_FALSE(refused(scene, written.text())) << name;
    Landmarks marks;
    simulation.visit(marks);
    int refusals = 0;
    for (std::size_t k = 0; k < marks.places.size(); k += kEvery) {
      std::string text = written.text();
      text[marks.places[k]] ^= static_cast<char>(1 << k % 8);
      if (refused(scene, text)) ++refusals;
    }
    EXPECT_GT(refusals, 0) << name;
  }
}

TEST(Fnv1a, HasItsPublishedValues) {
  EXPECT_EQ(fnv1a(""), 0xcbf29ce484222325U);
  EXPECT_EQ(fnv1a("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(fnv1a("foobar"), 0x85944171f73967e8U);
}

}  // namespace
}  // namespace cprsim
