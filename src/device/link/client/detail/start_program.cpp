#include "link/client/detail/start_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace trocar::link::detail {
namespace {

constexpr int kCannotRun = 127;  // the shell's status for a program that cannot be executed
constexpr mode_t kLogMode = 0644;

/// All data that the child needs between fork and exec, where it may not allocate.
struct Prepared {
  const char* path;
  char* const* arguments;
  int log, null, failure;
  pid_t parent;
};

[[noreturn]] void become(const Prepared& prepared) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != prepared.parent) ::_exit(kCannotRun);  // the parent ended before the prctl call
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::dup2(prepared.null, STDIN_FILENO);
  if (prepared.log >= 0) {
    ::dup2(prepared.log, STDOUT_FILENO);
    ::dup2(prepared.log, STDERR_FILENO);
  }
  ::execv(prepared.path, prepared.arguments);
  const int why = errno;
  [[maybe_unused]] const ssize_t written = ::write(prepared.failure, &why, sizeof why);
  ::_exit(kCannotRun);
}

/// The error that stopped the child from executing its program; 0: none.
int read_failure(int pipe) {
  int why = 0;
  ssize_t got = 0;
  do {
    got = ::read(pipe, &why, sizeof why);
  } while (got < 0 && errno == EINTR);
  return got == static_cast<ssize_t>(sizeof why) ? why : 0;
}

Result<int> spawn(const Program& program, int log, int null, const std::array<int, 2>& pipe) {
  std::vector<std::string> words{program.path.string()};
  words.insert(words.end(), program.arguments.begin(), program.arguments.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  const Prepared prepared{program.path.c_str(), arguments.data(), log, null, pipe[1], ::getpid()};
  const pid_t child = ::fork();
  if (child == 0) become(prepared);
  const int fork_error = errno;
  ::close(pipe[1]);
  if (child < 0) return fail("the program cannot be started", program.path.string(), std::strerror(fork_error));
  if (const int why = read_failure(pipe[0]); why != 0) {
    ::waitpid(child, nullptr, 0);
    return fail("the program cannot be run", program.path.string(), std::strerror(why));
  }
  return child;
}

}  // namespace

Result<int> start_program(const Program& program) {
  int log = -1;
  if (!program.log.empty()) {
    log = ::open(program.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, kLogMode);
    if (log < 0) return fail("the log cannot be written", program.log.string(), std::strerror(errno));
  }
  const int null = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  std::array<int, 2> pipe{-1, -1};
  Result<int> child = ::pipe2(pipe.data(), O_CLOEXEC) == 0
                          ? spawn(program, log, null, pipe)
                          : fail("no pipe to start the program", program.path.string(), std::strerror(errno));
  if (pipe[0] >= 0) ::close(pipe[0]);
  if (null >= 0) ::close(null);
  if (log >= 0) ::close(log);
  return child;
}

}  // namespace trocar::link::detail
