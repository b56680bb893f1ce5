#include "devices/vendor/detail/library_trial.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <link.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <string_view>
#include <thread>

namespace trocar::devices::detail {
namespace {

constexpr std::chrono::milliseconds kLook{2};  ///< Interval between two looks at the child.
constexpr int kNoLibrary = 1;                  ///< Exit status of a child whose dlopen() gives an error.
constexpr const char* kReinstall = "reinstall the vendor's software; restart the computer if a driver hangs";

bool is_loaded(const std::string& library) {
  struct Search {
    std::string_view library;
    bool is_found = false;
  } search{library};
  ::dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* data) {
        auto& wanted = *static_cast<Search*>(data);
        const std::string_view path = info->dlpi_name;
        const bool is_path = wanted.library.find('/') != std::string_view::npos;
        wanted.is_found = (is_path ? path : path.substr(path.rfind('/') + 1)) == wanted.library;
        return static_cast<int>(wanted.is_found);
      },
      &search);
  return search.is_found;
}

/// In the child: its output would come twice.
[[noreturn]] void load_and_end(const char* library) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  ::_exit(::dlopen(library, RTLD_NOW | RTLD_LOCAL) != nullptr ? 0 : kNoLibrary);
}

/// The status of the child's end; empty: it has not ended in time, and was killed.
std::optional<int> end_of(pid_t child, std::chrono::milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() >= end) {
      ::kill(child, SIGKILL);
      while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
      }
      return std::nullopt;
    }
    std::this_thread::sleep_for(kLook);
  }
  return status;
}

}  // namespace

Status try_library(const std::string& library, std::chrono::milliseconds timeout) {
  if (is_loaded(library)) return {};
  const pid_t child = ::fork();
  if (child == 0) load_and_end(library.c_str());
  if (child < 0)
    return fail(fmt::format("no process to try the library: {}", std::strerror(errno)), library,
                "end other programs, or raise the limit on processes (ulimit -u)");
  const std::optional<int> status = end_of(child, timeout);
  if (!status)
    return fail(
        fmt::format("loading the library takes longer than {} s", std::chrono::duration<double>(timeout).count()),
        library, kReinstall);
  const bool has_answer = WIFEXITED(*status) && (WEXITSTATUS(*status) == 0 || WEXITSTATUS(*status) == kNoLibrary);
  if (has_answer) return {};  // the loader's own message follows
  const std::string how = WIFSIGNALED(*status) ? fmt::format("signal {}", WTERMSIG(*status))
                                               : fmt::format("exit status {}", WEXITSTATUS(*status));
  return fail(fmt::format("loading the library ends the program ({})", how), library, kReinstall);
}

}  // namespace trocar::devices::detail
