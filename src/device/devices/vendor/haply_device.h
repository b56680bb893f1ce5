#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "devices/haptic_device.h"
#include "realtime/lock_free.h"

namespace trocar::devices {

inline constexpr const char* kHaplyAddress = "ws://localhost:10001";  ///< Source: the vendor's documentation.
inline constexpr std::int64_t kHaplyPeriod_ns = 500'000;  ///< Period of one state and its command: 2 kHz. [assumed]
inline constexpr std::int64_t kHaplyForceAge_ns =
    20'000'000;                                ///< No force after this time without a new wrench. [assumed]
inline constexpr int kHaplyMostUnusable = 50;  ///< Consecutive unreadable messages after which the device counts as
                                               ///< disconnected. [assumed]

class WebSocket;
struct HaplyState;

/// A Haply Inverse3 with its grip, through the Inverse service. It senses position and orientation and renders a force,
/// but no torque. A thread replies to each state with one command. The rate is that of the service's states, with a
/// period of at least kHaplyPeriod_ns. The device is closed at zero force. Invariant: while the thread runs, only the
/// thread uses the connection.
class HaplyDevice final : public HapticDevice {
 public:
  /// `address`: "ws://HOST:PORT" for the first Inverse3 of the service, or "ws://HOST:PORT#ID" for the one with this
  /// id. Without a grip the device senses 3 degrees of freedom, independent of the preset. reconnect() opens the same
  /// device; it needs a grip if the device had one.
  static Result<std::unique_ptr<HapticDevice>> open(const stylus::DevicePreset& preset, const std::string& address);
  ~HaplyDevice() override;

  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return name_of(address_); }
  static std::string name_of(const std::string& address) { return "haply:" + address; }
  DeviceReading read(double now_s) noexcept override;
  bool write(const Wrench& wrench_D) noexcept override;
  Status reconnect() override;

 private:
  struct Sample {
    Pose X_DS;
    std::uint32_t buttons = 0;
  };

  HaplyDevice(const stylus::DevicePreset& preset, std::string address);
  Status start();
  Status take_first_state(const std::string& message);
  void stop() noexcept;
  void run();
  Pose pose_of(HaplyState state) const noexcept;
  bool take_state(const std::string& message);
  bool answer(const Vec3& f_D);
  bool wait_for_state(std::string& message);
  Vec3 force_now() noexcept;
  void say_goodbye(bool is_answer_due);

  stylus::DevicePreset preset_;
  std::string address_;
  std::string device_id_;  ///< Empty until a device is found.
  bool is_centred_ = false;
  std::optional<bool> has_grip_;  ///< Set when the device is first found.
  int unusable_ = 0;
  std::int64_t written_ns_ = 0;
  std::unique_ptr<WebSocket> socket_;
  std::thread thread_;
  std::atomic<bool> is_stopping_{false};
  std::atomic<bool> is_gone_{false};
  realtime::TripleBuffer<Sample> state_;               ///< From the thread to the reader.
  realtime::TripleBuffer<Vec3> force_{Vec3(0, 0, 0)};  ///< N in D, from the writer to the thread.
};

}  // namespace trocar::devices
