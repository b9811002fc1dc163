// SPDX-License-Identifier: BSD-3-Clause
// Pictures of six rods at 1280 x 720: drawing alone, and the whole way into a film.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "render/film_recorder.h"
#include "render/renderer.h"
#include "tests/bench/reference_kernel.h"
#include "tests/support/six_rods.h"

namespace cprsim {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kFrames = 120;
constexpr double kFramesPerSecond = 30;

std::vector<Snapshot> four_seconds() {
  std::vector<Snapshot> run;
  for (int k = 0; k <= kFrames; ++k)
    run.push_back(six_rods_at(k / kFramesPerSecond));
  return run;
}

Scene scene_in_size(double orbit_rate) {
  Scene scene = six_rods_scene();
  scene.cameras[0].width = kWidth;
  scene.cameras[0].height = kHeight;
  scene.cameras[0].orbit_rate = orbit_rate;
  return scene;
}

void draw_frame(benchmark::State& state, double orbit_rate) {
  const Scene scene = scene_in_size(orbit_rate);
  std::string why_not;
  const std::unique_ptr<Renderer> renderer = Renderer::create(scene, kWidth, kHeight, {}, why_not);
  if (!renderer) {
    state.SkipWithError(why_not.c_str());
    return;
  }
  const std::vector<Snapshot> run = four_seconds();
  FrameDecor decor;
  decor.scene_name = scene.name;
  decor.color_by = ColorBy::kBendingMoment;
  // what is made only once: programs, and the background that stays
  for (std::size_t k = 0; k < 10; ++k)
    renderer->draw(run[k], scene.cameras[0], decor);
  std::size_t k = 0;
  for (auto _ : state) {
    k = (k + 1) % run.size();
    decor.film_time = run[k].time;
    benchmark::DoNotOptimize(renderer->draw(run[k], scene.cameras[0], decor));
  }
  state.SetLabel(renderer->device());
  state.counters["frames/s"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  count_in_rk4_steps(state);
}

BENCHMARK_CAPTURE(draw_frame, fixed_camera, 0.0)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(60)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(draw_frame, orbiting_camera, 0.15)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(60)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// Draws and encodes in threads of its own; processor time is that of drawing, the encoder being
// another process.
void film_of_four_seconds(benchmark::State& state) {
  const Scene scene = scene_in_size(0);
  const std::vector<Snapshot> run = four_seconds();
  const std::string file =
      (std::filesystem::temp_directory_path() / "cprsim_bench_film.mp4").string();
  double drawing = 0, encoding = 0;
  try {
    for (auto _ : state) {
      FilmRecorder recorder(scene, scene.videos[0], file);
      for (std::size_t k = 1; k < run.size(); ++k)
        recorder.observe(run[k - 1], run[k]);
      recorder.finish();
      drawing += recorder.seconds_drawing();
      encoding += recorder.seconds_encoding();
    }
  } catch (const std::exception& error) {
    state.SkipWithError(error.what());
    return;
  }
  std::filesystem::remove(file);
  using benchmark::Counter;
  state.counters["frames/s"] = Counter(kFrames + 1, Counter::kIsIterationInvariantRate);
  state.counters["drawing_s"] = Counter(drawing, Counter::kAvgIterations);
  state.counters["encoding_s"] = Counter(encoding, Counter::kAvgIterations);
  count_in_rk4_steps(state);
}

BENCHMARK(film_of_four_seconds)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace cprsim
