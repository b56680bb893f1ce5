#pragma once

#include <cstdint>
#include <string>

#include "core/result.h"
#include "geometry/pose.h"
#include "haptics/coupling/device_preset.h"
#include "haptics/insertion/path_constraint.h"  // Wrench

namespace trocar::devices {

/// Status of a reading.
enum class DeviceStatus : std::uint8_t {
  kFresh,         ///< Read just now.
  kRepeated,      ///< No new data; the last reading repeated.
  kDisconnected,  ///< Gone, until it is opened again.
};

inline constexpr std::uint32_t kButtonMain = 1;  ///< The stylus' (first) button.
inline constexpr std::uint32_t kButtonSecond = 2;

/// What a device senses.
struct DeviceReading {
  DeviceStatus status = DeviceStatus::kFresh;
  Pose X_DS;                  ///< Stylus in the device base; identity rotation if the device senses none.
  std::uint32_t buttons = 0;  ///< Bits.
};

/// Target pose of a simulated hand or pointer, for devices that no person holds.
struct DeviceHand {
  Pose X_DS;
  Vec3 v_D = Vec3::Zero();  ///< mm/s
  Vec3 w_D = Vec3::Zero();  ///< rad/s
  double time_s = 0.0;      ///< When it is meant for, steady clock of the server.
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
  bool is_rigid = false;   ///< Follows exactly, independent of the force.
  bool is_placed = false;  ///< Placed there now, at rest.
};

/// One haptic device. Opened by a factory, closed by its destructor (at zero force). read, write and hold are called by
/// one real-time thread, once a period each: read, hold, write. Plug point of the server: one derived class a device,
/// in a file of its own.
class HapticDevice {
 public:
  virtual ~HapticDevice() = default;
  HapticDevice(const HapticDevice&) = delete;
  HapticDevice& operator=(const HapticDevice&) = delete;

  /// Limits of the device: from data/devices.toml, lowered to the values that the device reports. Constant while open.
  virtual const haptics::DevicePreset& preset() const noexcept = 0;
  /// "virtual:premium", for people and records.
  virtual std::string name() const = 0;
  /// The pose now, at a time of the steady clock (s). Real-time safe.
  virtual DeviceReading read(double now_s) noexcept = 0;
  /// Wrench for the motors, in D about S. Returns false if it was not accepted. Real-time safe.
  virtual bool write(const haptics::Wrench& wrench_D) noexcept = 0;
  /// For devices that nobody really holds; ignored by all others. Real-time safe.
  virtual void hold(const DeviceHand&) noexcept {}
  /// True if a person's hand holds it (it is never completely at rest); false: simulated or recorded hand.
  virtual bool is_in_real_hand() const noexcept { return true; }
  /// Reopens the device after kDisconnected. Call it from a thread that may block, while no other thread calls read or
  /// write.
  virtual Status reconnect() = 0;

 protected:
  HapticDevice() = default;
};

}  // namespace trocar::devices
