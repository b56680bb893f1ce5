#include "core/cancellation.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <stop_token>

#include "core/background_job.h"
#include "core/parallel.h"
#include "core/start_thread.h"

namespace trocar {
inline namespace core {
namespace {

/// Cancelled at its part `n`.
std::size_t parts_until_cancelled(std::stop_source& source, std::size_t n) {
  std::atomic<std::size_t> parts = 0;
  const CancellationScope scope(source.get_token());
  EXPECT_THROW(parallel_for(100000, 1,
                            [&](std::size_t first, std::size_t last) {
                              parts += last - first;
                              if (parts >= n) source.request_stop();
                            }),
               Cancelled);
  return parts;
}

TEST(Cancellation, EndsParallelWorkBetweenParts) {
  std::stop_source source;
  EXPECT_LT(parts_until_cancelled(source, 10), 100000U);
}

TEST(Cancellation, IsHandedToNestedWorkAndToOtherThreads) {
  std::stop_source source;
  source.request_stop();
  std::atomic<int> ended = 0;
  const auto ends = [&] {
    try {
      cancellation_point();
    } catch (const Cancelled&) {
      ++ended;
    }
  };
  const CancellationScope scope(source.get_token());
  EXPECT_TRUE(cancellation_token().stop_requested());
  parallel_invoke(ends, ends, ends);
  parallel_invoke(ends, ends);
  run_on_threads(2, ends);
  compute_beside(ends).get();
  EXPECT_EQ(ended, 7);
  EXPECT_THROW(parallel_for(1, 1, [](std::size_t, std::size_t) {}), Cancelled);
}

TEST(Cancellation, ConcernsNobodyOutsideOfItsScope) {
  std::stop_source source;
  source.request_stop();
  {
    const CancellationScope scope(source.get_token());
    const CancellationScope inner{std::stop_token()};
    EXPECT_NO_THROW(cancellation_point());
  }
  EXPECT_NO_THROW(cancellation_point());
  EXPECT_FALSE(cancellation_token().stop_possible());
  int parts = 0;
  run_on_threads(1,
                 [&] { parallel_for(10, 1, [&](std::size_t a, std::size_t b) { parts += static_cast<int>(b - a); }); });
  EXPECT_EQ(parts, 10);
}

struct Counted {
  explicit Counted(std::atomic<int>& count) : alive(count) { ++alive; }
  ~Counted() { --alive; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  std::atomic<int>& alive;
};

TEST(Cancellation, UnwindsAJobThatReportsProgressAndDropsItsResult) {
  std::atomic<int> alive = 0;
  std::atomic<bool> has_begun = false;
  BackgroundJob<int> job([&](const Progress& progress) -> Result<int> {
    const Counted one(alive);
    for (;;) {
      progress("step", 0.5);
      has_begun = true;
    }
  });
  while (!has_begun) std::this_thread::yield();
  job.cancel();
  while (!job.view().is_done) std::this_thread::yield();
  EXPECT_EQ(alive, 0);
  EXPECT_FALSE(job.take());
}

}  // namespace
}  // namespace core
}  // namespace trocar
