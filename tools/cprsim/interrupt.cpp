// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/version.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

// a signal handler can only talk to the program through a variable like this one
volatile std::sig_atomic_t received = 0;

extern "C" void on_signal(int signal) {
  if (received != 0) _exit(128 + signal);
  received = signal;
}

void say(const char* text) {
  write_to_stderr({text, std::strlen(text)});
}

// Destructors of the JSON library allocate: where there is no memory they end here, not in main().
[[noreturn]] void on_terminate() {
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    say("cprsim: error: out of memory\n");
    _exit(kExitEnvironment);
  } catch (...) {
    std::abort();
  }
  std::abort();
}

extern "C" void on_abort(int) {
  say("cprsim: internal error: a bug in cprsim ");
  say(version().number);
  say(" (");
  say(version().revision);
  say("). Please report it with the scene and the command line.\n");
  _exit(kExitInternalError);
}

}  // namespace

void watch_signals() {
  std::set_terminate(on_terminate);

  struct sigaction action {};

  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = on_abort;
  sigaction(SIGABRT, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
  sigaction(SIGXFSZ, &action, nullptr);
}

int stop_signal() {
  return received;
}

}  // namespace cprsim
