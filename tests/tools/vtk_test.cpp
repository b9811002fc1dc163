// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/vtk.h"

#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <cstdint>
#include <cstring>
#include <sstream>

#include "tests/tools/synthetic.h"

namespace cprsim {
namespace {

std::string decode_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    group = group << 6 | static_cast<std::uint32_t>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 255u);
  }
  return bytes;
}

/// The numbers of a <DataArray>, after checking that its byte count is right.
template <typename T>
std::vector<T> numbers(const tinyxml2::XMLElement* parent, const char* name) {
  for (auto* array = parent->FirstChildElement("DataArray"); array != nullptr;
       array = array->NextSiblingElement("DataArray")) {
    if (!array->Attribute("Name", name)) continue;
    const std::string bytes = decode_base64(array->GetText());
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data(), sizeof size);
    EXPECT_EQ(bytes.size(), sizeof size + size);
    std::vector<T> values(size / sizeof(T));
    std::memcpy(values.data(), bytes.data() + sizeof size, size);
    return values;
  }
  ADD_FAILURE() << "no array " << name;
  return {};
}

TEST(Vtp, HoldsOneLinePerRodWithItsPointDataBitForBit) {
  Scene scene = synthetic_scene();
  scene.rods.emplace_back().name = "second";
  Snapshot state = synthetic_state(0.3);
  state.rods.push_back(state.rods[0]);
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(to_vtp(scene, state).c_str()), tinyxml2::XML_SUCCESS);
  const auto* data = document.FirstChildElement("VTKFile")->FirstChildElement("PolyData");
  const auto* piece = data->FirstChildElement("Piece");
  EXPECT_STREQ(piece->Attribute("NumberOfPoints"), "10");
  EXPECT_STREQ(piece->Attribute("NumberOfLines"), "2");

  const auto points = numbers<double>(piece->FirstChildElement("Points"), "position");
  const auto moments = numbers<double>(piece->FirstChildElement("PointData"), "moment");
  const auto arc = numbers<double>(piece->FirstChildElement("PointData"), "arc_length");
  ASSERT_EQ(points.size(), 30u);
  for (std::size_t k = 0; k < 5; ++k) {
    const RodPoint& point = state.rods[0].points[k];
    EXPECT_EQ(points[3 * k + 2], point.position.z());
    EXPECT_EQ(moments[3 * k + 1], point.moment.y());
    EXPECT_EQ(arc[k], 0.5 * point.s);
  }
  EXPECT_EQ(numbers<std::int64_t>(piece->FirstChildElement("Lines"), "offsets"),
            (std::vector<std::int64_t>{5, 10}));
  EXPECT_EQ(numbers<std::int32_t>(piece->FirstChildElement("CellData"), "rod"),
            (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(numbers<double>(data->FirstChildElement("FieldData"), "TimeValue"),
            (std::vector<double>{0.3}));
}

TEST(Vtp, OfASceneWithoutRodsIsEmptyButWhole) {
  Scene scene = synthetic_scene();
  scene.rods.clear();
  Snapshot state = synthetic_state(0);
  state.rods.clear();
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(to_vtp(scene, state).c_str()), tinyxml2::XML_SUCCESS);
}

/// The numbers of a <DataArray> that is text.
std::vector<double> text_numbers(const tinyxml2::XMLElement* parent, const char* name) {
  std::vector<double> values;
  for (auto* array = parent->FirstChildElement("DataArray"); array != nullptr;
       array = array->NextSiblingElement("DataArray")) {
    if (!array->Attribute("Name", name)) continue;
    std::istringstream text(array->GetText() ? array->GetText() : "");
    for (double value = 0; text >> value;)
      values.push_back(value);
  }
  return values;
}

TEST(Vtp, HoldsThePointsWhereRodsTouch) {
  Snapshot state = synthetic_state(0.3);
  ContactPoint point;
  point.rod = 1;
  point.position = {0.1, 0.2, 0.3};
  point.normal = Vec3::UnitY();
  point.force = {0.5, 2, -0.25};
  point.gap = -1e-9;
  state.contact.points = {ContactPoint{}, point};
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(to_contacts_vtp(state).c_str()), tinyxml2::XML_SUCCESS);
  const auto* piece = document.FirstChildElement("VTKFile")
                          ->FirstChildElement("PolyData")
                          ->FirstChildElement("Piece");
  EXPECT_STREQ(piece->Attribute("NumberOfPoints"), "2");
  const auto* data = piece->FirstChildElement("PointData");
  EXPECT_EQ(text_numbers(piece->FirstChildElement("Points"), "position"),
            (std::vector<double>{0, 0, 0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(text_numbers(data, "force"), (std::vector<double>{0, 0, 0, 0.5, 2, -0.25}));
  EXPECT_EQ(text_numbers(data, "normal"), (std::vector<double>{0, 0, 1, 0, 1, 0}));
  EXPECT_EQ(text_numbers(data, "gap"), (std::vector<double>{0, -1e-9}));
  EXPECT_EQ(text_numbers(data, "rod"), (std::vector<double>{0, 1}));
}

TEST(Vtp, WithoutAContactHasNoPoints) {
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(to_contacts_vtp(synthetic_state(0)).c_str()), tinyxml2::XML_SUCCESS);
}

}  // namespace
}  // namespace cprsim
