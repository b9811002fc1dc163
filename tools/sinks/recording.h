// SPDX-License-Identifier: BSD-3-Clause
// One <cprsim:record> of a scene: reads its channels at exactly k/rate and feeds its writers.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "engine/model/scene.h"
#include "engine/run/observe.h"
#include "tools/sinks/array_writer.h"
#include "tools/sinks/csv.h"
#include "tools/sinks/sink.h"
#include "tools/sinks/vtk.h"

namespace cprsim {

class Recording : public Sink {
 public:
  Recording(const Scene& scene, const RecordSpec& spec, const std::filesystem::path& folder);

  void begin(const Snapshot& start) override;
  void resume(const Snapshot& now) override;
  void visit(Archive& archive) override;
  void step(const Snapshot& before, const Snapshot& now) override;
  void finish() override;
  std::vector<WrittenFile> files() const override;

 private:
  void record(const Snapshot& snapshot);

  const Scene& scene_;
  const RecordSpec& spec_;
  ChannelReader reader_;
  std::optional<CsvWriter> csv_;
  std::vector<std::unique_ptr<ArrayWriter>> arrays_;  ///< HDF5, NPZ
  std::optional<VtkWriter> vtk_;
  long records_ = 0;
};

}  // namespace cprsim
