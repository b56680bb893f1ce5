#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace trocar {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
  for (const std::size_t count : {1, 2, 63, 64, 1000, 12345})
    for (const std::size_t grain : {0, 1, 64, 100000}) {
      std::vector<std::atomic<int>> visits(count);
      parallel_for(count, grain, [&](std::size_t first, std::size_t last) {
        EXPECT_LT(first, last);
        for (std::size_t n = first; n < last; ++n) ++visits[n];
      });
      for (const auto& v : visits) EXPECT_EQ(v.load(), 1);
    }
}

TEST(ParallelFor, DoesNothingForNothing) {
  parallel_for(0, 1, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelFor, CanBeNested) {
  std::atomic<int> sum = 0;
  parallel_for(10, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      parallel_for(10, 1, [&](std::size_t a, std::size_t b) { sum += static_cast<int>(b - a); });
  });
  EXPECT_EQ(sum.load(), 100);
}

TEST(ParallelInvoke, RunsAllAndWaits) {
  std::atomic<int> done = 0;
  parallel_invoke([&] { done += 1; }, [&] { done += 10; });
  EXPECT_EQ(done.load(), 11);
  parallel_invoke([&] { done += 100; }, [&] { done += 1000; }, [&] { done += 10000; });
  EXPECT_EQ(done.load(), 11111);
}

}  // namespace
}  // namespace trocar
