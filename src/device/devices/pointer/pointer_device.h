#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "devices/haptic_device.h"
#include "realtime/lock_free.h"

namespace trocar::devices {

/// Parameters of the filter between the hand target and the pose. All [assumed].
struct PointerParams {
  double time_constant_s = 0.02;      ///< First order: smooths the steps between a trainer's frames. Range 0..0.5.
  double max_speed_mm_per_s = 400.0;  ///< Speed of a quick hand; turns a distant click into a motion. Range 10..5000.
  double max_turn_rad_per_s = 6.0;    ///< Range 0.1..100.
};

/// Mouse and keyboard of a trainer: the pose follows the trainer's hand target, smoothed. Written forces are only
/// displayed; the tick computes the lag of the pointer. Real-time safe after construction.
class PointerDevice final : public HapticDevice {
 public:
  PointerDevice(stylus::DevicePreset preset, const PointerParams& params) noexcept;

  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return preset_.name; }
  DeviceReading read(double now_s) noexcept override;
  /// Returns false for an invalid wrench.
  bool write(const Wrench& wrench_D) noexcept override;
  void hold(const DeviceHand& hand) noexcept override;
  bool is_in_real_hand() const noexcept override { return false; }
  Status reconnect() override { return {}; }

 private:
  stylus::DevicePreset preset_;
  PointerParams params_;
  DeviceHand hand_;
  Pose X_DS_;
  bool was_ever_held_ = false;
  double placed_s_ = 0.0;
  double last_s_ = 0.0;
  bool is_started_ = false;
};

/// Motion requested by a gamepad or SpaceMouse. Motions add up.
struct PointerMotion {
  Vec3 v_D = Vec3::Zero();         ///< mm/s
  double inward_mm_per_s = 0.0;    ///< Along +z of S: from the grip to the tip.
  Vec3 w_D = Vec3::Zero();         ///< rad/s, about the origin of S.
  double turning_rad_per_s = 0.0;  ///< About +z of S: turns the bevel.
  std::uint32_t buttons = 0;       ///< kButtonMain, kButtonSecond and higher bits.
};

/// Initial pose of a pointer: in the middle of the workspace, tip down, +x of S to the right.
Pose pointer_start() noexcept;

/// X_DS after `dt_s` of a motion. The origin stays within the sphere of the workspace and slides along its surface. A
/// non-finite motion or time, or a `dt_s` of zero or less, leaves the pose unchanged. Real-time safe.
Pose move_pointer(const Pose& X_DS, const PointerMotion& motion, double dt_s, double workspace_radius_mm) noexcept;

/// A gamepad or SpaceMouse whose state is polled. One thread calls all functions.
class PointerSource {
 public:
  virtual ~PointerSource() = default;
  PointerSource(const PointerSource&) = delete;
  PointerSource& operator=(const PointerSource&) = delete;

  virtual std::string name() const = 0;
  /// Finds and opens the device; may take a second. May be called again after close().
  virtual Status open() = 0;
  /// File descriptor that becomes readable when there is new data; -1: none.
  virtual int descriptor() const noexcept { return -1; }
  /// Sets `motion` to the present motion. Returns false if the device is disconnected.
  virtual bool poll(PointerMotion& motion) noexcept = 0;
  /// Displays a force (N) as rumble.
  virtual void show_force(double) noexcept {}
  virtual void close() noexcept = 0;

 protected:
  PointerSource() = default;
};

inline constexpr std::int64_t kPointerPeriod_ns = 4'000'000;  ///< The thread polls at 250 Hz. [assumed]
inline constexpr double kPointerSilence_s = 0.1;  ///< Without new data for this time, the stylus stops. [assumed]
inline constexpr double kPointerStep_s = 0.02;    ///< Longest time of motion per reading. [assumed]
/// Without a new wrench for this time, no force is rendered. [assumed]
inline constexpr std::int64_t kPointerForceAge_ns = 20'000'000;

/// A device based on a polled source: a thread polls the source, and each reading moves the stylus, so that every
/// reading has a new pose. Invariant: only that thread uses the source.
class PolledPointer final : public HapticDevice {
 public:
  static Result<std::unique_ptr<HapticDevice>> open(const stylus::DevicePreset& preset,
                                                    std::unique_ptr<PointerSource> source);
  ~PolledPointer() override;

  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return name_; }
  DeviceReading read(double now_s) noexcept override;
  bool write(const Wrench& wrench_D) noexcept override;
  /// Places the stylus at X_DS of a new target with `is_placed`. Other fields of the target are ignored.
  void hold(const DeviceHand& hand) noexcept override;
  Status reconnect() override;

 private:
  PolledPointer(const stylus::DevicePreset& preset, std::unique_ptr<PointerSource> source);
  Status start();
  void stop() noexcept;
  void run(std::promise<Status>& opened);
  void poll_until_stopped() noexcept;

  stylus::DevicePreset preset_;
  std::unique_ptr<PointerSource> source_;
  std::string name_;
  int wake_ = -1;  ///< Event descriptor that ends the thread's wait.
  std::thread thread_;
  std::atomic<bool> is_stopping_{false};
  std::atomic<bool> is_gone_{false};
  realtime::TripleBuffer<PointerMotion> motion_;  ///< From the thread to the reader.
  realtime::TripleBuffer<double> force_n_;        ///< From the writer to the thread.

  // Used only by the reader.
  Pose X_DS_ = pointer_start();
  double read_s_ = 0.0;
  double heard_s_ = 0.0;
  bool has_read_ = false;
  std::optional<double> placed_s_;  ///< Time of the last target with is_placed that was applied.
};

}  // namespace trocar::devices
