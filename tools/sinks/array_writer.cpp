// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/array_writer.h"

namespace cprsim {

void ArrayWriter::start(const std::vector<Channel>& channels, const Snapshot& now) {
  arrays_.emplace(scene_, channels, now);
}

void ArrayWriter::write_row(const Snapshot& snapshot, std::span<const double> values) {
  arrays_->append(snapshot, values);
  ++rows_;
  if (arrays_->full()) hand_on();
}

void ArrayWriter::hand_on() {
  if (!open_) open(*arrays_);
  open_ = true;
  if (arrays_->rows() > 0) take(*arrays_);
  arrays_->clear();
}

void ArrayWriter::finish() {
  if (arrays_) hand_on();
  complete();
}

}  // namespace cprsim
