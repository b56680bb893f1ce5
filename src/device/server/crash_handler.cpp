#include "server/crash_handler.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <cstring>

namespace trocar::server {
namespace {

constexpr std::array kSignals{SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGXCPU};
constexpr std::size_t kMostDevices = 8;
/// The device's own thread sends a written wrench within this time. [assumed: ten periods of 1 kHz]
constexpr int kSent_ms = 10;
/// Time after which the process ends, even if a device's write() blocks.
constexpr unsigned kProcessEnds_s = 1;

// A signal handler can access data only through a global.
std::array<std::atomic<CrashHandler*>, kMostDevices> devices{};
std::atomic<pid_t> crashed_thread{0};

void sleep_ms(int ms) noexcept {
  constexpr long kNsPerMs = 1'000'000;
  timespec left{0, ms * kNsPerMs};
  ::nanosleep(&left, nullptr);
}

extern "C" void handle_crash(int number) {
  pid_t expected = 0;
  if (!crashed_thread.compare_exchange_strong(expected, ::gettid())) {
    if (expected != ::gettid()) {  // the first thread ends the process
      while (true) ::pause();
    }
  } else {
    ::alarm(kProcessEnds_s);
    bool has_device = false;
    for (auto& device : devices) {
      CrashHandler* const handler = device.load(std::memory_order_acquire);
      if (handler == nullptr) continue;
      handler->command_zero_force();
      has_device = true;
    }
    constexpr char kText[] = "trocar: the program crashed; zero force was commanded\n";
    if (has_device) [[maybe_unused]]
      const ssize_t written = ::write(STDERR_FILENO, kText, sizeof kText - 1);
  }
  struct sigaction ordinary {};
  ordinary.sa_handler = SIG_DFL;
  ::sigaction(number, &ordinary, nullptr);
  ::raise(number);  // it is blocked until the handler returns
}

void install() noexcept {
  struct sigaction action {};
  action.sa_handler = handle_crash;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (const int number : kSignals) ::sigaction(number, &action, nullptr);
}

}  // namespace

CrashHandler::CrashHandler(devices::HapticDevice& device) noexcept : device_(device) {
  install();
  for (auto& slot : devices) {
    CrashHandler* none = nullptr;
    if (slot.compare_exchange_strong(none, this)) return;
  }
}

CrashHandler::~CrashHandler() {
  for (auto& slot : devices) {
    CrashHandler* self = this;
    if (slot.compare_exchange_strong(self, nullptr)) return;
  }
}

void CrashHandler::adopt_thread() noexcept {
  thread_.store(::gettid(), std::memory_order_release);
}

bool CrashHandler::takes_over(bool is_leased) noexcept {
  if (!is_wanted_.load(std::memory_order_acquire)) return false;
  if (!is_done_.load(std::memory_order_acquire)) {
    if (!is_leased) device_.write(Wrench{});
    is_done_.store(true, std::memory_order_release);
  }
  return true;
}

void CrashHandler::command_zero_force() noexcept {
  is_wanted_.store(true, std::memory_order_release);
  const bool is_writer = thread_.load(std::memory_order_acquire) == ::gettid();
  for (int i = 0; i < kTimeout_ms && !is_writer && !is_done_.load(std::memory_order_acquire); ++i) sleep_ms(1);
  if (!is_done_.load(std::memory_order_acquire)) device_.write(Wrench{});
  sleep_ms(kSent_ms);
}

CrashStack::CrashStack() noexcept {
  stack_t stack{};
  stack.ss_sp = bytes_.data();
  stack.ss_size = bytes_.size();
  ::sigaltstack(&stack, nullptr);
}

CrashStack::~CrashStack() {
  stack_t none{};
  none.ss_flags = SS_DISABLE;
  ::sigaltstack(&none, nullptr);
}

}  // namespace trocar::server
