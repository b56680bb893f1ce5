#include "test_mode.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <thread>

#include "core/start_thread.h"
#include "devices/workspace_map.h"
#include "realtime/periodic_loop.h"
#include "server/device_trial.h"

namespace trocar {
namespace {

constexpr double kPrinted_hz = 30.0;
constexpr double kWeight_n = 0.001, kLever_mm = 0.1;  ///< Steps of a saved weight.
constexpr std::size_t kLongestLine = 64;              ///< Longer ones are no command.

/// Commands on standard input.
struct Wishes {
  std::atomic<int> pushes{0};
  std::atomic<bool> weighs{false};
  std::atomic<bool> forgets{false};
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
      if (line.size() <= kLongestLine) line += c;
      continue;
    }
    if (line == "push") ++wishes.pushes;
    if (line == "weigh") wishes.weighs = true;
    if (line == "forget") wishes.forgets = true;
    line.clear();
  }
  ::close(signal_file);
  wishes.ends = true;
}

void print_state(const server::DeviceTrialRecord& record, double strongest_n, int ended_pushes) {
  const Vec3& p = record.reading.X_DS.p();
  const Vec3 axis = record.reading.X_DS.R().col(2);
  const bool is_there = record.reading.status != devices::DeviceStatus::kDisconnected;
  fmt::print("state\t{:.2f}\t{:.2f}\t{:.2f}\t{:.4f}\t{:.4f}\t{:.4f}\t{}\t{:d}\t{:.2f}\t{}\t{}\n", p.x(), p.y(), p.z(),
             axis.x(), axis.y(), axis.z(), record.reading.buttons, is_there, strongest_n, to_string(record.fault),
             ended_pushes);
  std::fflush(stdout);
}

double rounded(double value, double step) {
  return std::round(value / step) * step;
}

void print_line(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

/// Saves the weight and prints it with its use; a refusal or a failure is printed instead.
void report(const server::WeighResult& result, const devices::HapticDevice& device,
            const std::filesystem::path& folder) {
  if (result.refusal != server::WeighRefusal::kNone)
    return print_line("refused\t" + server::weigh_error(result, device.name()).text());
  std::string use = " It was not saved.";
  if (!folder.empty()) {
    devices::StylusProfile profile{device.name(), device.preset().name, rounded(result.weight_n, kWeight_n), {}};
    if (result.lever_mm) profile.lever_mm = rounded(*result.lever_mm, kLever_mm);
    if (const Status saved = devices::save_stylus_profile(profile, folder); !saved)
      return print_line("refused\t" + saved.error().text());
    use = fmt::format(" Saved in {}; the server compensates it from its next start. \"forget\" deletes it.",
                      devices::stylus_profile_file(folder, profile.device).string());
  }
  print_line(fmt::format("weighed\t{:.3f}\t{:.3f}\t{:.3f}\t{:.3f}\t{}\t{}{}", result.weight_n, result.friction_n,
                         result.horizontal_n, result.spread_n,
                         result.lever_mm ? fmt::format("{:.1f}", *result.lever_mm) : "-",
                         server::weigh_text(result, device.preset()), use));
}

void forget(const std::string& device, const std::filesystem::path& folder) {
  if (folder.empty()) return print_line("forgot\tNo weight is saved for this device.");
  const Result<bool> removed = devices::remove_stylus_profile(folder, device);
  if (!removed) return print_line("refused\t" + removed.error().text());
  print_line(*removed ? "forgot\tThe saved weight is deleted; the preset's applies from the server's next start."
                      : "forgot\tNo weight is saved for this device.");
}

/// Weighing on request. Files are written without force, because they can delay a period.
class Weighing {
 public:
  Weighing(server::DeviceTrial& trial, devices::HapticDevice& device, std::filesystem::path folder)
      : trial_(trial), device_(device), folder_(std::move(folder)) {}

  void start() {
    if (trial_.is_weighing()) return;
    trial_.weigh(Pose(rotation_between(Vec3::UnitZ(), Vec3::UnitY()), Vec3::Zero()));
    if (!trial_.is_weighing()) return;  // refused
    print_line(
        "weighing\tHold the stylus level in the middle of the workspace. Let it go after 2 s, keep your hand below "
        "it, and wait 20 s; it sinks at the end.");
  }
  void take(const server::DeviceTrialRecord& record, Wishes& wishes) {
    if (record.weighed) ended_ = record.weighed;
    if (record.is_weighing || record.written_D.force_n != Vec3::Zero()) return;
    if (wishes.forgets.exchange(false)) forget(device_.name(), folder_);
    if (!ended_) return;
    report(*ended_, device_, folder_);
    ended_.reset();
  }

 private:
  server::DeviceTrial& trial_;
  devices::HapticDevice& device_;
  std::filesystem::path folder_;
  std::optional<server::WeighResult> ended_;
};

}  // namespace

Status test_device(devices::HapticDevice& device, double rate_hz, int priority,
                   const std::filesystem::path& stylus_folder) {
  server::DeviceTrial trial(device, rate_hz);
  const stylus::DevicePreset& preset = device.preset();
  fmt::print("device\t{}\t{}\t{}\t{:.2f}\t{:d}\n", device.name(), preset.title, preset.sensed_dof, trial.push_n(),
             preset.has_force());
  std::fflush(stdout);
  Weighing weighing(trial, device, stylus_folder);
  Wishes wishes;
  TROCAR_TRY(const std::jthread reader,
             start_stoppable_thread("input", [&wishes](const std::stop_token&) { read_wishes(wishes); }));
  if (priority > 0) realtime::request_real_time(priority);
  const auto periods_a_line = static_cast<std::uint64_t>(std::max(1.0, rate_hz / kPrinted_hz));
  std::uint64_t made = 0;
  double strongest_n = 0.0;
  int pushes = 0, ended_pushes = 0;
  const auto period_ns = static_cast<std::int64_t>(1e9 / rate_hz);
  realtime::LoopStatistics statistics(period_ns);
  realtime::run_periodic(period_ns, wishes.ends, statistics,
                         [&](const realtime::Period& period, const realtime::LoopStatistics&) {
                           if (const int wished = wishes.pushes.exchange(0); wished > 0) {
                             trial.push();
                             pushes += wished;
                           }
                           if (wishes.weighs.exchange(false)) weighing.start();
                           const server::DeviceTrialRecord record = trial.step(period.now_s, period.dt_s);
                           if (!record.is_pushing) ended_pushes = pushes;
                           weighing.take(record, wishes);
                           strongest_n = std::max(strongest_n, record.written_D.force_n.norm());
                           if (++made % periods_a_line != 0) return;
                           print_state(record, strongest_n, ended_pushes);
                           strongest_n = 0.0;
                         });
  if (wishes.forgets) forget(device.name(), stylus_folder);  // the input ended before a period took it
  return {};
}

}  // namespace trocar
