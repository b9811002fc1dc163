// SPDX-License-Identifier: BSD-3-Clause
// Layout after the VTK XML file format: <DataArray format="binary"> holds base64 of a 32-bit byte
// count followed by the raw little-endian numbers, encoded as one stream.
#include "tools/sinks/vtk.h"

#include <tinyxml2.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <utility>

#include "tools/sinks/csv.h"
#include "tools/sinks/output_file.h"
#include "tools/sinks/vtk_points.h"

namespace cprsim {

namespace {

constexpr char kContacts[] = "contacts_";

static_assert(std::endian::native == std::endian::little, "to_vtp declares LittleEndian");

std::string base64(const std::vector<unsigned char>& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? bytes[i + k] : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

template <typename T>
std::string encode(const std::vector<T>& values) {
  const auto size = static_cast<std::uint32_t>(values.size() * sizeof(T));
  std::vector<unsigned char> bytes(sizeof size + size);
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), size);
  return base64(bytes);
}

class VtpPrinter {
 public:
  explicit VtpPrinter(const Snapshot& snapshot) : snapshot_(snapshot) {}

  template <typename T>
  void array(const char* name, const char* type, int components, const std::vector<T>& values) {
    xml_.OpenElement("DataArray");
    xml_.PushAttribute("type", type);
    xml_.PushAttribute("Name", name);
    xml_.PushAttribute("NumberOfComponents", components);
    // field data has no piece that would say how many there are
    xml_.PushAttribute("NumberOfTuples", static_cast<std::int64_t>(values.size()) / components);
    xml_.PushAttribute("format", "binary");
    xml_.PushText(encode(values).c_str());
    xml_.CloseElement();
  }

  void scalars(const char* name,
               const std::function<double(const RodSample&, const RodPoint&)>& of) {
    std::vector<double> values;
    for (const RodSample& rod : snapshot_.rods) {
      for (const RodPoint& point : rod.points)
        values.push_back(of(rod, point));
    }
    array(name, "Float64", 1, values);
  }

  void vectors(const char* name, Vec3 RodPoint::*of) {
    std::vector<double> values;
    for (const RodSample& rod : snapshot_.rods) {
      for (const RodPoint& point : rod.points) {
        const Vec3& v = point.*of;
        values.insert(values.end(), v.data(), v.data() + 3);
      }
    }
    array(name, "Float64", 3, values);
  }

  tinyxml2::XMLPrinter& xml() { return xml_; }

 private:
  const Snapshot& snapshot_;
  tinyxml2::XMLPrinter xml_;
};

void open_vtk_file(tinyxml2::XMLPrinter& xml, const char* type) {
  xml.PushHeader(false, true);
  xml.OpenElement("VTKFile");
  xml.PushAttribute("type", type);
  xml.PushAttribute("version", "0.1");
  xml.PushAttribute("byte_order", "LittleEndian");
}

void print_point_data(VtpPrinter& out) {
  out.xml().OpenElement("PointData");
  out.scalars("s", [](const RodSample&, const RodPoint& p) { return p.s; });
  out.scalars("arc_length", [](const RodSample& r, const RodPoint& p) { return p.s * r.length; });
  out.scalars("radius", [](const RodSample& r, const RodPoint&) { return r.radius; });
  out.vectors("curvature", &RodPoint::curvature);
  out.vectors("shear_stretch", &RodPoint::shear_stretch);
  out.vectors("force", &RodPoint::force);
  out.vectors("moment", &RodPoint::moment);
  out.vectors("velocity", &RodPoint::velocity);
  out.xml().CloseElement();
}

void print_lines(VtpPrinter& out, const Snapshot& snapshot) {
  std::vector<std::int64_t> connectivity, offsets;
  for (const RodSample& rod : snapshot.rods) {
    for (std::size_t i = 0; i < rod.points.size(); ++i) {
      connectivity.push_back(static_cast<std::int64_t>(connectivity.size()));
    }
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  out.xml().OpenElement("Lines");
  out.array("connectivity", "Int64", 1, connectivity);
  out.array("offsets", "Int64", 1, offsets);
  out.xml().CloseElement();
}

}  // namespace

std::string to_vtp(const Scene& scene, const Snapshot& snapshot) {
  if (snapshot.rods.size() != scene.rods.size()) {
    throw std::invalid_argument("a snapshot of another scene");
  }
  std::size_t point_count = 0;
  std::vector<std::int32_t> rod_indices;
  for (const RodSample& rod : snapshot.rods) {
    point_count += rod.points.size();
    rod_indices.push_back(static_cast<std::int32_t>(rod_indices.size()));
  }

  VtpPrinter out(snapshot);
  tinyxml2::XMLPrinter& xml = out.xml();
  open_vtk_file(xml, "PolyData");
  xml.OpenElement("PolyData");
  xml.OpenElement("FieldData");
  out.array("TimeValue", "Float64", 1, std::vector<double>{snapshot.time});
  xml.CloseElement();
  xml.OpenElement("Piece");
  xml.PushAttribute("NumberOfPoints", static_cast<std::int64_t>(point_count));
  xml.PushAttribute("NumberOfLines", static_cast<std::int64_t>(snapshot.rods.size()));
  print_point_data(out);
  xml.OpenElement("CellData");
  out.array("rod", "Int32", 1, rod_indices);
  xml.CloseElement();
  xml.OpenElement("Points");
  out.vectors("position", &RodPoint::position);
  xml.CloseElement();
  print_lines(out, snapshot);
  xml.CloseElement();
  xml.CloseElement();
  xml.CloseElement();
  return xml.CStr();
}

bool writes_contacts(const Scene& scene) {
  return !scene.rods.empty() &&
         (scene.effects.has(Effect::kContact) || scene.effects.has(Effect::kSelfContact));
}

std::string to_contacts_vtp(const Snapshot& snapshot) {
  std::vector<Vec3> positions;
  PointArray normal{"normal", {}, 3}, force{"force", {}, 3}, slip{"slip", {}, 3}, gap{"gap", {}},
      rod{"rod", {}};
  const auto append = [](PointArray& array, const Vec3& v) {
    array.values.insert(array.values.end(), v.data(), v.data() + 3);
  };
  for (const ContactPoint& point : snapshot.contact.points) {
    positions.push_back(point.position);
    append(normal, point.normal);
    append(force, point.force);
    append(slip, point.slip);
    gap.values.push_back(point.gap);
    rod.values.push_back(point.rod);
  }
  return to_points_vtp(positions, {normal, force, slip, gap, rod});
}

VtkWriter::VtkWriter(const std::filesystem::path& folder, std::string prefix)
    : folder_(folder), prefix_(std::move(prefix)) {
  std::error_code error;
  std::filesystem::create_directories((folder_ / frame_name("", 0)).parent_path(), error);
  if (error) throw OutputError("cannot create " + folder_.string() + ": " + error.message());
}

void VtkWriter::write_frame(const Scene& scene, const Snapshot& snapshot) {
  has_contacts_ = writes_contacts(scene);
  write_file_unsynced(folder_ / frame_name("", times_.size()), to_vtp(scene, snapshot));
  if (has_contacts_)
    write_file_unsynced(folder_ / frame_name(kContacts, times_.size()), to_contacts_vtp(snapshot));
  times_.push_back(snapshot.time);
  // the list grows with the frames: written after each, it would be most of what is written
  constexpr std::size_t kPart = 100;
  if (times_.size() > listed_ + listed_ / kPart) list_frames(Written::kWhenever);
}

void VtkWriter::finish() {
  list_frames(Written::kNow);
}

void VtkWriter::list_frames(Written written) {
  listed_ = times_.size();
  rewrite_collection(prefix_, "", written);
  if (has_contacts_) rewrite_collection(prefix_ + "_contacts", kContacts, written);
}

void VtkWriter::rewrite_collection(const std::string& name, const std::string& part,
                                   Written written) const {
  tinyxml2::XMLPrinter xml;
  open_vtk_file(xml, "Collection");
  xml.OpenElement("Collection");
  for (std::size_t i = 0; i < times_.size(); ++i) {
    xml.OpenElement("DataSet");
    xml.PushAttribute("timestep", shortest(times_[i]).c_str());
    xml.PushAttribute("part", 0);
    xml.PushAttribute("file", frame_name(part, i).c_str());
    xml.CloseElement();
  }
  xml.CloseElement();
  xml.CloseElement();
  const auto write = written == Written::kNow ? write_file : write_file_unsynced;
  write(folder_ / (name + ".pvd"), xml.CStr());
}

std::string VtkWriter::frame_name(const std::string& part, std::size_t frame) const {
  const std::string digits = std::to_string(frame);
  const std::size_t zeros = digits.size() < 6 ? 6 - digits.size() : 0;
  return prefix_ + "_vtk/" + part + std::string(zeros, '0') + digits + ".vtp";
}

}  // namespace cprsim
