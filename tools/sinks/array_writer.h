// SPDX-License-Identifier: BSD-3-Clause
// Recordings as arrays, in whichever file format: blocks of rows are handed on as they fill up.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "engine/math/archive.h"
#include "tools/sinks/record_arrays.h"

namespace cprsim {

class ArrayWriter {
 public:
  explicit ArrayWriter(const Scene& scene) : scene_(scene) {}

  virtual ~ArrayWriter() = default;
  ArrayWriter(const ArrayWriter&) = delete;
  ArrayWriter& operator=(const ArrayWriter&) = delete;

  /// Before the first row; again if a state turns out to be of other recordings.
  /// @throws OutputError, as do all members
  void start(const std::vector<Channel>& channels, const Snapshot& now);
  void write_row(const Snapshot& snapshot, std::span<const double> values);

  /// What must be known to go on as if nothing had happened.
  void visit(Archive& archive) { arrays_->visit(archive); }

  void finish();

  long rows() const { return rows_; }

  virtual std::string extension() const = 0;  ///< ".h5"
  virtual std::string kind() const = 0;       ///< for run.json: hdf5

 protected:
  const Scene& scene() const { return scene_; }

  /// Before the first block.
  virtual void open(const RecordArrays& arrays) = 0;
  virtual void take(const RecordArrays& block) = 0;
  virtual void complete() = 0;

 private:
  void hand_on();

  const Scene& scene_;
  std::optional<RecordArrays> arrays_;
  bool open_ = false;
  long rows_ = 0;
};

/// Creates path.part. @throws OutputError also if this program was built without the library
std::unique_ptr<ArrayWriter> make_hdf5_writer(const std::filesystem::path& path,
                                              const Scene& scene);

std::unique_ptr<ArrayWriter> make_npz_writer(const std::filesystem::path& path, const Scene& scene);

/// Which library reads and writes HDF5, "1.10.8"; empty: this program was built without.
std::string hdf5_version();

/// Whether this program was built with what NumPy archives need.
bool writes_npz();

}  // namespace cprsim
