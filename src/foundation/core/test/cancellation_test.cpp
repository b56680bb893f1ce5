#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <stop_token>
#include <thread>

#include "core/background_job.h"
#include "core/parallel.h"
#include "core/progress.h"
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

TEST(Cancellation, ReachesNestedWorkAndOtherThreads) {
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

// TBB cancels what is nested in work of which a part has thrown: its parts would be skipped without a word.
TEST(Cancellation, CompletesNestedCompleteWorkDespiteCancellation) {
  std::stop_source source;
  std::atomic<bool> is_beside_running = false, has_thrown = false;
  std::atomic<int> parts = 0, calls = 0;
  const auto beside = [&] {
    const CompleteWork complete;
    is_beside_running = true;
    for (int n = 0; n < 2000 && !has_thrown; ++n) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // TBB notices
    parallel_for(64, 1, [&](std::size_t from, std::size_t to) { parts += static_cast<int>(to - from); });
    parallel_invoke([&] { ++calls; }, [&] { ++calls; });
    parallel_invoke([&] { ++calls; }, [&] { ++calls; }, [&] { ++calls; });
  };
  const auto cancelled = [&] {
    for (int n = 0; n < 2000 && !is_beside_running; ++n) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    source.request_stop();
    has_thrown = true;
    cancellation_point();
  };
  const CancellationScope scope(source.get_token());
  EXPECT_THROW(parallel_invoke(cancelled, beside), Cancelled);
  if (!is_beside_running) GTEST_SKIP() << "one thread only: there is no work beside";
  EXPECT_EQ(parts, 64);
  EXPECT_EQ(calls, 5);
}

TEST(Cancellation, HasNoEffectOutsideItsScope) {
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

TEST(Cancellation, UnwindsAJobAtProgressReportsAndDropsItsResult) {
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
