#include "devices/pointer/pointer_device.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/start_thread.h"
#include "devices/detail/factories.h"
#include "devices/simulated/detail/hand_motion.h"
#include "geometry/vec.h"
#include "realtime/periodic_loop.h"

namespace trocar::devices {
PointerDevice::PointerDevice(stylus::DevicePreset preset, const PointerParams& params) noexcept
    : preset_(std::move(preset)), params_(params) {}

void PointerDevice::hold(const DeviceHand& hand) noexcept {
  if (!is_valid(hand)) return;
  hand_ = hand;
  const bool is_new_place = hand.is_placed && (!was_ever_held_ || hand.time_s != placed_s_);
  if (is_new_place) placed_s_ = hand.time_s;
  if (is_new_place || (hand.is_held && !was_ever_held_)) {
    X_DS_ = hand.X_DS;
    was_ever_held_ = true;
  }
}

DeviceReading PointerDevice::read(double now_s) noexcept {
  if (!std::isfinite(now_s)) now_s = last_s_;
  DeviceReading reading;
  reading.buttons = hand_.buttons;
  const double dt_s = is_started_ ? std::clamp(now_s - last_s_, 0.0, kMaxGap_s) : 0.0;
  if (is_started_ && !(dt_s > 0.0)) reading.status = DeviceStatus::kRepeated;
  last_s_ = is_started_ ? std::max(now_s, last_s_) : now_s;
  is_started_ = true;
  if (dt_s > 0.0 && hand_.is_held) {
    const Pose X_DS_wanted = hand_at(hand_, now_s).X_DS;
    if (hand_.is_rigid) {
      X_DS_ = X_DS_wanted;
    } else {
      const double share = 1.0 - std::exp(-dt_s / std::max(params_.time_constant_s, 1e-6));
      const Vec3 step = clamped_norm(share * (X_DS_wanted.p() - X_DS_.p()), params_.max_speed_mm_per_s * dt_s);
      const Vec3 left = rotation_vector(X_DS_wanted.R() * X_DS_.R().transpose());
      const Vec3 turn = clamped_norm(share * left, params_.max_turn_rad_per_s * dt_s);
      const Eigen::Quaterniond turned(rotation_from_vector(turn) * X_DS_.R());
      X_DS_ = Pose(turned.normalized().toRotationMatrix(), X_DS_.p() + step);
    }
  }
  reading.X_DS = X_DS_;
  return reading;
}

bool PointerDevice::write(const Wrench& wrench_D) noexcept {
  return is_valid(wrench_D);
}

OpenedDevice open_pointer(const DeviceSpec&, const DeviceOptions& options) {
  TROCAR_TRY(stylus::DevicePreset preset, load_preset_of(options, "mouse"));
  return std::make_unique<PointerDevice>(std::move(preset), PointerParams{});
}

namespace {

bool is_finite(const PointerMotion& motion) noexcept {
  return motion.v_D.allFinite() && motion.w_D.allFinite() && std::isfinite(motion.inward_mm_per_s) &&
         std::isfinite(motion.turning_rad_per_s);
}

/// Waits for new data of the source, the end, or one period.
void wait_for_news(int wake, int source) noexcept {
  constexpr std::int64_t kNsPerMs = 1'000'000;
  std::array<pollfd, 2> watched{pollfd{wake, POLLIN, 0}, pollfd{source, POLLIN, 0}};
  ::poll(watched.data(), source >= 0 ? 2 : 1, static_cast<int>(kPointerPeriod_ns / kNsPerMs));
}

}  // namespace

Pose pointer_start() noexcept {
  return {Vec3(1.0, -1.0, -1.0).asDiagonal().toDenseMatrix(), Vec3::Zero()};
}

Pose move_pointer(const Pose& X_DS, const PointerMotion& motion, double dt_s, double workspace_radius_mm) noexcept {
  if (!is_finite(motion) || !(dt_s > 0.0) || !std::isfinite(dt_s)) return X_DS;
  const Vec3 v_D = motion.v_D + motion.inward_mm_per_s * X_DS.R().col(2);
  Vec3 p_DS = X_DS.p() + dt_s * v_D;
  clamp_norm(p_DS, workspace_radius_mm);
  const Mat3 R_DS = rotation_from_vector(dt_s * motion.w_D) * X_DS.R() *
                    rotation_from_vector(Vec3(0.0, 0.0, dt_s * motion.turning_rad_per_s));
  const Pose moved(Eigen::Quaterniond(R_DS).normalized().toRotationMatrix(), p_DS);
  return moved.is_finite() ? moved : X_DS;  // avoids huge velocities
}

Result<std::unique_ptr<HapticDevice>> PolledPointer::open(const stylus::DevicePreset& preset,
                                                          std::unique_ptr<PointerSource> source) {
  std::unique_ptr<PolledPointer> device(new PolledPointer(preset, std::move(source)));
  TROCAR_TRY_STATUS(device->start());
  return device;
}

PolledPointer::PolledPointer(const stylus::DevicePreset& preset, std::unique_ptr<PointerSource> source)
    : preset_(preset), source_(std::move(source)), name_(source_->name()) {}

PolledPointer::~PolledPointer() {
  stop();
}

Status PolledPointer::start() {
  wake_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (wake_ < 0) return fail("no event descriptor for the device's thread", name_, "close some programs");
  is_stopping_ = false;
  is_gone_ = true;
  force_n_.update();  // discards wrenches written before the device was opened
  const auto opened = std::make_shared<std::promise<Status>>();
  std::future<Status> outcome = opened->get_future();
  auto thread = start_thread("device", [this, opened] { run(*opened); });
  if (!thread) {
    stop();
    return tl::unexpected(std::move(thread).error());
  }
  thread_ = *std::move(thread);
  Status status = outcome.get();
  if (!status) stop();
  return status;
}

void PolledPointer::stop() noexcept {
  is_stopping_ = true;
  const std::uint64_t one = 1;
  if (wake_ >= 0 && ::write(wake_, &one, sizeof one) < 0) {
    // The thread also wakes after a period.
  }
  if (thread_.joinable()) thread_.join();
  if (wake_ >= 0) ::close(wake_);
  wake_ = -1;
}

void PolledPointer::run(std::promise<Status>& opened) {
  Status status = source_->open();
  const bool is_open = status.has_value();
  is_gone_.store(!is_open, std::memory_order_release);
  opened.set_value(std::move(status));
  if (!is_open) return;
  poll_until_stopped();
  source_->show_force(0.0);
  source_->close();
}

void PolledPointer::poll_until_stopped() noexcept {
  std::int64_t written_ns = 0;
  while (!is_stopping_.load(std::memory_order_relaxed)) {
    PointerMotion motion;
    if (!source_->poll(motion)) {
      is_gone_.store(true, std::memory_order_release);
      return;
    }
    motion_.write(motion);
    const std::int64_t now = realtime::now_ns();
    if (force_n_.update()) written_ns = now;
    source_->show_force(now - written_ns <= kPointerForceAge_ns ? force_n_.value() : 0.0);
    wait_for_news(wake_, source_->descriptor());
  }
}

DeviceReading PolledPointer::read(double now_s) noexcept {
  if (is_gone_.load(std::memory_order_acquire)) return {DeviceStatus::kDisconnected, X_DS_, 0};
  if (!std::isfinite(now_s)) now_s = read_s_;
  const bool has_news = motion_.update();
  if (has_news) heard_s_ = now_s;
  const double dt_s = has_read_ ? std::min(now_s - read_s_, kPointerStep_s) : 0.0;
  read_s_ = now_s;
  has_read_ = has_read_ || has_news;
  const bool is_silent = !has_read_ || now_s - heard_s_ > kPointerSilence_s;
  if (is_silent) return {DeviceStatus::kRepeated, X_DS_, motion_.value().buttons};
  X_DS_ = move_pointer(X_DS_, motion_.value(), dt_s, preset_.workspace_radius_mm);
  return {DeviceStatus::kFresh, X_DS_, motion_.value().buttons};
}

bool PolledPointer::write(const Wrench& wrench_D) noexcept {
  const double force_n = wrench_D.force_n.norm();
  const bool is_taken = std::isfinite(force_n) && !is_gone_.load(std::memory_order_acquire);
  force_n_.write(is_taken ? force_n : 0.0);
  return is_taken;
}

void PolledPointer::hold(const DeviceHand& hand) noexcept {
  if (!hand.is_placed || placed_s_ == hand.time_s || !hand.X_DS.is_finite()) return;
  placed_s_ = hand.time_s;
  X_DS_ = hand.X_DS;
}

Status PolledPointer::reconnect() {
  stop();
  motion_.update();  // discards data of the previous connection
  has_read_ = false;
  return start();
}

}  // namespace trocar::devices
