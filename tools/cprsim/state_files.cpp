// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/state_files.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/math/state_text.h"
#include "tools/cprsim/version.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace fs = std::filesystem;

StateFiles::StateFiles(const Scene& scene, const RunOptions& options, const fs::path& folder,
                       Simulation& simulation)
    : scene_(scene), options_(options), folder_(folder) {
  if (options.from.empty()) return;
  from_ = read_checkpoint(options.from);
  if (from_->scene_hash != scene.hash)
    throw StateError(options.from +
                     " is a state of another scene, or of this one before it was changed");
  std::error_code ignored;
  const fs::path home = fs::path(options.from).parent_path();
  if (fs::equivalent(home.empty() ? fs::path(".") : home, folder, ignored))
    throw StateError(
        options.from +
        " lies in the output folder, whose results this run would replace; choose another with -o");
  StateReader reader(from_->simulation);
  simulation.visit(reader);
  reader.finish();
}

void StateFiles::start(Simulation& simulation) {
  if (!from_) simulation.start();
  next_ = simulation.time() + options_.checkpoint_every.value_or(0);
}

std::string StateFiles::start(Outputs& outputs, const Simulation& simulation) const {
  if (!from_) {
    outputs.begin(simulation.now());
    return {};
  }
  outputs.resume(simulation.now());
  try {
    StateReader reader(from_->outputs);
    outputs.visit(reader);
    reader.finish();
  } catch (const StateError&) {
    outputs.resume(simulation.now());
    return "the state knows other recordings and expectations: these begin at its time";
  }
  return {};
}

std::string StateFiles::unavailable(const Simulation& simulation) const {
  if (!options_.checkpoint_every || simulation.has_visitable_state()) return {};
  return "no checkpoints of this scene can be written: it has bodies in free flight, or its steps "
         "are ida's";
}

void StateFiles::step(Simulation& simulation) const {
  if (options_.hash)
    write_to_stdout(fmt::format("{} {} {}\n", simulation.statistics().steps, simulation.time(),
                                state_hash(simulation)));
}

void StateFiles::write_if_due(Simulation& simulation, Outputs& outputs) {
  if (!options_.checkpoint_every || simulation.time() < next_ * (1 - 1e-12)) return;
  write("checkpoint.state", simulation, outputs);
  while (next_ <= simulation.time() * (1 + 1e-12))
    next_ += *options_.checkpoint_every;
}

void StateFiles::write(const std::string& name, Simulation& simulation, Outputs& outputs) {
  if (!simulation.has_visitable_state()) return;
  StateWriter run, observers;
  simulation.visit(run);
  outputs.visit(observers);
  write_file(folder_ / name, to_text({scene_.hash, version().number, simulation.time(), run.text(),
                                      observers.text()}));
  if (std::find(written_.begin(), written_.end(), name) == written_.end()) written_.push_back(name);
}

std::vector<WrittenFile> StateFiles::files() const {
  std::vector<WrittenFile> files;
  for (const std::string& name : written_)
    files.push_back({name, "state", 1});
  return files;
}

std::string state_hash(Simulation& simulation) {
  StateHash hash;
  simulation.visit(hash);
  return fmt::format("{:016x}", hash.value());
}

}  // namespace cprsim
