// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/progress.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

constexpr int kBarWidth = 14;
constexpr double kRedrawSeconds = 0.2;

}  // namespace

std::string progress_line(const std::string& name, double time, double end_time, double wall,
                          double iterations_per_step) {
  const double fraction = end_time > 0 ? std::clamp(time / end_time, 0.0, 1.0) : 1.0;
  const auto full = static_cast<std::size_t>(std::lround(fraction * kBarWidth));
  const std::string bar = std::string(full, '#') + std::string(kBarWidth - full, '-');
  std::string line = fmt::format("{}  [{}]  {:.2f}/{:.2f} s", name, bar, time, end_time);
  if (wall > 0 && time > 0) {
    const long left = std::lround(wall * (1 - fraction) / std::max(fraction, 1e-6));
    line += fmt::format("  {:.2g}x real time  {:.1f} it/step  ETA {}:{:02}", time / wall,
                        iterations_per_step, left / 60, left % 60);
  }
  return line;
}

Progress::Progress(ProgressStyle style, std::string name, double end_time)
    : style_(style), name_(std::move(name)), end_time_(end_time), began_(Clock::now()) {}

void Progress::update(double time, long steps, long iterations) {
  if (style_ == ProgressStyle::kNone || end_time_ <= 0) return;
  const Clock::time_point now = Clock::now();
  const auto seconds = [&](Clock::time_point since) {
    return std::chrono::duration<double>(now - since).count();
  };
  const double per_step =
      steps > 0 ? static_cast<double>(iterations) / static_cast<double>(steps) : 0;
  if (style_ == ProgressStyle::kBar) {
    if (on_screen_ && seconds(drawn_) < kRedrawSeconds) return;
    write_to_stderr(fmt::format("\r{}\033[K",
                                progress_line(name_, time, end_time_, seconds(began_), per_step)));
    drawn_ = now;
    on_screen_ = true;
    return;
  }
  const int tenths = static_cast<int>(std::floor(10 * time / end_time_ + 1e-9));
  if (tenths <= tenths_) return;
  tenths_ = tenths;
  write_to_stderr(fmt::format("{}: {:3} %  {:.3f} of {:.3f} s, {:.1f} s wall\n", name_, 10 * tenths,
                              time, end_time_, seconds(began_)));
}

void Progress::finish() {
  if (on_screen_) write_to_stderr("\r\033[K");
  on_screen_ = false;
}

CountProgress::CountProgress(ProgressStyle style, std::string name, std::size_t before,
                             std::size_t total)
    : style_(style),
      name_(std::move(name)),
      before_(before),
      total_(total),
      began_(Clock::now()),
      tenths_(total > 0 ? 10 * before / total : 0) {}

void CountProgress::update(std::size_t done) {
  if (style_ == ProgressStyle::kNone || total_ == 0) return;
  const Clock::time_point now = Clock::now();
  const auto seconds = [&](Clock::time_point since) {
    return std::chrono::duration<double>(now - since).count();
  };
  if (style_ == ProgressStyle::kBar) {
    if (on_screen_ && seconds(drawn_) < kRedrawSeconds) return;
    const double fraction = static_cast<double>(done) / static_cast<double>(total_);
    const auto full = static_cast<std::size_t>(std::lround(fraction * kBarWidth));
    std::string line = fmt::format("{}  [{}{}]  {}/{}", name_, std::string(full, '#'),
                                   std::string(kBarWidth - full, '-'), done, total_);
    if (done > before_) {
      const double each = seconds(began_) / static_cast<double>(done - before_);
      const long left = std::lround(each * static_cast<double>(total_ - done));
      line += fmt::format("  ETA {}:{:02}", left / 60, left % 60);
    }
    write_to_stderr(fmt::format("\r{}\033[K", line));
    drawn_ = now;
    on_screen_ = true;
    return;
  }
  const std::size_t tenths = 10 * done / total_;
  if (tenths <= tenths_) return;
  tenths_ = tenths;
  write_to_stderr(fmt::format("{}: {:3} %  {} of {}, {:.1f} s wall\n", name_, 10 * tenths, done,
                              total_, seconds(began_)));
}

void CountProgress::finish() {
  if (on_screen_) write_to_stderr("\r\033[K");
  on_screen_ = false;
}

}  // namespace cprsim
