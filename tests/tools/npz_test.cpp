// SPDX-License-Identifier: BSD-3-Clause
// Recordings as NumPy archives, read back member by member.
#include <gtest/gtest.h>
#include <minizip/unzip.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/tools/scratch_folder.h"
#include "tests/tools/synthetic.h"
#include "tools/sinks/npy.h"
#include "tools/sinks/output_file.h"
#include "tools/sinks/recording.h"

namespace cprsim {
namespace {

RecordSpec spec_at(double rate) {
  RecordSpec spec;
  spec.rate = rate;
  spec.prefix = "run";
  spec.channels = {height(), iterations()};
  spec.npz = true;
  return spec;
}

class Npz : public testing::Test {
 protected:
  void record(double rate) const {
    const RecordSpec spec = spec_at(rate);
    Recording recording(scene_, spec, folder_.path());
    play(recording);
    recording.finish();
  }

  /// All members of the archive; minizip checks their sums.
  std::map<std::string, std::string> members() const {
    std::map<std::string, std::string> members;
    const unzFile file = unzOpen64((folder_ / "run.npz").c_str());
    EXPECT_NE(file, nullptr);
    for (int status = unzGoToFirstFile(file); status == UNZ_OK; status = unzGoToNextFile(file)) {
      char name[256];
      unz_file_info64 info;
      unzGetCurrentFileInfo64(file, &info, name, sizeof name, nullptr, 0, nullptr, 0);
      std::string data(info.uncompressed_size, '\0');
      EXPECT_EQ(unzOpenCurrentFile(file), UNZ_OK);
      EXPECT_EQ(unzReadCurrentFile(file, data.data(), static_cast<unsigned>(data.size())),
                static_cast<int>(data.size()));
      EXPECT_EQ(unzCloseCurrentFile(file), UNZ_OK) << name;
      members[name] = data;
    }
    unzClose(file);
    return members;
  }

  static std::vector<double> numbers(const std::string& npy, std::uint64_t rows,
                                     const std::vector<std::size_t>& shape) {
    const std::string header = npy_header(rows, shape);
    EXPECT_EQ(npy.substr(0, header.size()), header);
    std::vector<double> values((npy.size() - header.size()) / sizeof(double));
    std::memcpy(values.data(), npy.data() + header.size(), values.size() * sizeof(double));
    return values;
  }

  ScratchFolder folder_;
  Scene scene_ = synthetic_scene();
};

TEST(NpyHeader, IsThatOfTheFormat) {
  const std::string header = npy_header(13, {5, 3});
  EXPECT_EQ(header.size() % 64, 0u);
  EXPECT_EQ(header.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  EXPECT_EQ(static_cast<unsigned char>(header[8]) + 256 * static_cast<unsigned char>(header[9]),
            static_cast<int>(header.size()) - 10);
  EXPECT_EQ(header.substr(10, 66),
            "{'descr': '<f8', 'fortran_order': False, 'shape': (13, 5, 3,), }  ");
  EXPECT_EQ(header.back(), '\n');
  EXPECT_NE(npy_header(7, {}).find("'shape': (7,), }"), std::string::npos);
}

TEST_F(Npz, HoldsChannelsAndRods) {
  record(25);
  const auto all = members();
  const auto time = numbers(all.at("time.npy"), 11, {});
  const auto z = numbers(all.at("ball.position.z.npy"), 11, {});
  const auto position = numbers(all.at("rods/rod/position.npy"), 11, {5, 3});
  const auto strain = numbers(all.at("rods/rod/strain.npy"), 11, {5, 6});
  EXPECT_EQ(numbers(all.at("rods/rod/s.npy"), 5, {}), (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(all.size(), 1u + 2 + 6 + 2 + 1 + 1);
  ASSERT_EQ(position.size(), 11u * 15);
  for (std::size_t k = 0; k < 11; ++k) {
    EXPECT_EQ(time[k], static_cast<double>(k) / 25);
    EXPECT_NEAR(z[k], height_at(time[k]), 1e-15);
    EXPECT_NEAR(position[15 * k], time[k], 1e-15);
    EXPECT_EQ(position[15 * k + 14], 0.5);
    EXPECT_EQ(strain[30 * k + 5], 1);
  }
  const auto about = nlohmann::json::parse(all.at("about.json"));
  EXPECT_EQ(about["arrays"]["ball.position.z"]["units"], "m");
  EXPECT_EQ(about["arrays"]["rods/rod/n"]["frame"], "world");
}

TEST_F(Npz, IsTheSameFileEveryTime) {
  record(100);
  const std::string first = contents(folder_ / "run.npz");
  std::this_thread::sleep_for(std::chrono::milliseconds(2100));  // ZIP's dates are in two seconds
  record(100);
  EXPECT_TRUE(contents(folder_ / "run.npz") == first);
}

TEST_F(Npz, OfManyBlocksIsWhole) {
  const RecordSpec spec = spec_at(6000);
  Recording recording(scene_, spec, folder_.path());
  play(recording);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "run.npz"));
  recording.finish();
  const auto all = members();
  const auto time = numbers(all.at("time.npy"), 2401, {});
  const auto q = numbers(all.at("rods/rod/quaternion.npy"), 2401, {5, 4});
  for (std::size_t k = 0; k < time.size(); ++k) {
    ASSERT_EQ(time[k], static_cast<double>(k) / 6000);
    ASSERT_EQ(q[20 * k + 3], 1);
  }
}

TEST_F(Npz, ThatCannotBeWrittenHasNoFinalName) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  // the spool, and then the archive, does not fit
  for (const rlim_t most : {20'000u, 319'000u}) {
    const rlimit small{most, before.rlim_max};
    const RecordSpec spec = spec_at(most < 100'000 ? 6000 : 1000);
    Recording recording(scene_, spec, folder_.path());
    std::string complaint;
    setrlimit(RLIMIT_FSIZE, &small);
    try {
      play(recording);
      recording.finish();
    } catch (const OutputError& error) {
      complaint = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_NE(complaint.find("File too large"), std::string::npos) << most << complaint;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "run.npz"));
  }
  std::signal(SIGXFSZ, handler);
}

}  // namespace
}  // namespace cprsim
