// SPDX-License-Identifier: BSD-3-Clause
// What a rod has only where the scene calls for it: tendons, disks, contact. Whether it is there is
// asked where a section would be concerned.
#pragma once

#include <memory>

namespace cprsim {

#ifndef CPRSIM_BARE_KERNEL
constexpr bool kBare = false;  ///< whether effects are compiled out
template <class T>
using EffectPart = std::unique_ptr<T>;
#else
constexpr bool kBare = true;

/// Never there, which the compiler knows: what tests/effects compares with.
template <class T>
class EffectPart {
 public:
  constexpr explicit operator bool() const { return false; }

  T* operator->() const { return part_.get(); }

  T& operator*() const { return *part_; }

  constexpr T* get() const { return nullptr; }

  void reset(T* part) { part_.reset(part); }

  EffectPart& operator=(std::unique_ptr<T> part) {
    part_ = std::move(part);
    return *this;
  }

 private:
  std::unique_ptr<T> part_;
};
#endif

}  // namespace cprsim
