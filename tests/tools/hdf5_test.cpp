// SPDX-License-Identifier: BSD-3-Clause
// Recordings as HDF5, read back through the library.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/tools/scratch_folder.h"
#include "tests/tools/synthetic.h"
#include "tools/hdf5/hdf5_input.h"
#include "tools/hdf5/hdf5_output.h"
#include "tools/series/read_series.h"
#include "tools/sinks/output_file.h"
#include "tools/sinks/recording.h"

namespace cprsim {
namespace {

using Shape = std::vector<std::size_t>;

RecordSpec spec_at(double rate) {
  RecordSpec spec;
  spec.rate = rate;
  spec.prefix = "run";
  spec.channels = {height(), iterations()};
  spec.csv = spec.hdf5 = true;
  return spec;
}

class Hdf5 : public testing::Test {
 protected:
  void record(double rate) const {
    const RecordSpec spec = spec_at(rate);
    Recording recording(scene_, spec, folder_.path());
    play(recording);
    recording.finish();
  }

  ScratchFolder folder_;
  Scene scene_ = synthetic_scene();
};

TEST_F(Hdf5, HoldsChannelsAndRodsWithUnitsAndFrames) {
  record(25);  // every step
  const Hdf5Input file(folder_ / "run.h5");
  EXPECT_EQ(file.names("/"), (std::vector<std::string>{"time", "channels", "rods", "links"}));
  EXPECT_EQ(file.names("channels"),
            (std::vector<std::string>{"ball.position.z", "solver.iterations"}));
  const auto height = file.numbers("channels/ball.position.z"),
             ball = file.numbers("links/ball/position");
  ASSERT_EQ(ball.size(), 3 * height.size());
  for (std::size_t k = 0; k < height.size(); ++k)
    EXPECT_EQ(ball[3 * k + 2], height[k]);
  EXPECT_EQ(file.row("links/ball/position", 2), std::vector<double>(&ball[6], &ball[9]));
  EXPECT_THROW(file.row("links/ball/position", height.size()), Hdf5Error);
  EXPECT_EQ(file.names("rods/rod"), (std::vector<std::string>{"length", "position", "quaternion",
                                                              "strain", "n", "m", "s"}));
  EXPECT_EQ(file.shape("time"), Shape{11});
  EXPECT_EQ(file.shape("channels/ball.position.z"), Shape{11});
  EXPECT_EQ(file.shape("rods/rod/position"), (Shape{11, 5, 3}));
  EXPECT_EQ(file.shape("rods/rod/quaternion"), (Shape{11, 5, 4}));
  EXPECT_EQ(file.shape("rods/rod/strain"), (Shape{11, 5, 6}));
  EXPECT_EQ(file.text("time", "units"), "s");
  EXPECT_EQ(file.text("channels/ball.position.z", "units"), "m");
  EXPECT_EQ(file.text("channels/ball.position.z", "frame"), "world");
  EXPECT_EQ(file.text("channels/solver.iterations", "frame"), "");
  EXPECT_EQ(file.text("rods/rod/strain", "frame"), "section");
  EXPECT_EQ(file.text("rods/rod/m", "units"), "N m");

  const auto time = file.numbers("time"), z = file.numbers("channels/ball.position.z");
  const auto position = file.numbers("rods/rod/position"), m = file.numbers("rods/rod/m");
  const auto q = file.numbers("rods/rod/quaternion"), strain = file.numbers("rods/rod/strain");
  for (std::size_t k = 0; k < 11; ++k) {
    EXPECT_EQ(time[k], static_cast<double>(k) / 25);
    EXPECT_NEAR(z[k], height_at(time[k]), 1e-15);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(position[15 * k + 3 * i], time[k], 1e-15);
      EXPECT_EQ(position[15 * k + 3 * i + 2], 0.125 * static_cast<double>(i));
      EXPECT_EQ(m[15 * k + 3 * i + 1], 0.25 * static_cast<double>(i));
      EXPECT_EQ(q[20 * k + 4 * i + 3], 1);
      EXPECT_EQ(strain[30 * k + 6 * i + 5], 1);
    }
  }
  EXPECT_EQ(file.numbers("rods/rod/s"), (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
}

TEST_F(Hdf5, IsReadAsASeriesLikeTheCsvFile) {
  record(30);
  const Series csv = read_series(folder_ / "run.csv"), hdf5 = read_series(folder_ / "run.h5");
  EXPECT_EQ(csv.time, hdf5.time);
  ASSERT_EQ(csv.columns.size(), hdf5.columns.size());
  for (std::size_t i = 0; i < csv.columns.size(); ++i) {
    EXPECT_EQ(csv.columns[i].name, hdf5.columns[i].name);
    EXPECT_EQ(csv.columns[i].unit, hdf5.columns[i].unit);
    EXPECT_EQ(csv.columns[i].values, hdf5.columns[i].values);
  }
}

TEST_F(Hdf5, IsTheSameFileEveryTime) {
  record(100);
  const std::string first = contents(folder_ / "run.h5");
  // HDF5's dates are in seconds
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  record(100);
  EXPECT_GT(first.size(), 1000u);
  EXPECT_TRUE(contents(folder_ / "run.h5") == first);
}

TEST_F(Hdf5, OfARunThatWasKilledHoldsTheBlocksThatWereFull) {
  const RecordSpec spec = spec_at(6000);
  Recording recording(scene_, spec, folder_.path());
  play(recording);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "run.h5"));
  // as it lies on the disk at this moment
  std::filesystem::copy_file(folder_ / "run.h5.part", folder_ / "copy.h5");
  const Hdf5Input file(folder_ / "copy.h5");
  EXPECT_EQ(file.shape("time"), Shape{2304});
  EXPECT_EQ(file.shape("rods/rod/m"), (Shape{2304, 5, 3}));
  EXPECT_EQ(file.numbers("time").back(), 2303.0 / 6000);
  recording.finish();
  EXPECT_EQ(Hdf5Input(folder_ / "run.h5").shape("time"), Shape{2401});
}

TEST_F(Hdf5, ATwistedRodsQuaternionsDoNotJump) {
  Scene scene = synthetic_scene();
  RecordSpec spec = spec_at(25);
  Recording recording(scene, spec, folder_.path());
  Snapshot before;
  for (int k = 0; k <= 20; ++k) {
    Snapshot now = synthetic_state(0.04 * k);
    for (RodPoint& point : now.rods[0].points)
      point.rotation = Eigen::AngleAxisd(0.5 * k, Vec3::UnitZ()).toRotationMatrix();
    if (k == 0)
      recording.begin(now);
    else
      recording.step(before, now);
    before = now;
  }
  recording.finish();
  const auto q = Hdf5Input(folder_ / "run.h5").numbers("rods/rod/quaternion");
  ASSERT_EQ(q.size(), 21u * 20u);
  for (std::size_t k = 0; k < 21; ++k) {
    EXPECT_NEAR(q[20 * k + 2], std::sin(0.25 * static_cast<double>(k)), 1e-12);
    EXPECT_NEAR(q[20 * k + 3], std::cos(0.25 * static_cast<double>(k)), 1e-12);
  }
}

// A disk that is full, as far as this process can tell.
TEST_F(Hdf5, ThatCannotBeWrittenHasNoFinalName) {
  const RecordSpec spec = spec_at(6000);
  Recording recording(scene_, spec, folder_.path());
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{20'000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  std::string complaint;
  try {
    play(recording);
    recording.finish();
  } catch (const OutputError& error) {
    complaint = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(complaint.find("cannot write"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("File too large"), std::string::npos) << complaint;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "run.h5"));
}

TEST_F(Hdf5, InAFolderThatIsNotThereIsRefusedAtOnce) {
  const RecordSpec spec = spec_at(30);
  try {
    make_hdf5_writer(folder_ / "nowhere/run.h5", scene_);
    FAIL();
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
}

std::string complaint_about(const std::filesystem::path& path) {
  try {
    read_series(path);
  } catch (const TableError& error) {
    return error.what();
  }
  return "";
}

TEST_F(Hdf5, ThatIsNoTrajectoryIsRefusedWithAReason) {
  spill(folder_ / "text.h5", "time [s],a\n0,1\n");
  EXPECT_NE(complaint_about(folder_ / "text.h5").find("not readable as HDF5"), std::string::npos);
  EXPECT_NE(complaint_about(folder_ / "none.h5").find("No such file"), std::string::npos);
  const auto with = [&](const char* name, std::vector<double> time, std::vector<double> values,
                        const std::string& units) {
    Hdf5Output file(folder_ / name);
    if (!time.empty()) file.write("time", time, {{"units", "ms"}});
    if (!values.empty()) file.write("channels/a", values, {{"units", units}});
    file.close();
    return complaint_about(folder_ / name);
  };
  EXPECT_NE(with("a.h5", {}, {1}, "m").find("no array /time"), std::string::npos);
  EXPECT_NE(with("b.h5", {1, 2}, {}, "m").find("no group /channels"), std::string::npos);
  EXPECT_NE(with("c.h5", {1, 2}, {1, 2, 3}, "m").find("2 instants"), std::string::npos);
  EXPECT_NE(with("d.h5", {2, 1}, {1, 2}, "m").find("time[1]"), std::string::npos);
  EXPECT_NE(with("e.h5", {1, 2}, {1, 2}, "lbf").find("[lbf]"), std::string::npos);
  EXPECT_EQ(with("f.h5", {1, 2}, {1, 2}, "mm"), "");
  EXPECT_EQ(read_series(folder_ / "f.h5").time[1], 0.002);
  EXPECT_EQ(read_series(folder_ / "f.h5").columns[0].values[1], 0.002);
  // cut off in the middle
  record(100);
  const std::string whole = contents(folder_ / "run.h5");
  for (const std::size_t size : {100u, 1000u, 5000u}) {
    spill(folder_ / "cut.h5", whole.substr(0, std::min(size, whole.size() - 1)));
    EXPECT_NE(complaint_about(folder_ / "cut.h5"), "") << size;
  }
}

}  // namespace
}  // namespace cprsim
