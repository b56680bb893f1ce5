#include "link/client/server_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "link/test/link_fixture.h"

namespace trocar::link {
namespace {
namespace fs = std::filesystem;

using testing::eventually;

ServerProcess started(const fs::path& program, const std::vector<std::string>& arguments, const fs::path& log = {}) {
  auto process = ServerProcess::start(program, arguments, log);
  EXPECT_TRUE(process) << process.error().text();
  return *std::move(process);
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// No process has this number any more, not even a zombie.
bool is_gone(int pid) {
  return ::kill(pid, 0) != 0 && errno == ESRCH;
}

TEST(ServerProcess, RunsUntilItIsStopped) {
  ServerProcess process = started("/bin/sleep", {"1000"});
  EXPECT_TRUE(process.is_running());
  EXPECT_EQ(process.how_it_ended(), "");
  process.stop();
  EXPECT_FALSE(process.is_running());
  EXPECT_EQ(process.how_it_ended(), "was killed by signal 15");
  EXPECT_TRUE(is_gone(process.pid()));
  process.stop();
}

TEST(ServerProcess, ReportsTheExitStatus) {
  ServerProcess process = started("/bin/false", {});
  EXPECT_TRUE(eventually([&] { return !process.is_running(); }));
  EXPECT_EQ(process.how_it_ended(), "ended with exit status 1");
}

TEST(ServerProcess, ReportsAKillSignal) {
  ServerProcess process = started("/bin/sleep", {"1000"});
  ::kill(process.pid(), SIGKILL);
  EXPECT_TRUE(eventually([&] { return !process.is_running(); }));
  EXPECT_EQ(process.how_it_ended(), "was killed by signal 9");
}

TEST(ServerProcess, KillsAChildThatIgnoresTerm) {
  const TemporaryFolder folder;
  ServerProcess process =
      started("/bin/sh", {"-c", "trap '' TERM; echo ready >&2; while :; do sleep 0.1; done"}, folder / "log");
  ASSERT_TRUE(eventually([&] { return text_of(folder / "log") == "ready\n"; }));
  process.stop();
  EXPECT_EQ(process.how_it_ended(), "was killed by signal 9");
}

TEST(ServerProcess, StopsASuspendedChild) {
  ServerProcess process = started("/bin/sleep", {"1000"});
  ::kill(process.pid(), SIGSTOP);
  process.stop();
  EXPECT_EQ(process.how_it_ended(), "was killed by signal 15");
}

TEST(ServerProcess, IsHeldUpWhenStoppedOrBusyButNotWhenSleeping) {
  ServerProcess sleeper = started("/bin/sleep", {"1000"});
  EXPECT_TRUE(eventually([&] { return !sleeper.is_held_up(); }));
  ::kill(sleeper.pid(), SIGSTOP);
  EXPECT_TRUE(eventually([&] { return sleeper.is_held_up(); }));
  sleeper.stop();
  EXPECT_FALSE(sleeper.is_held_up());
  ServerProcess busy = started("/bin/sh", {"-c", "while :; do :; done"});
  EXPECT_TRUE(eventually([&] { return busy.is_held_up(); }));
}

TEST(ServerProcess, EndsItsChildWhenDestroyed) {
  int pid = 0;
  {
    const ServerProcess process = started("/bin/sleep", {"1000"});
    pid = process.pid();
  }
  EXPECT_TRUE(is_gone(pid));
}

TEST(ServerProcess, PassesArgumentsUnchangedAndAppendsToTheLog) {
  const TemporaryFolder folder;
  std::ofstream(folder / "log") << "before\n";
  ServerProcess process =
      started("/bin/sh", {"-c", "printf '%s\\n' \"$1\" \"$2\" >&2", "sh", "a b", "$HOME'\""}, folder / "log");
  EXPECT_TRUE(eventually([&] { return !process.is_running(); }));
  EXPECT_EQ(text_of(folder / "log"), "before\na b\n$HOME'\"\n");
}

TEST(ServerProcess, DoesNotReadStandardInput) {
  const TemporaryFolder folder;
  ServerProcess process = started("/bin/sh", {"-c", "cat >&2; echo end >&2"}, folder / "log");
  EXPECT_TRUE(eventually([&] { return !process.is_running(); }));
  EXPECT_EQ(text_of(folder / "log"), "end\n");
}

TEST(ServerProcess, FailsWithoutAZombieForAnUnusableProgram) {
  const TemporaryFolder folder;
  EXPECT_FALSE(ServerProcess::start(folder / "missing", {}));
  std::ofstream(folder / "broken") << "\177ELF, and no more";
  fs::permissions(folder / "broken", fs::perms::owner_all);
  EXPECT_FALSE(ServerProcess::start(folder / "broken", {}));
  EXPECT_FALSE(ServerProcess::start("/bin/sleep", {"1000"}, folder / "no" / "log"));
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST(ServerProcess, SurvivesTheThreadThatStartedIt) {
  std::optional<ServerProcess> process;
  std::thread([&] { process = started("/bin/sleep", {"1000"}); }).join();
  // A signal of the kernel would have come with the thread's end; the next child's whole life is after that.
  ServerProcess other = started("/bin/true", {});
  EXPECT_TRUE(eventually([&] { return !other.is_running(); }));
  EXPECT_TRUE(process->is_running());
}

TEST(ServerProcess, DiesWithItsParent) {
  const TemporaryFolder folder;
  const pid_t parent = ::fork();
  if (parent == 0) {
    auto process = ServerProcess::start("/bin/sh", {"-c", "echo $$ >&2; exec sleep 1000"}, folder / "log");
    while (process) ::pause();
    ::_exit(1);
  }
  ASSERT_TRUE(eventually([&] { return text_of(folder / "log").ends_with('\n'); }));
  const int child = std::stoi(text_of(folder / "log"));
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  // Whoever adopts it may leave a zombie for a while.
  EXPECT_TRUE(eventually([&] {
    const std::string status = text_of("/proc/" + std::to_string(child) + "/stat");
    return is_gone(child) || status.find(") Z") != std::string::npos;
  }));
}

TEST(FindServerProgram, SearchesTheNamedFolderAndThePath) {
  const TemporaryFolder folder;
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  const std::string path = variable("PATH"), bin = variable("TROCAR_BIN_DIR");
  ::setenv("PATH", (":/no/such/folder:" + folder.path().string()).c_str(), 1);
  ::unsetenv("TROCAR_BIN_DIR");
  EXPECT_FALSE(find_server_program());
  std::ofstream(folder / "trocar-hapticd") << "#!/bin/sh\n";
  EXPECT_FALSE(find_server_program());  // not executable
  fs::permissions(folder / "trocar-hapticd", fs::perms::owner_all);
  EXPECT_EQ(find_server_program().value_or("none"), folder / "trocar-hapticd");
  ::setenv("PATH", "", 1);
  EXPECT_FALSE(find_server_program());
  ::setenv("TROCAR_BIN_DIR", folder.path().c_str(), 1);
  EXPECT_EQ(find_server_program().value_or("none"), folder / "trocar-hapticd");
  ::setenv("PATH", path.c_str(), 1);
  ::setenv("TROCAR_BIN_DIR", bin.c_str(), 1);
}

}  // namespace
}  // namespace trocar::link
