// The disk is full while a trainee's attempt is recorded, and its file cannot be written.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include "attempt/live/live_attempt.h"
#include "attempt/record/attempt_replay.h"
#include "attempt/record/journal.h"
#include "servers/live_attempt_lab.h"
#include "storage/session_file.h"

namespace trocar::servers_test {
namespace {

/// No file of this process grows beyond so many bytes, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST_F(LiveAttemptTest, FullDiskKeepsTheScoreAndReportsTheLoss) {
  start(options());
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  attempt->perform(expert());
  ASSERT_TRUE(wait_for([&] { return attempt->view().shots > 0; })) << where();
  std::optional<attempt::RunResult> result;
  {
    const FullDisk full(100'000);
    result = finished();  // nobody ends it
  }
  EXPECT_NE(result->cut_short.find("cannot be written"), std::string::npos) << result->cut_short;
  EXPECT_NE(result->cut_short.find(options().session.string()), std::string::npos) << result->cut_short;
  EXPECT_TRUE(result->outcome.is_scored());
  ASSERT_TRUE(result->unsaved);
  EXPECT_EQ(result->unsaved->samples.size(), result->ticks);
  EXPECT_FALSE(result->unsaved->transducer.empty());
  const auto replay = attempt::AttemptReplay::of(*std::move(result->unsaved), open);
  ASSERT_TRUE(replay) << replay.error().text();
  EXPECT_EQ(replay->outcome().score, result->outcome.score);
  const auto session = storage::load_session(options().session);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_TRUE(session->is_incomplete);
  EXPECT_GT(session->samples.size(), 500u);
}

}  // namespace
}  // namespace trocar::servers_test
