// Crashes in a child process; the last wrench of its device is read from shared memory.
#include "server/crash_handler.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <exception>
#include <functional>
#include <thread>

#include "server/test/servo_rig.h"

namespace trocar::server {
namespace {

using namespace testing;  // the servo's

/// What a device was told last, outside of the process that told it.
struct Seen {
  std::atomic<double> force_n{0.0};
  std::atomic<int> writes{0};
  std::atomic<int> writes_by_servo{0};
};

class SeenDevice final : public devices::HapticDevice {
 public:
  explicit SeenDevice(Seen& seen) : seen_(seen), preset_(device_preset()) {}
  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return "seen"; }
  devices::DeviceReading read(double) noexcept override { return {}; }
  bool write(const Wrench& wrench_D) noexcept override {
    seen_.force_n = wrench_D.force_n.norm();
    ++seen_.writes;
    return true;
  }
  Status reconnect() override { return {}; }

 private:
  Seen& seen_;
  stylus::DevicePreset preset_;
};

/// Runs it in a child process. The signal that ended the child, 0: none.
int signal_of_child(const std::function<void()>& run) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGALRM, SIG_DFL);
    run();
    ::_exit(0);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

/// A loop that presses with 5 N until it is told to let go; `crash` is called in its thread after some periods.
void press(CrashHandler& handler, SeenDevice& device, Seen& seen, const std::function<void()>& crash) {
  handler.adopt_thread();
  Wrench pressing;
  pressing.force_n = {0.0, 0.0, 5.0};
  for (int i = 0;; ++i) {
    if (!handler.takes_over(false)) {
      device.write(pressing);
      ++seen.writes_by_servo;
    }
    if (i == 50 && crash) crash();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

class CrashHandlerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    void* memory = ::mmap(nullptr, sizeof(Seen), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(memory, MAP_FAILED);
    seen_ = new (memory) Seen;
  }
  void TearDown() override { ::munmap(seen_, sizeof(Seen)); }

  Seen* seen_ = nullptr;
};

TEST_F(CrashHandlerTest, CrashOfAnotherThreadEndsInZeroForce) {
  for (const int number : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE}) {
    const int ended_by = signal_of_child([&] {
      SeenDevice device(*seen_);
      CrashHandler handler(device);
      std::thread servo([&] { press(handler, device, *seen_, {}); });
      while (seen_->writes_by_servo < 10) std::this_thread::yield();
      ::raise(number);
    });
    EXPECT_EQ(ended_by, number) << "the signal still ends the process";
    EXPECT_GE(seen_->writes_by_servo, 10);
    EXPECT_EQ(seen_->force_n, 0.0) << "signal " << number;
    seen_->writes_by_servo = 0;
  }
}

TEST_F(CrashHandlerTest, CrashOfTheRealTimeThreadEndsInZeroForce) {
  const int ended_by = signal_of_child([&] {
    SeenDevice device(*seen_);
    CrashHandler handler(device);
    std::thread servo([&] { press(handler, device, *seen_, [] { ::raise(SIGSEGV); }); });
    servo.join();
  });
  EXPECT_EQ(ended_by, SIGSEGV);
  EXPECT_GE(seen_->writes_by_servo, 50);
  EXPECT_EQ(seen_->force_n, 0.0);
}

TEST_F(CrashHandlerTest, HungRealTimeThreadEndsInZeroForce) {
  const int ended_by = signal_of_child([&] {
    SeenDevice device(*seen_);
    CrashHandler handler(device);
    std::thread servo(
        [&] { press(handler, device, *seen_, [] { std::this_thread::sleep_for(std::chrono::hours(1)); }); });
    while (seen_->writes_by_servo < 51) std::this_thread::yield();
    std::terminate();
  });
  EXPECT_EQ(ended_by, SIGABRT);
  EXPECT_EQ(seen_->force_n, 0.0);
}

TEST_F(CrashHandlerTest, StackOverflowEndsInZeroForce) {
  const int ended_by = signal_of_child([&] {
    SeenDevice device(*seen_);
    CrashHandler handler(device);
    std::thread servo([&] { press(handler, device, *seen_, {}); });
    const CrashStack stack;
    while (seen_->writes_by_servo < 10) std::this_thread::yield();
    const std::function<int(int)> endless = [&](int depth) {
      volatile char page[4096];
      page[0] = static_cast<char>(depth);
      return endless(depth + 1) + page[0];
    };
    ::_exit(endless(0));
  });
  EXPECT_EQ(ended_by, SIGSEGV);
  EXPECT_EQ(seen_->force_n, 0.0);
}

TEST_F(CrashHandlerTest, LeavesAPausedDeviceToItsHolder) {
  SeenDevice device(*seen_);
  CrashHandler handler(device);
  EXPECT_FALSE(handler.takes_over(true));
  std::thread crashing([&] { handler.command_zero_force(); });
  while (!handler.takes_over(true)) std::this_thread::yield();
  crashing.join();
  EXPECT_EQ(seen_->writes, 0);
}

}  // namespace
}  // namespace trocar::server
