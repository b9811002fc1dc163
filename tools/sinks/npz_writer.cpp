// SPDX-License-Identifier: BSD-3-Clause
// Members: time.npy; a .npy for each channel under its name; rods/<name>/... as in HDF5;
// about.json with units and frames. An archive takes one array after the other, so that the blocks
// wait in a spool until the run ends.
#include <nlohmann/json.hpp>

#include "tools/sinks/array_writer.h"
#include "tools/sinks/npy.h"
#include "tools/sinks/output_file.h"
#include "tools/sinks/spool.h"
#include "tools/sinks/zip_file.h"

namespace cprsim {

namespace {

std::string key_of(const RecordArray& array) {
  const bool rod = array.group.starts_with("rods/");
  return rod ? array.group + "/" + array.name : array.name;
}

class NpzWriter : public ArrayWriter {
 public:
  NpzWriter(const std::filesystem::path& path, const Scene& scene)
      : ArrayWriter(scene), folder_(path.parent_path()), zip_(path) {}

  std::string extension() const override { return ".npz"; }

  std::string kind() const override { return "npz"; }

 protected:
  void open(const RecordArrays& arrays) override {
    arrays_ = arrays.list();
    std::vector<std::size_t> widths;
    for (const RecordArray& array : arrays_)
      widths.push_back(array.width() * sizeof(double));
    spool_.emplace(folder_, widths, arrays.block_rows());
    for (std::size_t r = 0; r < arrays.rods(); ++r)
      grids_.emplace_back(rod_group(scene().rods[r]) + "/s", arrays.grid(r));
  }

  void take(const RecordArrays& block) override {
    std::vector<const void*> data;
    for (std::size_t i = 0; i < arrays_.size(); ++i)
      data.push_back(block.block(i).data());
    spool_->append(block.rows(), data);
  }

  void complete() override {
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
      const std::string header = npy_header(spool_->rows(), arrays_[i].shape);
      zip_.begin_member(key_of(arrays_[i]) + ".npy", header.size() + spool_->bytes(i));
      zip_.write(header);
      for_each_piece(*spool_, i, [&](const char* data, std::size_t size) {
        zip_.write({data, size});
      });
      zip_.end_member();
    }
    for (const auto& [key, s] : grids_) {
      const std::string_view numbers(reinterpret_cast<const char*>(s.data()),
                                     s.size() * sizeof(double));
      add_member(key + ".npy", npy_header(s.size(), {}) + std::string(numbers));
    }
    add_member("about.json", about());
    zip_.commit();
  }

 private:
  void add_member(const std::string& name, const std::string& data) {
    zip_.begin_member(name, data.size());
    zip_.write(data);
    zip_.end_member();
  }

  std::string about() const {
    nlohmann::ordered_json json = {{"schema", "cprsim-record/1"},
                                   {"scene", scene().name},
                                   {"scene_hash", scene().hash},
                                   {"arrays", nlohmann::ordered_json::object()}};
    for (const RecordArray& array : arrays_) {
      json["arrays"][key_of(array)]["units"] = array.units;
      if (!array.frame.empty()) json["arrays"][key_of(array)]["frame"] = array.frame;
    }
    return json.dump(2) + "\n";
  }

  std::filesystem::path folder_;
  ZipFile zip_;
  std::vector<RecordArray> arrays_;
  std::vector<std::pair<std::string, std::vector<double>>> grids_;
  std::optional<Spool> spool_;
};

}  // namespace

std::unique_ptr<ArrayWriter> make_npz_writer(const std::filesystem::path& path,
                                             const Scene& scene) {
  return std::make_unique<NpzWriter>(path, scene);
}

bool writes_npz() {
  return true;
}

}  // namespace cprsim
