#include "devices/simulated/faulty_device.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"

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

}  // namespace trocar::devices
