#include "core/parallel.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "core/testing/no_threads.h"

namespace trocar {
inline namespace core {
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

TEST(ParallelFor, DoesNothingForAnEmptyRange) {
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

TEST(RunOnThreads, UsesOnlyTheCallersThreadForACountOfOne) {
  std::mutex mutex;
  std::set<std::thread::id> used;
  std::atomic<int> visits = 0;
  run_on_threads(1, [&] {
    parallel_for(1000, 1, [&](std::size_t first, std::size_t last) {
      const std::lock_guard lock(mutex);
      used.insert(std::this_thread::get_id());
      visits += static_cast<int>(last - first);
    });
  });
  EXPECT_EQ(visits.load(), 1000);
  EXPECT_EQ(used, std::set{std::this_thread::get_id()});
}

TEST(ParallelInvoke, RunsAllAndWaits) {
  std::atomic<int> done = 0;
  parallel_invoke([&] { done += 1; }, [&] { done += 10; });
  EXPECT_EQ(done.load(), 11);
  parallel_invoke([&] { done += 100; }, [&] { done += 1000; }, [&] { done += 10000; });
  EXPECT_EQ(done.load(), 11111);
}

/// In a program of its own, whose first work it is.
TEST(ParallelForDeathTest, CallerDoesAllWorkWithoutOtherThreads) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto work = [] {
    const testing::NoThreads none;
    const std::thread::id self = std::this_thread::get_id();
    std::atomic<std::size_t> visits = 0, others = 0;
    run_on_threads(8, [&] {
      parallel_for(200'000, 1, [&](std::size_t first, std::size_t last) {
        visits += last - first;
        if (std::this_thread::get_id() != self) ++others;
      });
    });
    ::_exit(visits == 200'000 && others == 0 ? 0 : 1);
  };
  EXPECT_EXIT(work(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace core
}  // namespace trocar
