// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/meshes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace cprsim {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, gone afterwards.
class Meshes : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("cprsim_meshes_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::create_directories(folder_ / "assets");
  }

  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    const fs::path path = folder_ / "assets" / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

  MeshSpec load(const std::string& path, const Vec3& scale = Vec3::Ones(),
                const std::string& part = "", bool center = false) {
    return load_mesh(path, (folder_ / "assets").string(), scale, part, center, error_, &dropped_);
  }

  fs::path folder_;
  std::string error_;
  std::size_t dropped_ = 0;
};

const char* const kTetrahedron =
    "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
         "\nendloop\nendfacet\n";
}

std::string collada(const std::string& unit, const std::string& up, const std::string& nodes) {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter=")" +
         unit + R"("/><up_axis>)" + up + R"(</up_axis></asset>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 3</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s" name="s">)" +
         nodes + R"(</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

Eigen::AlignedBox3f box_of(const MeshSpec& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.positions)
    box.extend(p);
  return box;
}

TEST_F(Meshes, ReadsTrianglesAndScalesThem) {
  const MeshSpec mesh = load(write("t.obj", kTetrahedron), Vec3(0.5, 1, 2));
  ASSERT_EQ(error_, "");
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_TRUE(box_of(mesh).max().isApprox(Eigen::Vector3f(1, 2, 4)));
  EXPECT_TRUE(mesh.colors.empty()) << "the file gives no colours";
}

TEST_F(Meshes, NormalsPointOutwardAlsoWhenMirrored) {
  for (double sign : {1.0, -1.0}) {
    const MeshSpec mesh = load(write("t.obj", kTetrahedron), Vec3(sign, 1, 1));
    ASSERT_EQ(error_, "");
    const Eigen::Vector3f middle = box_of(mesh).center() * 0.5F;
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3f a = mesh.positions[t[0]], b = mesh.positions[t[1]],
                            c = mesh.positions[t[2]];
      const Eigen::Vector3f n = (b - a).cross(c - a);
      EXPECT_GT(n.dot((a + b + c) / 3 - middle), 0);
      EXPECT_GT(n.dot(mesh.normals[t[0]]), 0);
    }
  }
}

TEST_F(Meshes, CentresTheBox) {
  const MeshSpec mesh = load(write("t.obj", kTetrahedron), Vec3::Ones(), "", true);
  ASSERT_EQ(error_, "");
  EXPECT_LT(box_of(mesh).center().norm(), 1e-6F);
}

TEST_F(Meshes, PicksASubmeshAndNamesAMissingOne) {
  const std::string path = write("two.obj", std::string("o first\n") + kTetrahedron +
                                                "o second\nv 9 0 0\nv 9 1 0\nv 9 0 1\nf 5 6 7\n");
  EXPECT_EQ(load(path).triangles.size(), 5U);
  EXPECT_EQ(load(path, Vec3::Ones(), "second").triangles.size(), 1U);
  EXPECT_EQ(error_, "");
  load(path, Vec3::Ones(), "third");
  EXPECT_NE(error_.find("third"), std::string::npos);
}

TEST_F(Meshes, TakesColoursFromTheMaterial) {
  write("m.mtl", "newmtl red\nKd 1 0.25 0\n");
  const MeshSpec mesh =
      load(write("t.obj", std::string("mtllib m.mtl\nusemtl red\n") + kTetrahedron));
  ASSERT_EQ(error_, "");
  ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
  EXPECT_TRUE(mesh.colors[0].isApprox(Eigen::Vector3f(1, 0.25F, 0)));
}

TEST_F(Meshes, OpensNothingOutsideTheAssetRoot) {
  std::ofstream(folder_ / "secret.mtl") << "newmtl red\nKd 1 0 0\n";
  for (const std::string& name :
       {std::string("../secret.mtl"), (folder_ / "secret.mtl").string()}) {
    const MeshSpec mesh = load(write("t.obj", "mtllib " + name + "\nusemtl red\n" + kTetrahedron));
    for (const Eigen::Vector3f& color : mesh.colors) {
      EXPECT_GT(color.y(), 0.1F) << "the red of " << name << " was read";
    }
  }
  std::ofstream(folder_ / "outside.obj") << kTetrahedron;
  load((folder_ / "outside.obj").string());
  EXPECT_NE(error_, "") << "the mesh itself lies outside";
  fs::create_symlink(folder_ / "outside.obj", folder_ / "assets" / "link.obj");
  load((folder_ / "assets" / "link.obj").string());
  EXPECT_NE(error_, "") << "and so does what a link points to";
}

TEST_F(Meshes, DropsAndCountsTrianglesWithoutArea) {
  const MeshSpec mesh = load(write("d.stl", "solid d\n" + facet("0 0 0", "1 0 0", "0 1 0") +
                                                facet("0 0 0", "1 0 0", "2 0 0") +
                                                facet("1 1 1", "1 1 1", "1 1 1") + "endsolid d\n"));
  ASSERT_EQ(error_, "");
  EXPECT_EQ(mesh.triangles.size(), 1U);
  EXPECT_EQ(dropped_, 2U);
}

TEST_F(Meshes, RefusesNumbersThatAreNone) {
  load(write("n.stl", "solid n\n" + facet("0 0 0", "nan 0 0", "0 1 0") + "endsolid n\n"));
  EXPECT_NE(error_, "");
  load(write("i.obj", "v 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n"));
  EXPECT_NE(error_, "");
}

TEST_F(Meshes, SmoothsRoundStlButKeepsItsEdges) {
  // two facets at a right angle keep their own normals, two at 10 degrees share one
  const auto spread = [&](double degrees) {
    const double a = degrees * 3.14159265358979 / 180;
    const std::string c = std::to_string(std::cos(a)) + " 0 " + std::to_string(std::sin(a));
    const MeshSpec mesh = load(write("s.stl", "solid s\n" + facet("0 0 0", "0 1 0", "-1 0 0") +
                                                  facet("0 0 0", c, "0 1 0") + "endsolid s\n"));
    EXPECT_EQ(error_, "");
    float least = 1;
    for (const auto& n : mesh.normals)
      least = std::min(least, n.dot(mesh.normals[0]));
    return mesh.positions.size();
  };
  EXPECT_EQ(spread(90), 6U);
  EXPECT_EQ(spread(10), 4U);
}

TEST_F(Meshes, ColladaUnitCountsAndUpAxisDoesNot) {
  const std::string node = R"(<node><instance_geometry url="#g"/></node>)";
  for (const std::string up : {"Z_UP", "Y_UP"}) {
    const MeshSpec mesh = load(write("u.dae", collada("0.001", up, node)));
    ASSERT_EQ(error_, "");
    EXPECT_TRUE(box_of(mesh).max().isApprox(Eigen::Vector3f(0.001F, 0.001F, 0.003F))) << up;
  }
}

TEST_F(Meshes, AppliesTheTransformsOfNodes) {
  const MeshSpec mesh = load(
      write("n.dae", collada("1", "Z_UP",
                             R"(<node><translate>0 0 5</translate><node><translate>1 0 0</translate>
<instance_geometry url="#g"/></node></node>)")));
  ASSERT_EQ(error_, "");
  EXPECT_TRUE(box_of(mesh).max().isApprox(Eigen::Vector3f(2, 1, 8)));
}

TEST_F(Meshes, RefusesNestingThatWouldExhaustTheStack) {
  std::string open, close;
  for (int i = 0; i < 20000; ++i) {
    open += "<node>";
    close += "</node>";
  }
  load(write("deep.dae", collada("1", "Z_UP", open + close)));
  EXPECT_NE(error_.find("nested"), std::string::npos) << error_;
  std::string nodes;
  for (int i = 0; i < 20000; ++i)
    nodes += "{\"children\":[" + std::to_string(i + 1) + "]},";
  load(write("deep.gltf",
             R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
                 "{}]}"));
  EXPECT_NE(error_.find("children"), std::string::npos) << error_;
}

// Found by tests/fuzz: assimp read the first for ever, into ever more memory; the last ends where a
// count should begin.
TEST_F(Meshes, RefusesColladaThatAssimpDoesNotSurvive) {
  const auto dae = [](const std::string& indices, const std::string& count) {
    return "<?xml version=\"1.0\"?><COLLADA version=\"1.4.1\"><library_geometries><geometry "
           "id=\"g\">"
           "<mesh><triangles count=\"" +
           count + "\"><p>" + indices +
           "</p></triangles></mesh></geometry></library_geometries></COLLADA>";
  };
  load(write("index.dae", dae("\x81 1 2", "1")));
  EXPECT_NE(error_.find("index"), std::string::npos) << error_;
  load(write("count.dae", dae("0 1 2", "4000000000")));
  EXPECT_NE(error_.find("count"), std::string::npos) << error_;
  load(write("cut.dae", "<?xml version=\"1.0\"?><COLLADA><triangles count="));
  EXPECT_FALSE(error_.empty());
}

TEST_F(Meshes, SaysWhyAFileIsNotRead) {
  load(write("x.ply", "ply\n"));
  EXPECT_NE(error_.find("'ply' is not read"), std::string::npos);
  load(write("empty.stl", ""));
  EXPECT_NE(error_.find("empty"), std::string::npos);
  load((folder_ / "assets" / "absent.stl").string());
  EXPECT_NE(error_.find("cannot be opened"), std::string::npos);
  load(write("bad.obj", "f 1 2 3\n"));
  EXPECT_NE(error_, "");
  // the content of another format under an allowed name must not reach that format's reader
  load(write("ply.obj", "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n"));
  EXPECT_NE(error_, "");
  load(write("t.obj", kTetrahedron), Vec3(0, 1, 1));
  EXPECT_NE(error_.find("scale"), std::string::npos);
}

}  // namespace
}  // namespace cprsim
