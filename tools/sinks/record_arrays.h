// SPDX-License-Identifier: BSD-3-Clause
// A recording as arrays over time, for HDF5 and NumPy: the instants, a number per channel, and
// along every rod its shape and what goes through it, and where the links are. Rows are kept until
// a block is full, which a writer then takes and forgets, so that memory does not grow with the
// run.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/math/archive.h"
#include "engine/math/types.h"
#include "engine/model/scene.h"
#include "engine/run/snapshot.h"

namespace cprsim {

struct RecordArray {
  std::string group;  ///< "", channels, rods/<name>, links/<name>
  std::string name;
  std::vector<std::size_t> shape;  ///< of a row; empty: one number
  std::string units;
  std::string frame;  ///< axes of the components: world, section, joint; empty: has none

  /// Numbers in a row.
  std::size_t width() const;
};

class RecordArrays {
 public:
  /// Rods are seen at the points that they have in `first`, at all later instants too.
  RecordArrays(const Scene& scene, const std::vector<Channel>& channels, const Snapshot& first);

  const std::vector<RecordArray>& list() const { return list_; }

  /// Fractions of the length at which a rod is seen.
  const std::vector<double>& grid(std::size_t rod) const { return grids_[rod]; }

  std::size_t rods() const { return grids_.size(); }

  void append(const Snapshot& snapshot, std::span<const double> values);

  std::size_t rows() const { return rows_; }  ///< in the block

  std::size_t block_rows() const { return block_rows_; }

  bool full() const { return rows_ == block_rows_; }

  /// rows() times width() numbers of one array, row after row.
  const std::vector<double>& block(std::size_t array) const { return blocks_[array]; }

  void clear();

  void visit(Archive& archive);

 private:
  void add(RecordArray array);
  void append_rod(const RodSample& rod, std::size_t index);
  void append_link(const BodySample& link, std::size_t index);

  std::vector<RecordArray> list_;
  std::vector<std::vector<double>> blocks_;
  std::vector<std::vector<double>> grids_;
  std::vector<std::vector<Vec4>> last_quaternions_;  ///< x y z w, per rod and point; then of links
  std::vector<std::size_t> links_;                   ///< that may move: indices into Scene::bodies
  std::size_t first_rod_array_ = 0, rows_ = 0, block_rows_ = 0;
};

/// The group of a rod's arrays, or of a link's.
std::string rod_group(const RodSpec& rod);
std::string link_group(const BodySpec& link);

}  // namespace cprsim
