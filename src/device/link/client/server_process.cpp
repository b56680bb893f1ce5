#include "link/client/server_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/files/file_system.h"
#include "core/files/folders.h"
#include "core/result.h"
#include "core/start_thread.h"

namespace trocar::link::detail {

struct Program {
  std::filesystem::path path;
  std::vector<std::string> arguments;
  std::filesystem::path log;  ///< Standard output and error are appended to it; empty: those of this process.
};

/// Starts a child process and returns its process id. The kernel ends the child (SIGTERM) when the calling thread ends.
/// Errors: the log cannot be written, the program cannot be run.
Result<int> start_program(const Program& program);

}  // namespace trocar::link::detail

namespace trocar::link {
namespace fs = std::filesystem;
namespace {

constexpr const char* kProgram = "trocar-hapticd";
constexpr std::chrono::seconds kPatience(2);  ///< From SIGTERM to SIGKILL.

/// "R" is running or runnable, "D" waits for a disk, "T" and "t" are stopped; the state follows the name in brackets
/// (proc(5)).
bool is_held_up_thread(const fs::path& thread) {
  std::ifstream file(thread / "stat");
  std::string stat;
  std::getline(file, stat);  // no exception if the thread ends while it is read
  const std::size_t end = stat.rfind(") ");
  return end != std::string::npos && end + 2 < stat.size() &&
         std::string_view("RDTt").find(stat[end + 2]) != std::string_view::npos;
}

std::string told(int status) {
  if (WIFSIGNALED(status)) return "was killed by signal " + std::to_string(WTERMSIG(status));
  return "ended with exit status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

/// The thread starts the child: the kernel ends a child when the thread that started it ends, not the process; so it
/// cannot be the caller's thread.
struct ServerProcess::Impl {
  std::mutex mutex;
  std::condition_variable news;
  std::optional<Result<int>> started;  ///< Process id.
  std::optional<int> end_status;       ///< From waitpid; until then the id belongs to the child and may be signalled.
  std::thread thread;

  void live(const detail::Program& program);
  void signal(int number);
  void stop();
  ~Impl() { stop(); }
};

void ServerProcess::Impl::live(const detail::Program& program) {
  Result<int> child = detail::start_program(program);
  {
    const std::lock_guard lock(mutex);
    started = child;
  }
  news.notify_all();
  if (!child) return;
  // The id belongs to the child until it is reaped, under the lock.
  siginfo_t info{};
  while (::waitid(P_PID, static_cast<id_t>(*child), &info, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
  }
  {
    const std::lock_guard lock(mutex);
    int status = 0;
    ::waitpid(*child, &status, 0);
    end_status = status;
  }
  news.notify_all();
}

void ServerProcess::Impl::signal(int number) {
  const std::lock_guard lock(mutex);
  if (started && *started && !end_status) ::kill(**started, number);
}

void ServerProcess::Impl::stop() {
  if (!thread.joinable()) return;
  signal(SIGTERM);
  // A stopped child receives no SIGTERM until it continues.
  signal(SIGCONT);
  {
    std::unique_lock lock(mutex);
    news.wait_for(lock, kPatience, [&] { return end_status || !*started; });
  }
  signal(SIGKILL);
  thread.join();
}

Result<ServerProcess> ServerProcess::start(const fs::path& program, const std::vector<std::string>& arguments,
                                           const fs::path& log) {
  if (!is_program(program))
    return fail("there is no such program", program.string(), "install trocar-hapticd beside trocar");
  auto impl = std::make_unique<Impl>();
  TROCAR_TRY(impl->thread,
             start_thread("server process",
                          [self = impl.get(), what = detail::Program{program, arguments, log}] { self->live(what); }));
  std::unique_lock lock(impl->mutex);
  impl->news.wait(lock, [&] { return impl->started.has_value(); });
  if (!*impl->started) {
    const Error error = impl->started->error();
    lock.unlock();
    return tl::unexpected(error);
  }
  lock.unlock();
  return ServerProcess(std::move(impl));
}

ServerProcess::ServerProcess(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ServerProcess::ServerProcess(ServerProcess&&) noexcept = default;
ServerProcess& ServerProcess::operator=(ServerProcess&&) noexcept = default;
ServerProcess::~ServerProcess() = default;

int ServerProcess::pid() const {
  const std::lock_guard lock(impl_->mutex);
  return **impl_->started;
}

bool ServerProcess::is_running() {
  const std::lock_guard lock(impl_->mutex);
  return !impl_->end_status;
}

bool ServerProcess::is_held_up() {
  if (!is_running()) return false;
  const auto threads = list_folder("/proc/" + std::to_string(pid()) + "/task");
  return threads && std::ranges::any_of(*threads, is_held_up_thread);
}

std::string ServerProcess::how_it_ended() {
  const std::lock_guard lock(impl_->mutex);
  return impl_->end_status ? told(*impl_->end_status) : std::string();
}

void ServerProcess::stop() {
  impl_->stop();
}

Result<fs::path> find_server_program() {
  if (auto program = find_program(kProgram)) return *std::move(program);
  return fail("the haptic server's program was not found", kProgram, "install it beside this program or on PATH");
}

}  // namespace trocar::link

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
