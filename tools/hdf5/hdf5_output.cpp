// SPDX-License-Identifier: BSD-3-Clause
#include "tools/hdf5/hdf5_output.h"

#include <hdf5.h>

namespace cprsim {

namespace {

/// In the order in which they were made, as a CSV file has its columns.
constexpr unsigned kKeepOrder = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
constexpr unsigned kDeflate = 4;  ///< of 9; more costs time and gains nothing on doubles

std::vector<hsize_t> extents(std::size_t rows, const std::vector<std::size_t>& shape) {
  std::vector<hsize_t> result{rows};
  result.insert(result.end(), shape.begin(), shape.end());
  return result;
}

Hdf5Id space_of(const std::vector<hsize_t>& now, const std::vector<hsize_t>& most) {
  return Hdf5Id(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()));
}

void annotate_object(hid_t object, const Hdf5Attributes& attributes) {
  const Hdf5Id type(H5Tcopy(H5T_C_S1));
  checked(H5Tset_size(type, H5T_VARIABLE));
  checked(H5Tset_cset(type, H5T_CSET_UTF8));
  const Hdf5Id space(H5Screate(H5S_SCALAR));
  for (const auto& [name, text] : attributes) {
    const Hdf5Id attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
    const char* const data = text.c_str();
    checked(H5Awrite(attribute, type, &data));
  }
}

/// Of a file or a group: its creation has no date.
void set_up(hid_t creation) {
  checked(H5Pset_obj_track_times(creation, false));
  checked(H5Pset_link_creation_order(creation, kKeepOrder));
}

Hdf5Id create_file(const std::filesystem::path& path) {
  start_hdf5();
  const Hdf5Id creation(H5Pcreate(H5P_FILE_CREATE));
  set_up(creation);
  return Hdf5Id(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT));
}

/// Those above `path` that are not there yet.
void create_groups(hid_t file, const std::string& path) {
  const Hdf5Id creation(H5Pcreate(H5P_GROUP_CREATE));
  set_up(creation);
  for (std::size_t at = path.find('/'); at != std::string::npos; at = path.find('/', at + 1)) {
    const std::string group = path.substr(0, at);
    if (checked(H5Lexists(file, group.c_str(), H5P_DEFAULT)) > 0) continue;
    const Hdf5Id made(H5Gcreate2(file, group.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT));
  }
}

Hdf5Id dataset_creation() {
  Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE));
  checked(H5Pset_obj_track_times(creation, false));
  return creation;
}

/// A chunk is written once and whole: nothing is kept of it, however many arrays there are.
Hdf5Id without_cache() {
  Hdf5Id access(H5Pcreate(H5P_DATASET_ACCESS));
  checked(H5Pset_chunk_cache(access, 1, 0, 1.0));
  return access;
}

}  // namespace

Hdf5Output::Hdf5Output(const std::filesystem::path& path) : file_(create_file(path)) {}

std::size_t Hdf5Output::create(const std::string& path, const std::vector<std::size_t>& shape,
                               std::size_t chunk_rows, const Hdf5Attributes& attributes) {
  create_groups(file_, path);
  const Hdf5Id creation = dataset_creation(), access = without_cache();
  const std::vector<hsize_t> chunk = extents(chunk_rows, shape);
  checked(H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data()));
  // the bytes of equal weight side by side: doubles that change little then compress
  checked(H5Pset_shuffle(creation));
  checked(H5Pset_deflate(creation, kDeflate));
  std::vector<hsize_t> now = extents(0, shape), most = now;
  most[0] = H5S_UNLIMITED;
  const Hdf5Id space = space_of(now, most);
  arrays_.push_back({Hdf5Id(H5Dcreate2(file_, path.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT,
                                       creation, access)),
                     shape, 0});
  annotate_object(arrays_.back().set, attributes);
  return arrays_.size() - 1;
}

void Hdf5Output::append(std::size_t array, std::size_t rows, std::span<const double> numbers) {
  Array& a = arrays_.at(array);
  const std::vector<hsize_t> all = extents(a.rows + rows, a.shape), part = extents(rows, a.shape);
  std::vector<hsize_t> start(all.size(), 0);
  start[0] = a.rows;
  checked(H5Dset_extent(a.set, all.data()));
  const Hdf5Id in_file(H5Dget_space(a.set)), in_memory = space_of(part, part);
  checked(
      H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start.data(), nullptr, part.data(), nullptr));
  checked(H5Dwrite(a.set, H5T_NATIVE_DOUBLE, in_memory, in_file, H5P_DEFAULT, numbers.data()));
  a.rows += rows;
}

void Hdf5Output::write(const std::string& path, std::span<const double> numbers,
                       const Hdf5Attributes& attributes) {
  create_groups(file_, path);
  const Hdf5Id creation = dataset_creation();
  const Hdf5Id space = space_of({numbers.size()}, {numbers.size()});
  const Hdf5Id set(
      H5Dcreate2(file_, path.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  checked(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()));
  annotate_object(set, attributes);
}

void Hdf5Output::annotate(const Hdf5Attributes& attributes) {
  annotate_object(file_, attributes);
}

void Hdf5Output::flush() {
  checked(H5Fflush(file_, H5F_SCOPE_GLOBAL));
}

void Hdf5Output::close() {
  for (Array& array : arrays_)
    array.set.close();
  file_.close();
}

}  // namespace cprsim
