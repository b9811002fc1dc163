// SPDX-License-Identifier: BSD-3-Clause
#include "render/film_recorder.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "render/bounded_queue.h"
#include "render/color_range.h"
#include "render/film.h"
#include "render/trace.h"

namespace cprsim {

namespace {

constexpr std::size_t kWaiting =
    4;  // frames in each queue: enough that no thread waits for a hiccup

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Adds the time it lives to a sum.
class Timer {
 public:
  explicit Timer(std::atomic<double>& sum) : sum_(sum) {}

  ~Timer() { sum_ = sum_ + seconds_since(start_); }

 private:
  std::atomic<double>& sum_;
  Clock::time_point start_ = Clock::now();
};

/// One frame to be drawn, and what the traces have gained since the frame before.
struct Shot {
  Snapshot now;
  std::vector<std::vector<TraceLine::Point>> gained;
};

}  // namespace

struct FilmRecorder::Work {
  Work(const Scene& described, const VideoSpec& wanted, const RenderOptions& drawn)
      : scene(described), video(wanted), options(drawn) {}

  void draw_all(std::promise<std::string> ready, const std::string& file);
  void draw(Renderer& renderer);
  void encode_all();
  void follow(const Snapshot& now);
  void shoot(Snapshot now);
  void fail(std::exception_ptr why);
  void check();
  void stop();

  bool camera_given() const {
    return video.camera >= 0 && static_cast<std::size_t>(video.camera) < scene.cameras.size();
  }

  double instant(long k) const { return static_cast<double>(k) * video.speed / video.fps; }

  const Scene& scene;
  VideoSpec video;
  RenderOptions options;
  CameraSpec camera;
  Film film;
  BoundedQueue<Shot> shots{kWaiting};
  BoundedQueue<Image> images{kWaiting};
  std::thread drawing, encoding;

  // the caller's thread
  long next = -1;  ///< number of the next frame; -1: none taken yet
  int taken = 0;
  std::vector<Channel> traced;
  std::vector<double> trace_seconds;
  std::vector<std::vector<TraceLine::Point>> gained;

  std::mutex mutex;
  std::exception_ptr error;
  std::string device;
  std::atomic<double> drawing_time{0}, encoding_time{0}, waiting_time{0};
};

void FilmRecorder::Work::fail(std::exception_ptr why) {
  {
    const std::lock_guard lock(mutex);
    if (!error) error = why;
  }
  shots.abandon();
  images.abandon();
}

void FilmRecorder::Work::check() {
  const std::lock_guard lock(mutex);
  if (error) std::rethrow_exception(error);
}

void FilmRecorder::Work::stop() {
  shots.abandon();
  images.abandon();
  if (drawing.joinable()) drawing.join();
  if (encoding.joinable()) encoding.join();
}

/// The drawing thread: it makes the renderer itself, because a GL context belongs to one thread.
void FilmRecorder::Work::draw_all(std::promise<std::string> ready, const std::string& file) {
  std::string why_not;
  std::unique_ptr<Renderer> renderer;
  try {
    renderer = Renderer::create(scene, camera.width, camera.height, options, why_not);
    if (renderer) film.open(file, camera.width, camera.height, video.fps);
  } catch (const std::exception& problem) {
    why_not = problem.what();
    renderer.reset();
  }
  if (renderer) device = renderer->device();
  ready.set_value(renderer ? "" : why_not);
  if (!renderer) return;
  try {
    draw(*renderer);
    images.close();
  } catch (...) {
    fail(std::current_exception());
  }
}

void FilmRecorder::Work::draw(Renderer& renderer) {
  FrameDecor decor = decor_of(scene, video);
  decor.traces.resize(traced.size());
  SteadyRange range(scene, video.color_by);
  for (int frame = 0;; ++frame) {
    std::optional<Shot> shot = shots.pop();
    if (!shot) return;
    const Timer timer(drawing_time);
    decor.film_time = frame / video.fps;
    decor.color_range =
        video.color_range ? *video.color_range : range.next(shot->now, decor.film_time);
    for (std::size_t i = 0; i < decor.traces.size(); ++i) {
      TraceLine& trace = decor.traces[i];
      trace.seconds = trace_seconds[i];
      trace.points.insert(trace.points.end(), shot->gained[i].begin(), shot->gained[i].end());
      const auto faded = [&](const TraceLine::Point& point) {
        return trace.seconds > 0 && point.time < shot->now.time - trace.seconds;
      };
      std::erase_if(trace.points, faded);
    }
    if (frame == 0 && !camera_given()) camera = camera_or_default(scene, -1, shot->now);
    if (!images.push(renderer.draw(shot->now, camera, decor))) return;
  }
}

void FilmRecorder::Work::encode_all() {
  try {
    while (std::optional<Image> image = images.pop()) {
      const Timer timer(encoding_time);
      film.add(*image);
    }
  } catch (...) {
    fail(std::current_exception());
  }
}

void FilmRecorder::Work::follow(const Snapshot& now) {
  for (std::size_t i = 0; i < traced.size(); ++i) {
    const std::optional<Vec3> at = point_now(scene, now, traced[i]);
    if (!at || (!gained[i].empty() && gained[i].back().time >= now.time)) continue;
    gained[i].push_back({*at, now.time});
  }
}

void FilmRecorder::Work::shoot(Snapshot now) {
  follow(now);
  Shot shot{std::move(now), std::move(gained)};
  gained.assign(traced.size(), {});
  const Timer timer(waiting_time);
  shots.push(std::move(shot));
  ++taken;
}

FilmRecorder::FilmRecorder(const Scene& scene, const VideoSpec& video, const std::string& file,
                           const RenderOptions& options)
    : work_(std::make_unique<Work>(scene, video, options)) {
  Work& work = *work_;
  if (!(video.fps > 0) || !(video.speed > 0)) {
    throw std::runtime_error(file + ": a film needs a positive frame rate and speed");
  }
  const std::string why_no_film = film_unavailable();
  if (!why_no_film.empty()) throw std::runtime_error(file + ": cannot be filmed: " + why_no_film);
  if (work.camera_given()) work.camera = scene.cameras[static_cast<std::size_t>(video.camera)];
  for (const TraceSpec& trace : video.traces) {
    if (const std::optional<Channel> point = find_point(scene, trace.channel)) {
      work.traced.push_back(*point);
      work.trace_seconds.push_back(trace.seconds);
    }
  }
  work.gained.resize(work.traced.size());
  std::promise<std::string> ready;
  std::future<std::string> why_not = ready.get_future();
  work.drawing = std::thread(&Work::draw_all, &work, std::move(ready), file);
  const std::string reason = why_not.get();
  if (!reason.empty()) {
    work.stop();
    throw std::runtime_error(file + ": cannot be filmed: " + reason);
  }
  work.encoding = std::thread(&Work::encode_all, &work);
}

FilmRecorder::~FilmRecorder() {
  work_->stop();
}

void FilmRecorder::observe(const Snapshot& before, const Snapshot& now) {
  Work& work = *work_;
  work.check();
  // a time that a sum of steps has missed by rounding still counts as reached
  const double slack = 1e-9 * std::max(1.0, std::abs(now.time));
  if (work.next < 0) {
    work.next =
        static_cast<long>(std::ceil((before.time - slack) * work.video.fps / work.video.speed));
    if (work.instant(work.next) <= before.time + slack) {
      work.shoot(before);
      ++work.next;
    } else {
      work.follow(before);
    }
  }
  while (work.instant(work.next) <= now.time + slack) {
    const double t = std::clamp(work.instant(work.next), before.time, now.time);
    if (t >= now.time) {
      if (now.time <= before.time) break;
      work.shoot(now);
    } else {
      work.shoot(interpolate(before, now, t));
    }
    ++work.next;
  }
  work.follow(now);
}

void FilmRecorder::finish() {
  Work& work = *work_;
  const Timer timer(work.waiting_time);
  work.shots.close();
  if (work.drawing.joinable()) work.drawing.join();
  if (work.encoding.joinable()) work.encoding.join();
  work.check();
  work.film.close();
}

int FilmRecorder::frames() const {
  return work_->taken;
}

double FilmRecorder::seconds_drawing() const {
  return work_->drawing_time;
}

double FilmRecorder::seconds_encoding() const {
  return work_->encoding_time;
}

double FilmRecorder::seconds_waiting() const {
  return work_->waiting_time;
}

std::string FilmRecorder::device() const {
  return work_->device;
}

}  // namespace cprsim
