// SPDX-License-Identifier: BSD-3-Clause
// Loaded before the C library (LD_PRELOAD): lets one call fail. CPRSIM_FAULT=write:7:28 makes the
// seventh write() (or pwrite()) answer ENOSPC; write:7:28:on also every later one. Calls: malloc,
// open, write, fsync, rename. Writes to the standard streams do not count.
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" void* __libc_malloc(std::size_t size);

namespace {

struct Fault {
  char call[16] = "";
  long nth = 0;
  int error = 0;
  bool on = false;
};

Fault read_fault() {
  Fault fault;
  const char* text = std::getenv("CPRSIM_FAULT");
  if (text == nullptr) return fault;
  char rest[8] = "";
  std::sscanf(text, "%15[a-z]:%ld:%d:%7s", fault.call, &fault.nth, &fault.error, rest);
  fault.on = std::strcmp(rest, "on") == 0;
  return fault;
}

/// The program's first act in main() is to open /dev/null: before, loading and static initialisers
/// belong to the system.
std::atomic<bool> in_main{false};

bool fails(const char* call) {
  if (!in_main) return false;
  // read without allocation, by the first call of the first thread
  static const Fault fault = read_fault();
  static std::atomic<long> calls{0};
  if (std::strcmp(fault.call, call) != 0) return false;
  const long k = ++calls;
  if (k != fault.nth && !(fault.on && k > fault.nth)) return false;
  errno = fault.error;
  return true;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) {
  return fails("malloc") ? nullptr : __libc_malloc(size);
}

int open(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const unsigned mode = (flags & O_CREAT) != 0 ? va_arg(arguments, unsigned) : 0;
  va_end(arguments);
  if (std::strcmp(path, "/dev/null") == 0) in_main = true;
  if ((flags & O_CREAT) != 0 && fails("open")) return -1;
  return next<int (*)(const char*, int, ...)>("open")(path, flags, mode);
}

ssize_t write(int descriptor, const void* data, std::size_t size) {
  if (descriptor > 2 && fails("write")) return -1;
  return next<ssize_t (*)(int, const void*, std::size_t)>("write")(descriptor, data, size);
}

ssize_t pwrite(int descriptor, const void* data, std::size_t size, off_t offset) {
  if (fails("write")) return -1;
  return next<ssize_t (*)(int, const void*, std::size_t, off_t)>("pwrite")(descriptor, data, size,
                                                                           offset);
}

int fsync(int descriptor) {
  return fails("fsync") ? -1 : next<int (*)(int)>("fsync")(descriptor);
}

int rename(const char* from, const char* to) {
  return fails("rename") ? -1 : next<int (*)(const char*, const char*)>("rename")(from, to);
}
}
