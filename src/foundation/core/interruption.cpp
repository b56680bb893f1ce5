#include "core/interruption.h"

#include <semaphore.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <ctime>
#include <thread>
#include <utility>

#include "core/files/unfinished_output.h"
#include "core/start_thread.h"

namespace trocar {
inline namespace core {
namespace {

constexpr time_t kGrace_s = 5;
constexpr int kFailed = 1;  // exit status

std::atomic<bool> was_signalled{false};
std::atomic<int> work_that_ends_by_itself{0};
sem_t signals;  // posted for each signal: sem_post is allowed in a handler

/// Never freed: the thread that waits for signals outlives main.
std::string& command_name() {
  static auto* const name = new std::string;
  return *name;
}

extern "C" void note_signal(int) {
  const int error = errno;
  was_signalled.store(true, std::memory_order_relaxed);
  ::sem_post(&signals);
  errno = error;
}

/// Waits for a signal, then for the end of interruptible work, unless a second signal arrives.
void wait_for_end() {
  while (::sem_wait(&signals) != 0) {
  }
  if (work_that_ends_by_itself.load() == 0) return;
  timespec until{};
  ::clock_gettime(CLOCK_REALTIME, &until);
  until.tv_sec += kGrace_s;
  while (::sem_timedwait(&signals, &until) != 0 && errno == EINTR) {
  }
}

void watch() {
  wait_for_end();
  end_without_unfinished_outputs([](const std::filesystem::path& output) {
    const Error error = output.empty() ? interruption_error(command_name())
                                       : Error{"interrupted, but the output is complete", output.string(),
                                               "remove it before you run the command again", kFailed};
    return "error: " + error.text();
  });
}

void handle(int signal_number) {
  struct sigaction before {};
  if (::sigaction(signal_number, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = note_signal;
  action.sa_flags = SA_RESTART;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(signal_number, &action, nullptr);
}

}  // namespace

Status handle_interruptions(std::string command) {
  command_name() = std::move(command);
  if (::sem_init(&signals, 0, 0) != 0) return {};
  TROCAR_TRY(std::thread thread, start_thread("signal", watch));
  thread.detach();
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) handle(signal_number);
  ::signal(SIGXFSZ, SIG_IGN);  // a file size limit is a write error, like a full disk
  return {};
}

bool is_interrupted() noexcept {
  return was_signalled.load(std::memory_order_relaxed);
}

Error interruption_error(const std::string& where) {
  return {"interrupted: nothing was written", where, "run the command again", kFailed};
}

InterruptibleWork::InterruptibleWork() noexcept {
  ++work_that_ends_by_itself;
}
InterruptibleWork::~InterruptibleWork() {
  --work_that_ends_by_itself;
}

}  // namespace core
}  // namespace trocar
