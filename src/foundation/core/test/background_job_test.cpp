#include "core/background_job.h"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>

namespace trocar {
inline namespace core {
namespace {

/// Until the work has ended; the test's own time limit ends a hang.
template <class T>
void wait_done(const BackgroundJob<T>& job) {
  while (!job.view().is_done) std::this_thread::yield();
}

TEST(BackgroundJob, GivesItsResultOnce) {
  BackgroundJob<int> job([](const Progress&) -> Result<int> { return 7; });
  wait_done(job);
  const auto result = job.take();
  ASSERT_TRUE(result && *result);
  EXPECT_EQ(**result, 7);
  EXPECT_FALSE(job.take());
}

TEST(BackgroundJob, GivesTheErrorOfItsWork) {
  BackgroundJob<void> job([](const Progress&) -> Status { return fail("no room", "disk"); });
  wait_done(job);
  const auto result = job.take();
  ASSERT_TRUE(result);
  ASSERT_FALSE(*result);
  EXPECT_EQ(result->error().what, "no room");
}

TEST(BackgroundJob, ReportsProgressWhileRunning) {
  std::promise<void> go_on, half_way;
  BackgroundJob<int> job([&](const Progress& progress) -> Result<int> {
    report(progress, "first half", 0.5);
    half_way.set_value();
    go_on.get_future().wait();
    report(progress, "too far", 1.5);
    return 1;
  });
  half_way.get_future().wait();
  EXPECT_EQ(job.view().step, "first half");
  EXPECT_EQ(job.view().fraction, 0.5);
  EXPECT_FALSE(job.view().is_done);
  EXPECT_FALSE(job.take());
  go_on.set_value();
  wait_done(job);
  EXPECT_EQ(job.view().fraction, 1.0);
}

TEST(BackgroundJob, CancelStopsTheWorkAndDropsItsResult) {
  BackgroundJob<int> job([](const Progress&, const std::stop_token& stop) -> Result<int> {
    while (!stop.stop_requested()) std::this_thread::yield();
    return 1;
  });
  job.cancel();
  wait_done(job);
  EXPECT_TRUE(job.is_cancelled());
  EXPECT_FALSE(job.take());
}

TEST(BackgroundJob, CancelDropsAFinishedResult) {
  BackgroundJob<int> job([](const Progress&) -> Result<int> { return 1; });
  wait_done(job);
  job.cancel();
  EXPECT_FALSE(job.take());
}

TEST(BackgroundJob, ReportsOutOfMemory) {
  BackgroundJob<int> job([](const Progress&) -> Result<int> { throw std::bad_alloc(); });
  wait_done(job);
  const auto result = job.take();
  ASSERT_TRUE(result && !*result);
  EXPECT_EQ(result->error().what, "not enough memory");
}

TEST(BackgroundJob, CanBeMovedWhileItWorks) {
  std::promise<void> go_on;
  BackgroundJob<std::unique_ptr<int>> job([&](const Progress&) -> Result<std::unique_ptr<int>> {
    go_on.get_future().wait();
    return std::make_unique<int>(3);
  });
  BackgroundJob<std::unique_ptr<int>> other = std::move(job);
  EXPECT_FALSE(job.has_work());  // NOLINT(bugprone-use-after-move)
  go_on.set_value();
  wait_done(other);
  auto result = other.take();
  ASSERT_TRUE(result && *result);
  EXPECT_EQ(***result, 3);
}

TEST(BackgroundJob, HasNoResultWithoutWork) {
  BackgroundJob<int> job;
  EXPECT_FALSE(job.has_work());
  EXPECT_FALSE(job.take());
  job.cancel();
}

TEST(RetiredJobs, KeepAJobUntilItsWorkHasEnded) {
  RetiredJobs retired;
  std::promise<void> go_on;
  retired.retire(BackgroundJob<int>([&](const Progress&) -> Result<int> {
    go_on.get_future().wait();
    return 1;
  }));
  retired.retire(BackgroundJob<int>());
  EXPECT_EQ(retired.sweep(), 1U);
  go_on.set_value();
  while (retired.sweep() > 0) std::this_thread::yield();
}

TEST(BackgroundJob, ConvertsExceptionsToErrors) {
  const auto what_of = [](auto thrown) {
    BackgroundJob<int> job([thrown](const Progress&) -> Result<int> { throw thrown; });
    wait_done(job);
    const auto result = job.take();
    EXPECT_TRUE(result && !*result);
    return result && !*result ? result->error().what : std::string();
  };
  EXPECT_EQ(what_of(std::runtime_error("a library's error")), "unforeseen error: a library's error");
  EXPECT_EQ(what_of(7), "unforeseen error: unknown");
  EXPECT_EQ(what_of(std::bad_alloc()), "not enough memory");
}

}  // namespace
}  // namespace core
}  // namespace trocar
