// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/recording.h"

#include <cmath>
#include <exception>

namespace cprsim {

namespace {

/// Steps add up to k/rate only up to rounding; a record this close (in periods) to a step's end is
/// its.
constexpr double kRoundOff = 1e-9;

}  // namespace

Recording::Recording(const Scene& scene, const RecordSpec& spec,
                     const std::filesystem::path& folder)
    : scene_(scene), spec_(spec), reader_(scene, spec.channels) {
  if (spec.csv) csv_.emplace(folder / (spec.prefix + ".csv"), spec.channels);
  if (spec.hdf5) arrays_.push_back(make_hdf5_writer(folder / (spec.prefix + ".h5"), scene));
  if (spec.npz) arrays_.push_back(make_npz_writer(folder / (spec.prefix + ".npz"), scene));
  if (spec.vtk_every > 0) vtk_.emplace(folder, spec.prefix);
}

void Recording::begin(const Snapshot& start) {
  for (const auto& arrays : arrays_)
    arrays->start(spec_.channels, start);
  record(start);
}

void Recording::resume(const Snapshot& now) {
  for (const auto& arrays : arrays_)
    arrays->start(spec_.channels, now);
  if (spec_.rate > 0)
    records_ = static_cast<long>(std::floor(now.time * spec_.rate + kRoundOff)) + 1;
}

void Recording::visit(Archive& archive) {
  archive(records_);
  reader_.visit(archive);
  for (const auto& arrays : arrays_)
    arrays->visit(archive);
}

void Recording::step(const Snapshot& before, const Snapshot& now) {
  if (spec_.rate <= 0) {
    record(now);
    return;
  }
  while (static_cast<double>(records_) <= now.time * spec_.rate + kRoundOff) {
    const double time = static_cast<double>(records_) / spec_.rate;
    Snapshot snapshot = interpolate(before, now, time);
    snapshot.time = time;
    record(snapshot);
  }
}

void Recording::record(const Snapshot& snapshot) {
  if (csv_ || !arrays_.empty()) {
    const std::vector<double>& values = reader_.read(snapshot);
    if (csv_) csv_->write_row(snapshot.time, values);
    for (const auto& arrays : arrays_)
      arrays->write_row(snapshot, values);
  }
  if (vtk_ && records_ % spec_.vtk_every == 0) vtk_->write_frame(scene_, snapshot);
  ++records_;
}

void Recording::finish() {
  // each is completed even if another cannot be
  std::exception_ptr complaint;
  const auto complete = [&](auto& writer) {
    try {
      writer.finish();
    } catch (...) {
      if (!complaint) complaint = std::current_exception();
    }
  };
  if (csv_) complete(*csv_);
  for (const auto& arrays : arrays_)
    complete(*arrays);
  if (vtk_) complete(*vtk_);
  if (complaint) std::rethrow_exception(complaint);
}

std::vector<WrittenFile> Recording::files() const {
  std::vector<WrittenFile> files;
  if (csv_) files.push_back({spec_.prefix + ".csv", "csv", csv_->rows()});
  for (const auto& arrays : arrays_)
    files.push_back({spec_.prefix + arrays->extension(), arrays->kind(), arrays->rows()});
  if (vtk_) {
    files.push_back({spec_.prefix + ".pvd", "vtk", vtk_->frames()});
    if (vtk_->has_contacts())
      files.push_back({spec_.prefix + "_contacts.pvd", "vtk", vtk_->frames()});
    files.push_back({spec_.prefix + "_vtk/", "vtk", vtk_->frames()});
  }
  return files;
}

}  // namespace cprsim
