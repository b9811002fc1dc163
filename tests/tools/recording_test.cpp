// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/recording.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <sstream>

#include "tests/tools/scratch_folder.h"
#include "tests/tools/synthetic.h"

namespace cprsim {
namespace {

std::vector<std::vector<std::string>> cells(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream stream(line);
    rows.emplace_back();
    for (std::string cell; std::getline(stream, cell, ',');)
      rows.back().push_back(cell);
  }
  return rows;
}

double number(const std::string& text) {
  double value = std::nan("");
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

RecordSpec record_of_height(double rate) {
  RecordSpec spec;
  spec.rate = rate;
  spec.prefix = "height";
  spec.channels = {height()};
  spec.csv = true;
  return spec;
}

TEST(Shortest, ReadsBackBitForBit) {
  for (const double value : {0.1, -0.0, 1.0 / 3, 1e300, 5e-324, 123456789.123456789, 2.0}) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(number(shortest(value))),
              std::bit_cast<std::uint64_t>(value));
  }
  EXPECT_EQ(shortest(0.1), "0.1");
}

TEST(Recording, WritesOneHeaderLineWithUnitsAndRowsAtMultiplesOfThePeriod) {
  const ScratchFolder folder;
  const Scene scene = synthetic_scene();
  const RecordSpec spec = record_of_height(30);  // 1/30 s is no multiple of the 0.04 s steps
  Recording recording(scene, spec, folder.path());
  play(recording);
  recording.finish();

  const auto rows = cells(contents(folder / "height.csv"));
  ASSERT_EQ(rows.size(), 1u + 13u);  // 0 to 12 thirtieths of a second fit in 0.4 s
  EXPECT_EQ(rows[0], (std::vector<std::string>{"time [s]", "ball.position.z [m]"}));
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const double t = static_cast<double>(k) / 30;
    EXPECT_EQ(number(rows[k + 1][0]), t);
    EXPECT_NEAR(number(rows[k + 1][1]), height_at(t), 1e-14);  // Hermite is exact for a parabola
  }
  ASSERT_EQ(recording.files().size(), 1u);
  EXPECT_EQ(recording.files()[0].count, 13);
}

TEST(Recording, WithoutARateWritesEveryStep) {
  const ScratchFolder folder;
  const Scene scene = synthetic_scene();
  const RecordSpec spec = record_of_height(0);
  Recording recording(scene, spec, folder.path());
  play(recording);
  recording.finish();
  EXPECT_EQ(cells(contents(folder / "height.csv")).size(), 1u + 11u);
}

TEST(Recording, IsTheSameFileEveryTime) {
  const ScratchFolder folder;
  const Scene scene = synthetic_scene();
  const RecordSpec spec = record_of_height(100);
  std::string first;
  for (int run = 0; run < 2; ++run) {
    Recording recording(scene, spec, folder.path());
    play(recording);
    recording.finish();
    if (run == 0) first = contents(folder / "height.csv");
  }
  EXPECT_EQ(contents(folder / "height.csv"), first);
}

TEST(Recording, QuotesAChannelNameWithAComma) {
  const ScratchFolder folder;
  const Scene scene = synthetic_scene();
  RecordSpec spec = record_of_height(10);
  spec.channels[0].name = "contact(a,b).force";
  Recording recording(scene, spec, folder.path());
  recording.finish();
  EXPECT_EQ(contents(folder / "height.csv"), "time [s],\"contact(a,b).force [m]\"\n");
}

TEST(Recording, WritesEveryNthRecordForVtkAndACollectionThatIsAlwaysComplete) {
  const ScratchFolder folder;
  const Scene scene = synthetic_scene();
  RecordSpec spec = record_of_height(50);
  spec.vtk_every = 5;
  Recording recording(scene, spec, folder.path());
  play(recording, 0.2);
  // not finished: as after a crash
  const std::string collection = contents(folder / "height.pvd");
  EXPECT_NE(collection.find("timestep=\"0.2\""), std::string::npos);
  EXPECT_NE(collection.find("file=\"height_vtk/000002.vtp\""), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder / "height_vtk/000002.vtp"));
  EXPECT_FALSE(std::filesystem::exists(folder / "height_vtk/000003.vtp"));
  EXPECT_FALSE(std::filesystem::exists(folder / "height.csv"));
}

}  // namespace
}  // namespace cprsim
