#include "core/start_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "core/background_job.h"
#include "core/interruption.h"
#include "core/testing/no_threads.h"

namespace trocar {
inline namespace core {
namespace {

TEST(StartThread, RunsItsBody) {
  std::atomic<int> runs{0};
  auto thread = start_thread("test", [&] { ++runs; });
  ASSERT_TRUE(thread) << thread.error().text();
  thread->join();
  {
    const auto stoppable = start_stoppable_thread("test", [&](const std::stop_token& stop) {
      while (!stop.stop_requested()) std::this_thread::yield();
      ++runs;
    });
    ASSERT_TRUE(stoppable) << stoppable.error().text();
  }
  EXPECT_EQ(runs, 2);
  EXPECT_TRUE(check_threads_can_start("test", 3));
}

TEST(StartThread, FailsIfTheSystemHasNoThread) {
  const testing::NoThreads none;
  const auto thread = start_thread("test", [] {});
  ASSERT_FALSE(thread);
  EXPECT_NE(thread.error().text().find("the test thread does not start: "), std::string::npos) << thread.error().text();
  EXPECT_EQ(thread.error().exit_status, 1);
  EXPECT_FALSE(start_stoppable_thread("test", [](const std::stop_token&) {}));
  EXPECT_FALSE(check_threads_can_start("test", 1));
  EXPECT_FALSE(handle_interruptions("trocar test"));
}

TEST(StartThread, RunsWorkInPlaceWithoutAThread) {
  EXPECT_EQ(compute_beside([] { return 6; }).get(), 6);
  const testing::NoThreads none;
  auto value = compute_beside([] { return 7; });
  EXPECT_EQ(value.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  EXPECT_EQ(value.get(), 7);
  EXPECT_THROW(compute_beside([]() -> int { throw std::runtime_error("no"); }).get(), std::runtime_error);
}

TEST(StartThread, BackgroundJobFailsWithoutAThread) {
  const testing::NoThreads none;
  BackgroundJob<int> job([](const Progress&) -> Result<int> { return 1; });
  EXPECT_TRUE(job.view().is_done);
  const auto result = job.take();
  ASSERT_TRUE(result);
  ASSERT_FALSE(*result);
  EXPECT_NE(result->error().what.find("does not start"), std::string::npos);
  job.cancel();
}

}  // namespace
}  // namespace core
}  // namespace trocar
