// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/vtk_points.h"

#include <tinyxml2.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

/// VTK reads "nan" in any case.
std::string number(double value) {
  return std::isnan(value) ? "nan" : shortest(value);
}

void array(tinyxml2::XMLPrinter& xml, const char* name, const char* type, int components,
           const std::string& text) {
  xml.OpenElement("DataArray");
  xml.PushAttribute("type", type);
  xml.PushAttribute("Name", name);
  xml.PushAttribute("NumberOfComponents", components);
  xml.PushAttribute("format", "ascii");
  xml.PushText(text.c_str());
  xml.CloseElement();
}

void vertices(tinyxml2::XMLPrinter& xml, std::size_t count) {
  std::string connectivity, offsets;
  for (std::size_t i = 0; i < count; ++i) {
    connectivity += std::to_string(i) + ' ';
    offsets += std::to_string(i + 1) + ' ';
  }
  xml.OpenElement("Verts");
  array(xml, "connectivity", "Int64", 1, connectivity);
  array(xml, "offsets", "Int64", 1, offsets);
  xml.CloseElement();
}

}  // namespace

std::string to_points_vtp(const std::vector<Vec3>& positions,
                          const std::vector<PointArray>& arrays) {
  tinyxml2::XMLPrinter xml;
  xml.PushHeader(false, true);
  xml.OpenElement("VTKFile");
  xml.PushAttribute("type", "PolyData");
  xml.PushAttribute("version", "0.1");
  xml.PushAttribute("byte_order", "LittleEndian");
  xml.OpenElement("PolyData");
  xml.OpenElement("Piece");
  xml.PushAttribute("NumberOfPoints", static_cast<std::int64_t>(positions.size()));
  xml.PushAttribute("NumberOfVerts", static_cast<std::int64_t>(positions.size()));
  xml.OpenElement("PointData");
  for (const PointArray& each : arrays) {
    if (each.values.size() != positions.size() * static_cast<std::size_t>(each.components)) {
      throw std::invalid_argument(each.name + " has another number of values than points");
    }
    std::string text;
    for (const double value : each.values)
      text += number(value) + ' ';
    array(xml, each.name.c_str(), "Float64", each.components, text);
  }
  xml.CloseElement();
  xml.OpenElement("Points");
  std::string text;
  for (const Vec3& p : positions)
    text += number(p.x()) + ' ' + number(p.y()) + ' ' + number(p.z()) + ' ';
  array(xml, "position", "Float64", 3, text);
  xml.CloseElement();
  vertices(xml, positions.size());
  xml.CloseElement();
  xml.CloseElement();
  xml.CloseElement();
  return xml.CStr();
}

}  // namespace cprsim
