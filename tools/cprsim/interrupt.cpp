// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace cprsim {

namespace {

// a signal handler can only talk to the program through a variable like this one
volatile std::sig_atomic_t received = 0;

extern "C" void on_signal(int signal) {
  if (received != 0) _exit(128 + signal);
  received = signal;
}

}  // namespace

void watch_signals() {
  struct sigaction action {};

  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
  sigaction(SIGXFSZ, &action, nullptr);
}

int stop_signal() {
  return received;
}

}  // namespace cprsim
