// SPDX-License-Identifier: BSD-3-Clause
// Files made to break a reader: each is refused with a code, quickly, whatever it holds.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <random>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

namespace fs = std::filesystem;

class HostileFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("cprsim_hostile_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }

  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  static std::string only_code(const LoadResult& result) {
    EXPECT_FALSE(result.scene);
    const auto codes = error_codes(result);
    return codes.size() == 1 ? codes[0] : "several";
  }

  static std::string code_of_text(const std::string& text) { return only_code(load_text(text)); }

  fs::path folder_;
};

std::string repeat(const std::string& text, int times) {
  std::string all;
  for (int k = 0; k < times; ++k)
    all += text;
  return all;
}

TEST_F(HostileFiles, ThatAreNoFilesAreRefusedWithoutBlocking) {
  EXPECT_EQ(only_code(load_scene((folder_ / "absent.xml").string())), "E101");
  EXPECT_EQ(only_code(load_scene(folder_.string())), "E102");
  const fs::path pipe = folder_ / "pipe.xml";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(only_code(load_scene(pipe.string())), "E102");
  EXPECT_EQ(only_code(load_scene("/dev/zero")), "E102");
  EXPECT_EQ(only_code(load_scene("/dev/null")), "E102");
}

TEST_F(HostileFiles, ThatAreHugeAreRefusedBeforeTheyAreRead) {
  const fs::path big = write("big.xml", "<sdf/>");
  fs::resize_file(big, std::uintmax_t{3} << 30);  // sparse
  EXPECT_EQ(only_code(load_scene(big.string())), "E103");
}

TEST_F(HostileFiles, ThatAreEmptyOrBlankSayso) {
  EXPECT_EQ(only_code(load_scene(write("empty.xml", "").string())), "E104");
  EXPECT_EQ(code_of_text(" \n\t "), "E104");
}

TEST_F(HostileFiles, CannotExhaustTheParser) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(code_of_text(repeat("<a>", 100000)), "E105");
  EXPECT_EQ(code_of_text("<sdf>" + repeat("<a/>", 1000000) + "</sdf>"), "E105");
  std::string attributes = "<sdf";
  for (int k = 0; k < 80000; ++k)
    attributes += " a" + std::to_string(k) + "=''";
  EXPECT_EQ(code_of_text(attributes + "/>"), "E105");
  EXPECT_EQ(code_of_text("<sdf version='" + std::string(10'000'000, 'x') + "'/>"), "E207");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 20.0);  // a fraction of a second; sanitizers and busy machines included
}

TEST_F(HostileFiles, AreReadWithByteOrderMarkAndCarriageReturns) {
  std::string text = scene_text();
  EXPECT_TRUE(load_text("\xEF\xBB\xBF" + text).scene);
  std::string dos;
  for (const char c : text)
    dos += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_TRUE(load_text(dos).scene);
}

TEST_F(HostileFiles, InOtherEncodingsAreRefused) {
  EXPECT_EQ(code_of_text(std::string("\xFF\xFE<\0s\0", 6)), "E202");
  EXPECT_EQ(code_of_text(std::string("<sdf>\0</sdf>", 12)), "E202");
  EXPECT_EQ(code_of_text("<sdf>\xC0\xAF</sdf>"), "E202");      // overlong
  EXPECT_EQ(code_of_text("<sdf>\xED\xA0\x80</sdf>"), "E202");  // surrogate
  for (const char* bad : {"\xC3", "\xC3(", "\xE0\x9F\xBF", "\xE2\x82", "\xE2(\x82",
                          "\xF0\x8F\xBF\xBF", "\xF0\x9D\x84", "\xF0\x9D(\x84", "\xF0(\x9D\x84",
                          "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\x80"})
    EXPECT_EQ(code_of_text(std::string("<sdf>") + bad + "</sdf>"), "E202") << bad;
  // the least and the largest of two, three and four bytes, and around the surrogates
  for (const char* good : {"\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
                           "\xEF\xBF\xBD", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF", "\t\r\n"})
    EXPECT_TRUE(load_text(scene_text(std::string("<!--") + good + "-->")).scene) << good;
}

TEST_F(HostileFiles, CutAnywhereGiveErrorsNotCrashes) {
  const std::string text = scene_text(
      "<cprsim:load at='leg::tip'><force>0 0 1</force></cprsim:load>",
      "<cprsim:record rate='1' prefix='o'><channel>robot::leg.*</channel><csv/></cprsim:record>");
  ASSERT_TRUE(load_text(text).scene) << to_text(load_text(text).diagnostics);
  const std::size_t whole = text.rfind('>');
  for (std::size_t length = 0; length <= whole; ++length) {
    const LoadResult result = load_text(text.substr(0, length));
    EXPECT_FALSE(result.scene) << length;
    EXPECT_TRUE(has_errors(result.diagnostics)) << length;
  }
}

TEST_F(HostileFiles, MutatedAnyhowGiveASceneOrErrors) {
  const std::string original =
      file_text(std::string(CPRSIM_SOURCE_DIR) + "/scenes/robots/stewart_gough.xml");
  std::mt19937 random(1);
  const std::string alphabet = "<>/=\"'&; 0.-e:[]x\n";
  for (int round = 0; round < 1500; ++round) {
    std::string text = original;
    for (int k = 0; k < 1 + round % 4; ++k) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text.erase(at, 1 + random() % 40);
          break;
        case 1:
          text.insert(at, 1, alphabet[random() % alphabet.size()]);
          break;
        case 2:
          text.insert(at, text.substr(random() % text.size(), random() % 60));
          break;
        default:
          text[at] = alphabet[random() % alphabet.size()];
      }
    }
    const LoadResult result = load_text(text);
    EXPECT_NE(static_cast<bool>(result.scene), has_errors(result.diagnostics)) << round;
    EXPECT_FALSE(to_text(result.diagnostics).empty() && !result.scene);
  }
}

TEST_F(HostileFiles, CannotReachOutThroughIncludes) {
  const auto with_include = [](const std::string& uri) {
    return scene_text("", "<include><uri>" + uri + "</uri></include>");
  };
  write("secret.txt", "root:x:0:0");
  fs::create_directories(folder_ / "scene");
  fs::create_symlink(folder_ / "secret.txt", folder_ / "scene/link.sdf");
  for (const char* uri : {"/etc/passwd", "../secret.txt", "link.sdf", "file:///etc/passwd",
                          "http://localhost/x", "./../secret.txt"}) {
    const fs::path scene = write("scene/s.xml", with_include(uri));
    EXPECT_EQ(only_code(load_scene(scene.string())), "E107") << uri;
  }
  EXPECT_EQ(only_code(load_scene(write("scene/s.xml", with_include("a&#0;b")).string())), "E106");
}

TEST_F(HostileFiles, CannotIncludeInALoopOrTooDeep) {
  const std::string head = "<sdf version='1.11'><model name='m'><link name='l'/><include><uri>";
  write("a.sdf", head + "b.sdf</uri></include></model></sdf>");
  write("b.sdf", head + "a.sdf</uri></include></model></sdf>");
  const std::string loop = scene_text("", "<include><uri>a.sdf</uri></include>");
  EXPECT_TRUE(has_code(load_scene(write("s.xml", loop).string()), "E108"));
  for (int k = 0; k < 12; ++k)
    write("n" + std::to_string(k) + ".sdf",
          head + "n" + std::to_string(k + 1) + ".sdf</uri></include></model></sdf>");
  const std::string deep = scene_text("", "<include><uri>n0.sdf</uri></include>");
  EXPECT_TRUE(has_code(load_scene(write("s.xml", deep).string()), "E108"));
}

}  // namespace
}  // namespace cprsim
