#include "core/interruption.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/files/unfinished_output.h"

namespace trocar {
inline namespace core {
namespace {
namespace fs = std::filesystem;

constexpr int kFailed = 1, kEndedByItself = 7;

/// Runs `work` in a process that handles interruptions; gives its exit status, 128 + signal when it was killed.
template <class Work>
int interrupted(const Work& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (!handle_interruptions("trocar test")) ::_exit(kEndedByItself + 1);
    work();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

[[noreturn]] void wait_for_the_end() {
  while (true) ::pause();
}

TEST(Interruption, LeavesNoHalfWrittenFileOrFolder) {
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    const TemporaryFolder folder;
    EXPECT_EQ(interrupted([&] {
                static_cast<void>(write_atomically(folder / "file", [&](const fs::path& temporary) -> Status {
                  std::ofstream(temporary) << "half";
                  ::raise(signal_number);
                  wait_for_the_end();
                }));
              }),
              kFailed);
    EXPECT_EQ(interrupted([&] {
                static_cast<void>(write_folder_atomically(folder / "new", [&](const fs::path& temporary) -> Status {
                  fs::create_directories(temporary / "inside");
                  std::ofstream(temporary / "inside" / "file") << "half";
                  ::raise(signal_number);
                  wait_for_the_end();
                }));
              }),
              kFailed);
    EXPECT_TRUE(folder.is_empty()) << "signal " << signal_number;
  }
}

TEST(Interruption, RemovesFoldersThatWorkKeepsRecreating) {
  for (int round = 0; round < 20; ++round) {
    const TemporaryFolder folder;
    EXPECT_EQ(interrupted([&] {
                static_cast<void>(write_folder_atomically(folder / "new", [&](const fs::path& temporary) -> Status {
                  ::kill(::getpid(), SIGTERM);
                  for (int i = 0;; ++i) {
                    std::error_code ignored;
                    fs::create_directories(temporary / "inside", ignored);
                    std::ofstream(temporary / "inside" / std::to_string(i % 100)) << "half";
                  }
                }));
              }),
              kFailed);
    EXPECT_TRUE(folder.is_empty()) << round;
  }
}

/// An interruption comes before an output is in place, and nothing is there, or after it, and all is there.
TEST(Interruption, LeavesACompleteOutputOrNone) {
  constexpr int kLongest_us = 20'000'000;  // a busy machine is slow
  int whole = 0;
  for (int delay_us = 0; delay_us < 4000 || (whole == 0 && delay_us < kLongest_us);
       delay_us += std::max(100, delay_us / 10)) {
    const TemporaryFolder folder;
    static_cast<void>(interrupted([&] {
      std::thread([&] {
        ::usleep(static_cast<useconds_t>(delay_us));
        ::kill(::getpid(), SIGTERM);
      }).detach();
      static_cast<void>(write_folder_atomically(folder / "new", [&](const fs::path& temporary) -> Status {
        for (int i = 0; i < 20; ++i) std::ofstream(temporary / std::to_string(i)) << "one of them";
        return {};
      }));
      wait_for_the_end();
    }));
    if (folder.is_empty()) continue;
    ++whole;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "new"), {}), 20) << delay_us;
  }
  EXPECT_GT(whole, 0);
}

TEST(Interruption, ReportsACompleteOutput) {
  const TemporaryFolder folder;
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(interrupted([&] {
              static_cast<void>(write_file_atomically(folder / "cached", "x"));
              static_cast<void>(write_file_atomically(folder / "picture", "x"));
              forget_finished_output(folder / "cached");
              ::raise(SIGTERM);
              wait_for_the_end();
            }),
            kFailed);
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("the output is complete — " + (folder / "picture").string()), std::string::npos) << said;
  EXPECT_TRUE(fs::exists(folder / "picture"));
}

TEST(Interruption, RemovesTemporaryFolders) {
  const TemporaryFolder folder;
  EXPECT_EQ(interrupted([&] {
              ::setenv("TMPDIR", folder.path().c_str(), 1);
              const TemporaryFolder own;
              std::ofstream(own / "socket") << "x";
              ::raise(SIGTERM);
              wait_for_the_end();
            }),
            kFailed);
  EXPECT_TRUE(folder.is_empty());
}

TEST(Interruption, AllowsWorkToFinish) {
  EXPECT_EQ(interrupted([] {
              const InterruptibleWork work;
              EXPECT_FALSE(is_interrupted());
              ::raise(SIGINT);
              while (!is_interrupted()) ::usleep(1000);
              ::_exit(kEndedByItself);
            }),
            kEndedByItself);
}

TEST(Interruption, TheSecondSignalEndsAtOnce) {
  EXPECT_EQ(interrupted([] {
              const InterruptibleWork work;
              ::raise(SIGINT);
              ::raise(SIGINT);
              wait_for_the_end();
            }),
            kFailed);
}

TEST(Interruption, LeavesAnIgnoredSignalIgnored) {
  EXPECT_EQ(interrupted([] { ::_exit(0); }), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGHUP, SIG_IGN);
    if (!handle_interruptions("trocar test")) ::_exit(1);
    ::raise(SIGHUP);
    ::_exit(is_interrupted() ? 1 : 0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST(UnfinishedOutput, IsRemovedUnlessItIsKept) {
  const TemporaryFolder folder;
  std::ofstream(folder / "kept") << "x";
  std::ofstream(folder / "failed") << "x";
  {
    UnfinishedOutput kept({folder / "kept"});
    const UnfinishedOutput failed({folder / "failed", folder / "never-made"});
    kept.keep();
  }
  EXPECT_TRUE(fs::exists(folder / "kept"));
  EXPECT_FALSE(fs::exists(folder / "failed"));
}

}  // namespace
}  // namespace core
}  // namespace trocar
