#include "test_mode.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <thread>

#include "realtime/periodic_loop.h"
#include "server/device_trial.h"

namespace trocar {
namespace {

constexpr double kPrinted_hz = 30.0;

/// Commands on standard input.
struct Wishes {
  std::atomic<bool> pushes{false};
  std::atomic<bool> ends{false};
};

/// Runs until end of input or a signal; SIGINT and SIGTERM are blocked in all threads (main.cpp).
void read_wishes(Wishes& wishes) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  const int signal_file = ::signalfd(-1, &signals, SFD_CLOEXEC);
  std::array<pollfd, 2> sources{pollfd{STDIN_FILENO, POLLIN, 0}, pollfd{signal_file, POLLIN, 0}};
  std::string line;
  char c = 0;
  while (::poll(sources.data(), sources.size(), -1) > 0 && sources[1].revents == 0 &&
         ::read(STDIN_FILENO, &c, 1) == 1) {
    if (c != '\n') {
      line += c;
      continue;
    }
    if (line == "push") wishes.pushes = true;
    line.clear();
  }
  ::close(signal_file);
  wishes.ends = true;
}

void print_state(const server::DeviceTrialRecord& record, double strongest_n) {
  const Vec3& p = record.reading.X_DS.p();
  const Vec3 axis = record.reading.X_DS.R().col(2);
  const bool is_there = record.reading.status != devices::DeviceStatus::kDisconnected;
  fmt::print("state\t{:.2f}\t{:.2f}\t{:.2f}\t{:.4f}\t{:.4f}\t{:.4f}\t{}\t{:d}\t{:.2f}\t{}\n", p.x(), p.y(), p.z(),
             axis.x(), axis.y(), axis.z(), record.reading.buttons, is_there, strongest_n, to_string(record.fault));
  std::fflush(stdout);
}

}  // namespace

void test_device(devices::HapticDevice& device, double rate_hz) {
  server::DeviceTrial trial(device, rate_hz);
  const haptics::DevicePreset& preset = device.preset();
  fmt::print("device\t{}\t{}\t{}\t{:.2f}\t{:d}\n", device.name(), preset.title, preset.sensed_dof, trial.push_n(),
             preset.has_force());
  std::fflush(stdout);
  Wishes wishes;
  std::jthread reader([&wishes] { read_wishes(wishes); });
  const auto periods_a_line = static_cast<std::uint64_t>(std::max(1.0, rate_hz / kPrinted_hz));
  std::uint64_t made = 0;
  double strongest_n = 0.0;
  const auto period_ns = static_cast<std::int64_t>(1e9 / rate_hz);
  realtime::LoopStatistics statistics(period_ns);
  realtime::run_periodic(period_ns, wishes.ends, statistics,
                         [&](const realtime::Period& period, const realtime::LoopStatistics&) {
                           if (wishes.pushes.exchange(false)) trial.push();
                           const server::DeviceTrialRecord record = trial.step(period.now_s, period.dt_s);
                           strongest_n = std::max(strongest_n, record.written_D.force_n.norm());
                           if (++made % periods_a_line != 0) return;
                           print_state(record, strongest_n);
                           strongest_n = 0.0;
                         });
}

}  // namespace trocar
