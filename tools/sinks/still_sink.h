// SPDX-License-Identifier: BSD-3-Clause
// One picture of a run at a given instant, or of its last state, as the scene's first video shows
// it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/sinks/sink.h"
#include "tools/sinks/view.h"

namespace cprsim {

class StillSink : public Sink {
 public:
  /// @param time empty: the last state
  StillSink(const Scene& scene, std::optional<double> time, std::filesystem::path file,
            std::string name);

  void begin(const Snapshot& start) override;
  void resume(const Snapshot& now) override;
  void step(const Snapshot& before, const Snapshot& now) override;
  void finish() override;
  std::vector<WrittenFile> files() const override;

  bool draws() const override { return true; }

 private:
  void draw(const Snapshot& snapshot);

  const Scene& scene_;
  std::optional<double> time_;
  std::filesystem::path file_;
  std::string name_;
  View view_;
  Snapshot last_;
  bool begun_ = false, drawn_ = false, earlier_ = false;
};

}  // namespace cprsim
