// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/asked_run.h"

namespace cprsim {

namespace {

Onlooker both(const Onlooker& one, const Onlooker& other) {
  return {[=](const Snapshot& start) {
            one.begin(start);
            other.begin(start);
          },
          [=](const Snapshot& before, const Snapshot& now) {
            one.step(before, now);
            other.step(before, now);
          }};
}

}  // namespace

AskedRun run_as_asked(const Scene& scene, const std::function<Onlooker()>& looking,
                      const std::function<bool()>& stop) {
  AskedRun result;
  AccuracyControl control(scene);
  if (control.asked()) control.fly_pilots(stop);
  for (bool again = true; again;) {
    const Onlooker eye = control.asked() ? both(looking(), onlooker(control.track())) : looking();
    result.last = run_quietly(control.scene(), eye, stop);
    result.cpu_seconds += result.last.cpu_seconds;
    const long work = result.last.statistics.section_evaluations;
    again = control.asked() && (result.last.status == RunStatus::kDone     ? control.refine(work)
                                : result.last.status == RunStatus::kFailed ? control.retry(work)
                                                                           : false);
  }
  result.scene = control.scene();
  result.accuracy = control.report();
  result.cpu_seconds += result.accuracy.pilots_cpu_seconds;
  result.section_evaluations =
      result.accuracy.evaluations + result.last.statistics.section_evaluations;
  return result;
}

}  // namespace cprsim
