// SPDX-License-Identifier: BSD-3-Clause
// All that looks on while a run goes: recordings, films, stills, expectations, the extremes.
#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/solve/phase_clock.h"
#include "tools/cprsim/console.h"
#include "tools/cprsim/expectations.h"
#include "tools/cprsim/extremes.h"
#include "tools/cprsim/run_options.h"
#include "tools/sinks/sink.h"

namespace cprsim {

/// What disk, pipe or graphics have to say.
struct OutputComplaint {
  OutputComplaint() = default;
  explicit OutputComplaint(const std::runtime_error& error);

  std::string text;  ///< empty: nothing
  const char* code = "";
};

class Outputs {
 public:
  /// Opens what scene and options ask for. A film that cannot be made is left out with a warning,
  /// unless
  /// --video asked for it. @throws OutputError, std::runtime_error
  Outputs(const Scene& scene, const RunOptions& options, const std::filesystem::path& folder,
          const Console& console);

  void begin(const Snapshot& start);
  /// In its place: the run goes on from here.
  void resume(const Snapshot& now);
  /// What expectations and recordings have seen. @throws StateError if those of the scene and of
  /// the state are others
  void visit(Archive& archive);
  void step(const Snapshot& before, const Snapshot& now);
  /// Completes every file that can be completed. @return the first complaint
  OutputComplaint finish();

  /// From here on the clock, unless it is null, measures where the time goes.
  void measure(PhaseClock* clock) { clock_ = clock; }

  std::vector<WrittenFile> files() const;

  const Expectations& expectations() const { return expectations_; }

  const Extremes& extremes() const { return extremes_; }

  const std::string& drawn_by() const { return drawn_by_; }  ///< empty: no film

  double seconds() const { return seconds_; }  ///< wall time spent here

 private:
  void add_recordings(const Scene& scene);
  void add_films(const Scene& scene, const RunOptions& options, const Console& console);
  /// @param insist a film or an error; otherwise PNG frames where there is no encoder
  void add_film(const Scene& scene, const VideoSpec& video, const std::filesystem::path& file,
                bool insist, const Console& console);
  void add_stills(const Scene& scene, const RunOptions& options);
  /// A file that the scene names: it may not leave the folder, nor be named twice.
  std::filesystem::path claim(const std::string& name);

  template <typename Act>
  void each(const Act& act);

  std::filesystem::path folder_;
  std::vector<std::string> claimed_;
  std::vector<VideoSpec> videos_;  ///< films refer to these
  std::vector<std::unique_ptr<Sink>> sinks_;
  Expectations expectations_;
  Extremes extremes_;
  std::string drawn_by_;
  double seconds_ = 0;
  PhaseClock* clock_ = nullptr;
};

}  // namespace cprsim
