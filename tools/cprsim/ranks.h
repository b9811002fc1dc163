// SPDX-License-Identifier: BSD-3-Clause
// The processes that share a piece of work, started together by mpirun or srun: which of them this
// one is. A program built without MPI, or started alone, is the only one.
#pragma once

#include <string>

namespace cprsim {

class Ranks {
 public:
  Ranks();
  /// All must get here.
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }

  int size() const { return size_; }

  bool first() const { return rank_ == 0; }

  /// Waits for all.
  void meet() const;

  /// What the first one says, to all.
  std::string tell(const std::string& text) const;

  /// Ends all processes, which may be waiting for this one, if there are others.
  void give_up(int exit_code) const;

 private:
  int rank_ = 0, size_ = 1;
};

}  // namespace cprsim
