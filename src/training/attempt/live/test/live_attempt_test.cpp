#include "attempt/live/live_attempt.h"

#include <gtest/gtest.h>

#include "cases/testing/cached_case.h"
#include "core/files/folders.h"
#include "core/testing/no_threads.h"

namespace trocar::attempt {
namespace {

TEST(LiveAttempt, FailsWithAReasonWithoutAThread) {
  const auto open = testing::open_cached_case();
  ASSERT_TRUE(open) << open.error().text();
  const TemporaryFolder folder;
  AttemptOptions options;
  options.session = folder / "a.session";
  const testing::NoThreads none;
  LiveAttempt attempt(*open, options);
  EXPECT_EQ(attempt.view().phase, AttemptPhase::kFailed);
  const auto result = attempt.take_result();
  ASSERT_TRUE(result);
  ASSERT_FALSE(*result);
  EXPECT_NE(result->error().what.find("does not start"), std::string::npos) << result->error().text();
}

}  // namespace
}  // namespace trocar::attempt
