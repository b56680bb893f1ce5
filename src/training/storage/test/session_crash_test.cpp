#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>

#include "storage/session_file.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

namespace fs = std::filesystem;
using testing::example_info;
using testing::example_outcome;
using testing::example_sample;

/// Runs `work` in a process of its own and returns how that ended (waitpid's status).
template <class Work>
int in_child(const Work& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

/// Appends `ticks` samples and dies as by kill -9.
void write_and_die(const fs::path& path, std::size_t ticks, double time_step_s, double rate_hz) {
  SessionInfo info = example_info();
  info.rate_hz = rate_hz;
  auto writer = SessionWriter::create(path, info);
  for (std::size_t n = 0; writer && n < ticks; ++n) {
    telemetry::TickSample sample = example_sample(n);
    sample.time_s = time_step_s * static_cast<double>(n);
    if (!writer->append(sample)) ::_exit(3);
  }
  ::kill(::getpid(), SIGKILL);
}

TEST(SessionCrash, LosesLessThanASecondWhenKilled) {
  for (const std::size_t ticks : {1u, 499u, 500u, 501u, 1499u, 2750u}) {
    const TemporaryFolder folder;
    const fs::path path = folder / "s.trocar";
    const int status = in_child([&] { write_and_die(path, ticks, 0.001, 1000.0); });
    ASSERT_TRUE(WIFSIGNALED(status));
    const auto session = load_session(path);
    ASSERT_TRUE(session) << session.error().text();
    EXPECT_LE(session->samples.size(), ticks);
    EXPECT_GE(session->samples.size() + 501, ticks);
    for (std::size_t n = 0; n < session->samples.size(); ++n)
      ASSERT_EQ(session->samples[n].tip_mm, example_sample(n).tip_mm);
    EXPECT_FALSE(session->outcome);
    EXPECT_TRUE(session->shots.empty());
  }
}

TEST(SessionCrash, LosesNoMoreWhenTheClockStops) {
  const TemporaryFolder folder;
  in_child([&] { write_and_die(folder / "s.trocar", 1700, 0.0, 1000.0); });
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_GE(session->samples.size(), 1200u);
}

TEST(SessionCrash, LosesNoMoreAtASlowRate) {
  const TemporaryFolder folder;
  in_child([&] { write_and_die(folder / "s.trocar", 170, 0.01, 1e9); });  // The rate lies: time decides.
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_GE(session->samples.size(), 110u);
}

TEST(SessionCrash, OpensAgainAndAgain) {
  const TemporaryFolder folder;
  in_child([&] { write_and_die(folder / "s.trocar", 1200, 0.001, 1000.0); });
  const auto first = load_session(folder / "s.trocar");
  const auto second = load_session(folder / "s.trocar");
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->samples.size(), second->samples.size());
}

TEST(SessionCrash, OpensWhileItIsStillWritten) {
  const TemporaryFolder folder;
  auto writer = SessionWriter::create(folder / "s.trocar", example_info());
  ASSERT_TRUE(writer);
  for (std::size_t n = 0; n < 1000; ++n) ASSERT_TRUE(writer->append(example_sample(n)));
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_GE(session->samples.size(), 500u);
  EXPECT_TRUE(writer->append(example_sample(1000)));
  EXPECT_TRUE(writer->finish(example_outcome(), {}));
  EXPECT_EQ(load_session(folder / "s.trocar")->samples.size(), 1001u);
}

TEST(SessionCrash, KeepsTheBufferWhenLeftUnfinished) {
  const TemporaryFolder folder;
  {
    auto writer = SessionWriter::create(folder / "s.trocar", example_info());
    ASSERT_TRUE(writer);
    for (std::size_t n = 0; n < 77; ++n) ASSERT_TRUE(writer->append(example_sample(n)));
  }
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->samples.size(), 77u);
  EXPECT_FALSE(session->outcome);
}

TEST(SessionCrash, ReportsAFullDiskAndKeepsRecordedTicks) {
  const TemporaryFolder folder;
  const fs::path path = folder / "s.trocar";
  // The child ends with 10 + what it saw: an error of append (1) that stays (2), and is no usage error (4).
  const int status = in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1'000'000, 1'000'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    auto writer = SessionWriter::create(path, example_info());
    if (!writer) ::_exit(1);
    int seen = 0;
    for (std::size_t n = 0; n < 20'000; ++n) {
      const Status appended = writer->append(example_sample(n));
      if (appended) continue;
      seen |= 1 | (appended.error().exit_status == 1 ? 4 : 0);
      break;
    }
    if (!writer->append(example_sample(0)) && !writer->finish(example_outcome(), {})) seen |= 2;
    ::_exit(10 + seen);
  });
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 17);
  const auto session = load_session(path);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_GE(session->samples.size(), 500u);
}

TEST(SessionCrash, LeavesNothingWithoutRoomForTheFirstPage) {
  const TemporaryFolder folder;
  const int status = in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{2'000, 2'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::_exit(SessionWriter::create(folder / "s.trocar", example_info()) ? 1 : 0);
  });
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(SessionCrash, AdvisesWhenAKilledSessionCannotBeRecovered) {
  const TemporaryFolder folder;
  const fs::path path = folder / "s.trocar";
  in_child([&] {
    ::umask(022);  // whoever comes later may read
    write_and_die(path, 1200, 0.001, 1000.0);
  });
  fs::remove(folder / "s.trocar-shm");
  constexpr fs::perms kReadOnly{0555};
  fs::permissions(folder.path(), kReadOnly);
  const int status = in_child([&] {
    constexpr uid_t kNobody = 65534;  // Root may write anywhere.
    if (::geteuid() == 0 && ::setuid(kNobody) != 0) ::_exit(2);
    const auto session = load_session(path);
    const bool is_told = !session && session.error().text().find("copy the session and its -wal") != std::string::npos;
    ::_exit(is_told ? 0 : 1);
  });
  fs::permissions(folder.path(), fs::perms::owner_all);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(load_session(path));
}

TEST(IncompleteSession, IsRenamedForANewOne) {
  const TemporaryFolder folder;
  const fs::path path = folder / "s.session";
  for (const char* kept : {"s.incomplete.session", "s.incomplete-2.session"}) {
    in_child([&] { write_and_die(path, 1200, 0.001, 1000.0); });
    EXPECT_FALSE(SessionWriter::create(path, example_info()));
    const auto name = set_aside_incomplete_session(path);
    ASSERT_TRUE(name) << name.error().text();
    ASSERT_TRUE(*name);
    EXPECT_EQ(**name, folder / kept);
    for (const fs::path& file : session_files(path)) EXPECT_FALSE(fs::exists(file)) << file;
    const auto session = load_session(folder / kept);
    ASSERT_TRUE(session) << session.error().text();
    EXPECT_TRUE(session->is_incomplete);
    EXPECT_EQ(session->samples.size(), 1000u);
  }
  EXPECT_TRUE(SessionWriter::create(path, example_info()));
}

TEST(IncompleteSession, NothingElseIsRenamed) {
  const TemporaryFolder folder;
  const fs::path path = folder / "s.session";
  EXPECT_FALSE(set_aside_incomplete_session(path).value());  // nothing there
  testing::write_example(path, 600);
  EXPECT_FALSE(set_aside_incomplete_session(path).value());  // finished
  EXPECT_TRUE(load_session(path));
  std::ofstream(folder / "text") << "not a session";
  EXPECT_FALSE(set_aside_incomplete_session(folder / "text").value());
  EXPECT_FALSE(set_aside_incomplete_session(folder.path()).value());

  auto writer = SessionWriter::create(folder / "busy", example_info());
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->append(example_sample(0)));
  const auto busy = set_aside_incomplete_session(folder / "busy");
  ASSERT_FALSE(busy);
  EXPECT_NE(busy.error().text().find("another program is writing"), std::string::npos) << busy.error().text();
  EXPECT_TRUE(writer->finish(example_outcome(), {}));
}

TEST(SessionCrash, FailsOnADiskThatIsFullAtTheEnd) {
  // The limit lies between what the -wal file takes and what the finished file takes: all is written but the end.
  const TemporaryFolder folder;
  const fs::path path = folder / "s.trocar";
  const int status = in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    auto writer = SessionWriter::create(path, example_info());
    for (std::size_t n = 0; writer && n < 700; ++n)
      if (!writer->append(example_sample(n))) ::_exit(3);
    const rlim_t bytes = fs::file_size(path) + 4096;
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::_exit(writer->finish(example_outcome(), {}) ? 1 : 0);
  });
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace trocar::storage
