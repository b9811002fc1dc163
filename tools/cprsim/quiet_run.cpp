// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/quiet_run.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <exception>
#include <mutex>
#include <thread>

#include "collision/bullet_world.h"
#include "tools/cprsim/build_simulation.h"

namespace cprsim {

namespace {

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Adds up the processor time between its making and its end.
class CpuTime {
 public:
  explicit CpuTime(double& sum) : sum_(sum), begin_(thread_seconds()) {}

  ~CpuTime() { sum_ += thread_seconds() - begin_; }

  CpuTime(const CpuTime&) = delete;
  CpuTime& operator=(const CpuTime&) = delete;

 private:
  double& sum_;
  double begin_;
};

std::mutex& bullet_turn() {
  static std::mutex turn;
  return turn;
}

}  // namespace

QuietRun run_quietly(const Scene& scene, const Onlooker& onlooker,
                     const std::function<bool()>& stop) {
  std::unique_lock<std::mutex> turn(bullet_turn(), std::defer_lock);
  if (!find_free_bodies(scene).empty()) turn.lock();
  QuietRun run;
  std::unique_ptr<Simulation> simulation;
  {
    const CpuTime time(run.cpu_seconds);
    simulation = build_simulation(scene);
    simulation->start();
  }
  if (simulation->status() != RunStatus::kFailed) onlooker.begin(simulation->now());
  while (simulation->status() == RunStatus::kRunning && !stop()) {
    {
      const CpuTime time(run.cpu_seconds);
      simulation->advance();
    }
    if (simulation->status() != RunStatus::kFailed)
      onlooker.step(simulation->before(), simulation->now());
  }
  run.status = simulation->status();
  run.failure = simulation->failure();
  run.time = simulation->time();
  run.end_time = simulation->end_time();
  run.statistics = simulation->statistics();
  run.facts = simulation->facts();
  return run;
}

void on_threads(std::size_t count, int jobs, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::mutex one_at_a_time;
  std::exception_ptr complaint;
  const auto labour = [&] {
    try {
      for (std::size_t i = next++; i < count && !failed; i = next++)
        work(i);
    } catch (...) {
      const std::lock_guard lock(one_at_a_time);
      if (!complaint) complaint = std::current_exception();
      failed = true;
    }
  };
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t wanted = jobs > 0 ? static_cast<std::size_t>(jobs) : cores;
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < std::min(wanted, count); ++i)
    threads.emplace_back(labour);
  labour();
  for (std::thread& thread : threads)
    thread.join();
  if (complaint) std::rethrow_exception(complaint);
}

}  // namespace cprsim
