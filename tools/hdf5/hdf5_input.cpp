// SPDX-License-Identifier: BSD-3-Clause
#include "tools/hdf5/hdf5_input.h"

#include <hdf5.h>

namespace cprsim {

namespace {

constexpr std::size_t kMostNumbers = 1u << 30;  ///< a file may claim more than it holds

herr_t collect(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

Hdf5Id open_file(const std::string& path) {
  start_hdf5();
  return Hdf5Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
}

Hdf5Id open_array(hid_t file, const std::string& path) {
  return Hdf5Id(H5Dopen2(file, path.c_str(), H5P_DEFAULT));
}

/// Of a text of any kind: of its own length, or padded to a fixed one.
std::string read_text(hid_t attribute, hid_t type) {
  if (checked(H5Tis_variable_str(type)) > 0) {
    char* data = nullptr;
    const Hdf5Id memory(H5Tcopy(type));
    checked(H5Aread(attribute, memory, &data));
    const std::string text = data != nullptr ? data : "";
    H5free_memory(data);
    return text;
  }
  std::string text(H5Tget_size(type), '\0');
  checked(H5Aread(attribute, type, text.data()));
  return text.substr(0, text.find('\0'));
}

}  // namespace

Hdf5Input::Hdf5Input(const std::string& path) : file_(open_file(path)) {}

bool Hdf5Input::has(const std::string& path) const {
  for (std::size_t at = path.find('/'); at != std::string::npos; at = path.find('/', at + 1))
    if (checked(H5Lexists(file_, path.substr(0, at).c_str(), H5P_DEFAULT)) == 0) return false;
  return checked(H5Lexists(file_, path.c_str(), H5P_DEFAULT)) > 0;
}

std::vector<std::string> Hdf5Input::names(const std::string& group) const {
  const Hdf5Id open(H5Gopen2(file_, group.c_str(), H5P_DEFAULT));
  const Hdf5Id creation(H5Gget_create_plist(open));
  unsigned order = 0;
  checked(H5Pget_link_creation_order(creation, &order));
  const bool ordered = (order & H5P_CRT_ORDER_TRACKED) != 0;
  std::vector<std::string> names;
  checked(H5Literate(open, ordered ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME, H5_ITER_INC, nullptr,
                     collect, &names));
  return names;
}

std::vector<std::size_t> Hdf5Input::shape(const std::string& path) const {
  const Hdf5Id set = open_array(file_, path);
  const Hdf5Id space(H5Dget_space(set));
  const int rank = checked(H5Sget_simple_extent_ndims(space));
  std::vector<hsize_t> extents(static_cast<std::size_t>(rank));
  if (rank > 0) checked(H5Sget_simple_extent_dims(space, extents.data(), nullptr));
  return {extents.begin(), extents.end()};
}

std::vector<double> Hdf5Input::numbers(const std::string& path) const {
  std::size_t count = 1;
  for (const std::size_t extent : shape(path)) {
    if (extent > kMostNumbers) throw Hdf5Error(path + " is unreasonably large");
    count *= extent;
    if (count > kMostNumbers) throw Hdf5Error(path + " is unreasonably large");
  }
  const Hdf5Id set = open_array(file_, path);
  std::vector<double> numbers(count);
  if (count > 0)
    checked(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()));
  return numbers;
}

std::vector<double> Hdf5Input::row(const std::string& path, std::size_t index) const {
  const std::vector<std::size_t> extents = shape(path);
  if (extents.empty() || index >= extents[0]) throw Hdf5Error(path + " has too few rows");
  std::vector<hsize_t> start(extents.size(), 0), count(extents.begin(), extents.end());
  start[0] = index;
  count[0] = 1;
  std::size_t numbers = 1;
  for (std::size_t k = 1; k < extents.size(); ++k) {
    if (extents[k] > kMostNumbers) throw Hdf5Error(path + " is unreasonably large");
    numbers *= extents[k];
    if (numbers > kMostNumbers) throw Hdf5Error(path + " is unreasonably large");
  }
  std::vector<double> row(numbers);
  if (row.empty()) return row;
  const Hdf5Id set = open_array(file_, path), space(H5Dget_space(set));
  checked(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
  const hsize_t flat = row.size();
  const Hdf5Id memory(H5Screate_simple(1, &flat, nullptr));
  checked(H5Dread(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, row.data()));
  return row;
}

std::string Hdf5Input::text(const std::string& path, const std::string& attribute) const {
  const char* const name = attribute.c_str();
  if (checked(H5Aexists_by_name(file_, path.c_str(), name, H5P_DEFAULT)) == 0) return "";
  const Hdf5Id open(H5Aopen_by_name(file_, path.c_str(), name, H5P_DEFAULT, H5P_DEFAULT));
  const Hdf5Id type(H5Aget_type(open)), space(H5Aget_space(open));
  const bool one_text =
      H5Tget_class(type) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1;
  return one_text ? read_text(open, type) : "";
}

}  // namespace cprsim
