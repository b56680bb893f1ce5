#include "core/testing/allocation_guard.h"

#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <thread>
#include <vector>

#include "core/random.h"
#include "core/testing/allocation_guard.inc.h"

namespace trocar {
inline namespace core {
namespace {

using testing::AllocationGuard;

/// Keeps the compiler from leaving an allocation out.
void* volatile escaped;

TEST(AllocationGuard, CountsNothingWhereNothingIsAllocated) {
  Random random(1);
  const AllocationGuard guard;
  double sum = 0.0;
  for (int n = 0; n < 100; ++n) sum += random.normal();
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_NE(sum, 0.0);
}

TEST(AllocationGuard, CountsAllocationsAndFrees) {
  const AllocationGuard guard;
  auto one = std::make_unique<int>(1);
  escaped = one.get();
  EXPECT_EQ(guard.count(), 1u);
  one.reset();
  EXPECT_EQ(guard.count(), 2u);
}

TEST(AllocationGuard, CountsAllocationsThatMayFail) {
  const AllocationGuard guard;
  auto* one = new (std::nothrow) int(1);
  escaped = one;
  EXPECT_EQ(guard.count(), 1u);
  delete one;
  EXPECT_EQ(guard.count(), 2u);
}

TEST(AllocationGuard, CountsArraysAndAlignedMemory) {
  struct alignas(128) Line {
    char bytes[128];
  };
  const AllocationGuard guard;
  auto* lines = new Line[3];
  escaped = lines;
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(lines) % 128, 0u);
  delete[] lines;
  std::vector<double> numbers(100);
  escaped = numbers.data();
  EXPECT_EQ(guard.count(), 3u);
}

TEST(AllocationGuard, CountsFromItsConstruction) {
  auto before = std::make_unique<int>(1);
  escaped = before.get();
  const AllocationGuard guard;
  EXPECT_EQ(guard.count(), 0u);
}

TEST(AllocationGuard, CountsOnlyItsOwnThread) {
  std::size_t seen_inside = 0;
  const auto allocate = [&] {
    const AllocationGuard inner;
    auto elsewhere = std::make_unique<int>(1);
    escaped = elsewhere.get();
    seen_inside = inner.count();
  };
  std::thread other;
  const AllocationGuard guard;
  other = std::thread(allocate);
  const std::size_t after_start = guard.count();  // starting a thread allocates here
  other.join();
  EXPECT_EQ(seen_inside, 1u);
  EXPECT_LE(guard.count() - after_start, 1u);  // joining may free the thread's state, never more
}

}  // namespace
}  // namespace core
}  // namespace trocar
