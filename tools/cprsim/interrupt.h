// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C and SIGTERM: the first asks the run to stop after its step, the second stops the process
// at once.
#pragma once

namespace cprsim {

/// Installs the handlers, also of the end that lack of memory or a bug may bring, and ignores
/// SIGPIPE and SIGXFSZ so that a closed pipe and a file that may not grow are errors of write().
void watch_signals();

/// The signal that asked to stop, or 0.
int stop_signal();

}  // namespace cprsim
