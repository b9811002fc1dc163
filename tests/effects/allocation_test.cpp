// SPDX-License-Identifier: BSD-3-Clause
// No memory is asked for while sections are visited: every request of this program passes through
// the functions below.
#include <gtest/gtest.h>

#include <cstddef>

#include "tests/effects/costed_rods.h"

namespace {

bool counting = false;
long requests = 0;

}  // namespace

// glibc's own, which the functions below stand in front of
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  if (counting) ++requests;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  if (counting) ++requests;
  return __libc_calloc(count, size);
}

void* realloc(void* old, std::size_t size) {
  if (counting) ++requests;
  return __libc_realloc(old, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  if (counting) ++requests;
  return __libc_memalign(alignment, size);
}
}

namespace cprsim {
namespace {

/// Requests during what is done.
template <class Work>
long requests_of(const Work& work) {
  requests = 0;
  counting = true;
  work();
  counting = false;
  return requests;
}

TEST(Allocation, IsCounted) {
  EXPECT_GT(requests_of([] { delete new volatile int(1); }), 0);
  EXPECT_GT(requests_of([] { VecX::Ones(100).eval(); }), 0);
}

class SectionVisits : public testing::TestWithParam<Method> {};

struct SweepRequests {
  long residual, linearisation;
};

SweepRequests requests_of_sweep(const RodCase& at, Method method, int fineness) {
  CostedRod rod(at, method, fineness);
  RodModel& model = rod.model();
  const Port base = rod.base(), tip = rod.tip();
  CondensedRod condensed;
  model.evaluate(base, tip);
  model.linearize(base, tip, condensed);
  return {requests_of([&] { model.evaluate(base, tip); }),
          requests_of([&] { model.linearize(base, tip, condensed); })};
}

// What a sweep asks for at all is for the rod's two ends: it is as much on a rod of twice as many
// sections, the unknowns along a tendon that rubs, which grow with them, included.
TEST_P(SectionVisits, AskForNoMemory) {
  for (const RodCase& at : costed_cases()) {
    const SweepRequests coarse = requests_of_sweep(at, GetParam(), 1),
                        fine = requests_of_sweep(at, GetParam(), 2);
    EXPECT_EQ(coarse.residual, fine.residual) << at.name;
    EXPECT_EQ(coarse.linearisation, fine.linearisation) << at.name;
    if (GetParam() != Method::kShooting) continue;
    EXPECT_EQ(fine.residual, 0) << at.name;
    EXPECT_LE(fine.linearisation, 1) << at.name;
  }
}

INSTANTIATE_TEST_SUITE_P(AllMethods, SectionVisits, testing::ValuesIn(kEveryMethod), test_name);

}  // namespace
}  // namespace cprsim
