#include "devices/vendor/dynamic_library.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <link.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/files/input_file.h"
#include "core/result.h"

namespace trocar::devices::detail {

/// Loads a shared library in a child process first, because its constructors run code of another vendor: the child is
/// killed if they take longer than `timeout`, and its end does not end this program. `library`: as for dlopen().
/// A library that is loaded already, or that the loader does not find, passes. Errors: loading takes too long or ends
/// the child; no child can start.
Status try_library(const std::string& library, std::chrono::milliseconds timeout);

}  // namespace trocar::devices::detail

namespace trocar::devices {
namespace {

constexpr FileLimit kLibraryFile{FileKind::kOther, "library", std::uint64_t{1} << 30};

std::string last_dl_error() {
  const char* text = dlerror();
  return text != nullptr ? text : "no reason given";
}

/// Only the path of the environment variable if it is set, else the usual names.
std::vector<std::string> candidates_of(const LibraryPlace& place) {
  const char* named = std::getenv(place.variable);
  if (named != nullptr && *named != '\0') return {named};
  return {place.names.begin(), place.names.end()};
}

}  // namespace

Result<DynamicLibrary> DynamicLibrary::open(const LibraryPlace& place) {
  std::vector<std::string> reasons;
  for (std::string& candidate : candidates_of(place)) {
    if (candidate.find('/') != std::string::npos) {
      if (const auto regular = InputFile::open(candidate, kLibraryFile); !regular) {  // a pipe would block
        reasons.push_back(fmt::format("{}: {}", candidate, regular.error().what));
        continue;
      }
    }
    TROCAR_TRY_STATUS(detail::try_library(candidate, place.timeout));
    void* const handle = dlopen(candidate.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle != nullptr) return DynamicLibrary(handle, std::move(candidate));
    reasons.push_back(last_dl_error());
  }
  return fail(fmt::format("{} cannot be loaded", place.package), fmt::format("{}", fmt::join(reasons, "; ")),
              fmt::format("{}, or name the library in {}", place.advice, place.variable));
}

Result<void*> DynamicLibrary::find_symbol(const char* name) const {
  void* const symbol = dlsym(handle_, name);
  if (symbol != nullptr) return symbol;
  return fail(fmt::format("the library has no function {}", name), path_, "install a newer release of it");
}

}  // namespace trocar::devices

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
