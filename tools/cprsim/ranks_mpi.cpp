// SPDX-License-Identifier: BSD-3-Clause
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "tools/cprsim/ranks.h"

namespace cprsim {

namespace {

/// MPI takes its time to start: only where a launcher has begun it.
bool launched() {
  constexpr std::array kSigns{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
  return std::any_of(kSigns.begin(), kSigns.end(),
                     [](const char* name) { return std::getenv(name) != nullptr; });
}

}  // namespace

Ranks::Ranks() {
  if (!launched()) return;
  // threads compute, but only this one talks
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Ranks::~Ranks() {
  if (launched()) MPI_Finalize();
}

void Ranks::meet() const {
  if (size_ > 1) MPI_Barrier(MPI_COMM_WORLD);
}

std::string Ranks::tell(const std::string& text) const {
  if (size_ == 1) return text;
  std::string heard = text;
  unsigned long long length = text.size();
  MPI_Bcast(&length, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
  heard.resize(length);
  MPI_Bcast(heard.data(), static_cast<int>(length), MPI_CHAR, 0, MPI_COMM_WORLD);
  return heard;
}

void Ranks::give_up(int exit_code) const {
  if (size_ > 1) MPI_Abort(MPI_COMM_WORLD, exit_code);
}

}  // namespace cprsim
