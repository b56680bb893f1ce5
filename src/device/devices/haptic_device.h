#pragma once

#include <cstdint>
#include <string>

#include "core/result.h"
#include "geometry/pose.h"
#include "geometry/vec.h"
#include "stylus/device_preset.h"

namespace trocar::devices {

/// Status of a reading.
enum class DeviceStatus : std::uint8_t {
  kFresh,         ///< Read just now.
  kRepeated,      ///< No new data; the last reading is repeated.
  kDisconnected,  ///< The device is disconnected until it is opened again.
};

inline constexpr std::uint32_t kButtonMain = 1;  ///< First button of the stylus.
inline constexpr std::uint32_t kButtonSecond = 2;

/// Reading of a device: pose, buttons and status.
struct DeviceReading {
  DeviceStatus status = DeviceStatus::kFresh;
  Pose X_DS;                  ///< Stylus in the device base; identity rotation if the device senses no rotation.
  std::uint32_t buttons = 0;  ///< Button bits.
};

/// Target pose of a simulated hand or pointer, for devices that no person holds.
struct DeviceHand {
  Pose X_DS;
  Vec3 v_D = Vec3::Zero();  ///< mm/s
  Vec3 w_D = Vec3::Zero();  ///< rad/s
  double time_s = 0.0;      ///< Time of the target, steady clock of the server.
  double stiffness_n_per_mm = 0.0;
  double damping_ns_per_mm = 0.0;
  double mass_kg = 0.0;
  double turning_nmm_per_rad = 0.0;
  double turning_damping_nmms_per_rad = 0.0;
  double inertia_kg_mm2 = 0.0;
  /// Position of the hand's spring along +z of S: 0 at the grip, the needle's length at the tip.
  double point_mm = 0.0;
  std::uint32_t buttons = 0;
  bool is_held = false;    ///< false: released.
  bool is_rigid = false;   ///< The stylus follows the target exactly, independent of the force.
  bool is_placed = false;  ///< The stylus is placed at X_DS now, at rest.
};

/// One haptic device. A factory opens it; its destructor closes it at zero force. One real-time thread calls read, hold
/// and write, in this order, once per period each. Extension point of the server: each device has one derived class in
/// its own file.
class HapticDevice {
 public:
  virtual ~HapticDevice() = default;
  HapticDevice(const HapticDevice&) = delete;
  HapticDevice& operator=(const HapticDevice&) = delete;

  /// Limits of the device: from data/devices.toml, lowered to the values that the device reports. Constant while open.
  virtual const stylus::DevicePreset& preset() const noexcept = 0;
  /// Name for messages and records, for example "virtual:premium".
  virtual std::string name() const = 0;
  /// Reads the present pose. `now_s`: time of the steady clock (s). Real-time safe.
  virtual DeviceReading read(double now_s) noexcept = 0;
  /// Wrench for the motors, in D about S. Returns false if it was not accepted. Real-time safe.
  virtual bool write(const Wrench& wrench_D) noexcept = 0;
  /// Sets the hand target of devices that no person holds; all other devices ignore it. Real-time safe.
  virtual void hold(const DeviceHand&) noexcept {}
  /// True if a person's hand holds the device (never completely at rest); false: simulated or recorded hand.
  virtual bool is_in_real_hand() const noexcept { return true; }
  /// Reopens the device after kDisconnected. Call it from a thread that may block, while no other thread calls read or
  /// write.
  virtual Status reconnect() = 0;

 protected:
  HapticDevice() = default;
};

}  // namespace trocar::devices
