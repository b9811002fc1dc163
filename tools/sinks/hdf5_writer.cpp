// SPDX-License-Identifier: BSD-3-Clause
// Layout: /time (t); /channels/<name> (t); /rods/<name>/{length (t), position (t, node, 3),
// quaternion (t, node, 4), strain (t, node, 6), n, m (t, node, 3), s (node)}. Attributes say units
// and frame. After every block the file on disk is one that can be read.
#include "tools/hdf5/hdf5_output.h"
#include "tools/sinks/array_writer.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

Hdf5Attributes attributes_of(const RecordArray& array) {
  Hdf5Attributes attributes{{"units", array.units}};
  if (!array.frame.empty()) attributes.emplace_back("frame", array.frame);
  return attributes;
}

class Hdf5Writer : public ArrayWriter {
 public:
  Hdf5Writer(const std::filesystem::path& path, const Scene& scene)
      : ArrayWriter(scene), path_(path), part_(part_of(path)) {
    or_complain([&] {
      file_.emplace(part_);
      file_->annotate(
          {{"schema", "cprsim-record/1"}, {"scene", scene.name}, {"scene_hash", scene.hash}});
    });
  }

  std::string extension() const override { return ".h5"; }

  std::string kind() const override { return "hdf5"; }

 protected:
  void open(const RecordArrays& arrays) override {
    or_complain([&] {
      for (const RecordArray& array : arrays.list()) {
        const std::string path = (array.group.empty() ? "" : array.group + "/") + array.name;
        file_->create(path, array.shape, arrays.block_rows(), attributes_of(array));
      }
      for (std::size_t r = 0; r < arrays.rods(); ++r)
        file_->write(rod_group(scene().rods[r]) + "/s", arrays.grid(r), {{"units", "1"}});
      file_->flush();
    });
  }

  void take(const RecordArrays& block) override {
    or_complain([&] {
      for (std::size_t i = 0; i < block.list().size(); ++i)
        file_->append(i, block.rows(), block.block(i));
      file_->flush();
    });
  }

  void complete() override {
    or_complain([&] { file_->close(); });
    commit_part(path_);
  }

 private:
  template <class Act>
  void or_complain(Act&& act) {
    try {
      act();
    } catch (const Hdf5Error& error) {
      throw OutputError("cannot write " + part_.string() + ": " + error.what());
    }
  }

  std::filesystem::path path_, part_;
  std::optional<Hdf5Output> file_;
};

}  // namespace

std::unique_ptr<ArrayWriter> make_hdf5_writer(const std::filesystem::path& path,
                                              const Scene& scene) {
  return std::make_unique<Hdf5Writer>(path, scene);
}

std::string hdf5_version() {
  return hdf5_library_version();
}

}  // namespace cprsim
