// SPDX-License-Identifier: BSD-3-Clause
// cprsim test: scenes in; verdicts, a closing line and JUnit XML out.
#include <tinyxml2.h>

#include "tests/tools/program.h"

namespace cprsim {
namespace {

class TestCommand : public ProgramTest {
 protected:
  void SetUp() override {
    const std::string scene = contents(shipped("scenes/mechanics/cantilever_end_moment.xml"));
    std::filesystem::create_directories(folder_ / "s/deeper");
    spill(folder_ / "s/deeper/right.xml", scene);
    spill(folder_ / "s/wrong.xml",
          with(scene, "<converged/>", "<converged/><bound of=\"energy.elastic\" max=\"1e-9\"/>"));
    const std::string broken = with(scene, "<length>", "<lenght>1</lenght><length>");
    spill(folder_ / "s/broken.xml", broken);
    spill(folder_ / "s/rejected.xml",
          with(broken, "<converged/>", "<converged/><fails with=\"E301\"/>"));
    spill(folder_ / "s/part.sdf", "<sdf version=\"1.11\"><model name=\"m\"/></sdf>");
  }
};

TEST_F(TestCommand, RunsFoldersAndClosesWithTheLineThatToolsRead) {
  const Answer answer = run("test s --junit report.xml");
  EXPECT_EQ(answer.code, 1) << answer.err;
  EXPECT_TRUE(answer.says("\n2 passed, 2 failed, 1 skipped\n")) << answer.out;
  EXPECT_TRUE(answer.says("FAIL  s/broken.xml: the scene is invalid"));
  EXPECT_TRUE(answer.says("PASS  s/deeper/right.xml  1 of 1 met"));
  EXPECT_TRUE(answer.says("PASS  s/rejected.xml: rejected with E301, as it expects"));
  EXPECT_TRUE(answer.says("energy.elastic = "));
  EXPECT_FALSE(exists("out"));

  tinyxml2::XMLDocument xml;
  ASSERT_EQ(xml.Parse(contents(folder_ / "report.xml").c_str()), tinyxml2::XML_SUCCESS);
  const tinyxml2::XMLElement* suite = xml.FirstChildElement("testsuite");
  EXPECT_EQ(suite->IntAttribute("tests"), 5);
  EXPECT_EQ(suite->IntAttribute("failures"), 2);
  EXPECT_EQ(suite->IntAttribute("skipped"), 1);
  int failures = 0;
  for (const auto* c = suite->FirstChildElement(); c != nullptr; c = c->NextSiblingElement())
    if (const auto* failure = c->FirstChildElement("failure")) {
      ++failures;
      EXPECT_GT(std::string(failure->Attribute("message")).size(), 10U);
    }
  EXPECT_EQ(failures, 2);
}

TEST_F(TestCommand, AnswersZeroIfAllPassAndTheSameOnOneThread) {
  const Answer one = run("test s/deeper s/rejected.xml -j 1 --json");
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_EQ(nlohmann::json::parse(one.out)["passed"], 2);
  EXPECT_EQ(run("test s/deeper s/rejected.xml s/deeper/right.xml -j 3 -q").code, 0);
}

TEST_F(TestCommand, AValidSceneThatOughtToBeRejectedFails) {
  spill(folder_ / "valid.xml",
        with(contents(folder_ / "s/deeper/right.xml"), "<converged/>", "<fails with=\"E301\"/>"));
  const Answer answer = run("test valid.xml");
  EXPECT_EQ(answer.code, 1);
  EXPECT_TRUE(answer.says("expects to be rejected with E301, but is valid")) << answer.out;
  EXPECT_EQ(run("test missing.xml").code, 1);
  EXPECT_EQ(run("test").code, 2);
  std::filesystem::create_directories(folder_ / "empty");
  EXPECT_EQ(run("test empty").code, 2);
}

TEST_F(TestCommand, HoldsARunAgainstAMeasurement) {
  const std::string scene = contents(shipped("scenes/mechanics/released_rod.xml"));
  ASSERT_EQ(run("run " + shipped("scenes/mechanics/released_rod.xml") + " --no-video -o r -q").code,
            0);
  std::filesystem::copy(folder_ / "r/released_rod.csv", folder_ / "measured.csv");
  const auto asking = [&](const std::string& limit) {
    spill(folder_ / "m.xml",
          with(scene, "<converged/>",
               "<match of=\"wire::rod.tip.position\" reference=\"measured.csv\" " + limit + "/>"));
    return run("test m.xml --set scheme=bdf2 --set step=0.001");
  };
  EXPECT_FALSE(asking("max=\"0.01\"").says("is off by"));
  const Answer strict = asking("max=\"1e-6\"");
  EXPECT_EQ(strict.code, 1);
  EXPECT_TRUE(strict.says("wire::rod.tip.position is off by")) << strict.out;
  spill(folder_ / "measured.csv", "speed\n1\n");
  EXPECT_TRUE(asking("max=\"1\"").says("no column is called time"));
}

}  // namespace
}  // namespace cprsim
