#include "devices/simulated/faulty_device.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "core/random.h"
#include "core/text.h"

namespace trocar::devices {
namespace {

/// Waits once, even if woken early: bounded.
void sleep_ms(void*, double wait_ms) noexcept {
  constexpr double kMsPerS = 1e3;
  constexpr double kNsPerMs = 1e6;
  const double whole_s = std::floor(wait_ms / kMsPerS);
  timespec wait{};
  wait.tv_sec = static_cast<time_t>(whole_s);
  wait.tv_nsec = static_cast<long>((wait_ms - whole_s * kMsPerS) * kNsPerMs);
  nanosleep(&wait, nullptr);
}

}  // namespace

FaultyDevice::FaultyDevice(std::unique_ptr<HapticDevice> device, std::vector<ScheduledFault> faults, std::uint64_t seed,
                           Wait wait)
    : device_(std::move(device)),
      faults_(std::move(faults)),
      seed_(seed),
      wait_(wait.wait != nullptr ? wait : Wait{sleep_ms, nullptr}) {}

const ScheduledFault* FaultyDevice::find_active(DeviceFault fault) const noexcept {
  for (const ScheduledFault& scheduled : faults_) {
    const bool is_now = time_s_ >= scheduled.from_s && time_s_ < scheduled.from_s + scheduled.for_s;
    if (scheduled.fault == fault && is_now) return &scheduled;
  }
  return nullptr;
}

void FaultyDevice::wait_for(DeviceFault fault) const noexcept {
  if (const ScheduledFault* slow = find_active(fault))
    wait_.wait(wait_.context, std::clamp(slow->amount, 0.0, kMaxSlow_ms));
}

void FaultyDevice::shake(Pose& X_DS) noexcept {
  const ScheduledFault* jitter = find_active(DeviceFault::kJitter);
  const ScheduledFault* jump = find_active(DeviceFault::kJump);
  Vec3 off_D = Vec3::Zero();
  if (jump != nullptr) off_D.x() += jump->amount;
  if (jitter != nullptr) {
    for (double& off : off_D) off += jitter->amount * (2.0 * uniform01(seed_, drawn_++) - 1.0);
  }
  if (jump != nullptr || jitter != nullptr) X_DS = Pose(X_DS.R(), X_DS.p() + off_D);
}

/// As with an unplugged cable: the motors are off, and the last pose is repeated.
DeviceReading FaultyDevice::disconnected() noexcept {
  if (!is_disconnected_) device_->write({});
  is_disconnected_ = true;
  DeviceReading reading = last_;
  reading.status = DeviceStatus::kDisconnected;
  return reading;
}

DeviceReading FaultyDevice::read(double now_s) noexcept {
  if (!is_started_) start_s_ = now_s;
  is_started_ = true;
  time_s_ = now_s - start_s_;
  wait_for(DeviceFault::kSlowRead);
  DeviceReading reading = device_->read(now_s);
  is_inner_gone_ = reading.status == DeviceStatus::kDisconnected;
  if (!has_last_) last_ = reading;
  has_last_ = true;

  if (is_disconnected_ || find_active(DeviceFault::kDisconnect) != nullptr) return disconnected();
  if (is_inner_gone_) return reading;
  if (find_active(DeviceFault::kDropped) != nullptr) {
    reading = last_;
    reading.status = DeviceStatus::kRepeated;
    return reading;
  }
  if (find_active(DeviceFault::kStuck) != nullptr) {
    reading.X_DS = last_.X_DS;
    return reading;
  }
  shake(reading.X_DS);
  last_ = reading;
  if (find_active(DeviceFault::kNan) != nullptr) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    reading.X_DS = Pose(Mat3::Constant(kNan), Vec3::Constant(kNan));
  }
  return reading;
}

bool FaultyDevice::write(const Wrench& wrench_D) noexcept {
  wait_for(DeviceFault::kSlowWrite);
  return !is_disconnected_ && device_->write(wrench_D);
}

Status FaultyDevice::reconnect() {
  const ScheduledFault* fault = find_active(DeviceFault::kDisconnect);
  if (fault != nullptr && std::isinf(fault->for_s)) {
    return fail("the device stays unplugged", name(), "omit the fault disconnect");
  }
  if (is_inner_gone_) TROCAR_TRY_STATUS(device_->reconnect());
  is_disconnected_ = false;
  return {};
}

namespace {

/// Range of the number after the colon; high = 0 for kinds without one.
struct FaultKind {
  DeviceFault fault;
  const char* name;
  const char* unit;
  double high;
};
constexpr std::array kFaults{
    FaultKind{DeviceFault::kJitter, "jitter", "mm", 1000.0},
    FaultKind{DeviceFault::kDropped, "dropped", "", 0.0},
    FaultKind{DeviceFault::kNan, "nan", "", 0.0},
    FaultKind{DeviceFault::kStuck, "stuck", "", 0.0},
    FaultKind{DeviceFault::kJump, "jump", "mm", 10000.0},
    FaultKind{DeviceFault::kDisconnect, "disconnect", "", 0.0},
    FaultKind{DeviceFault::kSlowWrite, "slow_write", "ms", kMaxSlow_ms},
    FaultKind{DeviceFault::kSlowRead, "slow_read", "ms", kMaxSlow_ms},
};
constexpr double kMaxTime_s = 1e6;

const FaultKind* find_fault(std::string_view name) noexcept {
  for (const FaultKind& kind : kFaults)
    if (name == kind.name) return &kind;
  return nullptr;
}

/// A number from 0 to `high`.
std::optional<double> parse_number_below(std::string_view text, double high) noexcept {
  const auto value = parse_number<double>(text);
  return value && *value >= 0.0 && *value <= high ? value : std::nullopt;
}

tl::unexpected<Error> refuse(std::string_view text, std::string what) {
  return fail_usage(
      std::move(what), fmt::format("fault \"{}\"", text),
      "write KIND[:AMOUNT]@FROM_S[+FOR_S], as in jitter:0.3@1+2; kinds are jitter:MM, dropped, nan, stuck, "
      "jump:MM, disconnect, slow_write:MS, slow_read:MS");
}

}  // namespace

const char* to_string(DeviceFault fault) noexcept {
  for (const FaultKind& kind : kFaults)
    if (kind.fault == fault) return kind.name;
  return "";
}

Result<ScheduledFault> parse_fault(std::string_view text) {
  const std::size_t at = text.find('@');
  if (at == std::string_view::npos) return refuse(text, "the fault has no start time");
  const std::string_view what = text.substr(0, at);
  const std::string_view when = text.substr(at + 1);
  const std::size_t colon = what.find(':');
  const FaultKind* kind = find_fault(what.substr(0, colon));
  if (kind == nullptr) return refuse(text, "unknown fault");

  ScheduledFault fault;
  fault.fault = kind->fault;
  const bool takes_amount = kind->high > 0.0;
  if (takes_amount != (colon != std::string_view::npos)) {
    return refuse(text, takes_amount ? fmt::format("{} needs an amount in {}", kind->name, kind->unit)
                                     : fmt::format("{} takes no amount", kind->name));
  }
  if (takes_amount) {
    const auto amount = parse_number_below(what.substr(colon + 1), kind->high);
    if (!amount) return refuse(text, fmt::format("the amount is not a number of 0..{} {}", kind->high, kind->unit));
    fault.amount = *amount;
  }

  const std::size_t plus = when.find('+');
  const auto from_s = parse_number_below(when.substr(0, plus), kMaxTime_s);
  if (!from_s) return refuse(text, fmt::format("the start is not a number of 0..{} s", kMaxTime_s));
  fault.from_s = *from_s;
  fault.for_s = std::numeric_limits<double>::infinity();
  if (plus == std::string_view::npos) return fault;
  const auto for_s = parse_number_below(when.substr(plus + 1), kMaxTime_s);
  if (!for_s) return refuse(text, fmt::format("its duration is not a number of 0..{} s", kMaxTime_s));
  fault.for_s = *for_s;
  return fault;
}

}  // namespace trocar::devices
