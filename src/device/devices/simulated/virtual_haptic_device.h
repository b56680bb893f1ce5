#pragma once

#include <array>
#include <optional>

#include "devices/haptic_device.h"
#include "devices/simulated/detail/hand_motion.h"
#include "stylus/virtual_stylus.h"

namespace trocar::devices {

/// Simulation parameters in addition to the preset.
struct SimulatedDeviceParams {
  /// Delay of a written wrench in whole periods; it then acts for one period. With 1, the loop has the 1.5 periods of
  /// delay of physics.md H2. Range 0..8.
  int force_delay = 1;
  int reading_delay = 0;                 ///< Age of a reading in whole periods. Range 0..8.
  double inertia_kg_mm2 = 50.0;          ///< Stylus and gimbal about S, as in VirtualStylusParams.
  double gimbal_friction_nmm = 0.5;      ///< Coulomb friction of the gimbal. Range 0..20. [assumed]
  double gimbal_viscosity_nmms = 0.02;   ///< Range 0..1. [assumed]
  double wall_stiffness_n_per_mm = 5.0;  ///< Stiffness of the arm's end stops at the radius of the workspace. [assumed]
  /// Weight of the stylus with its attachment, and its lever as in DeviceCapability; absent: those of the preset, which
  /// the compensation uses. Without torque there is no lever.
  std::optional<double> weight_n, weight_lever_mm;
};

/// A simulated device in a simulated hand: a rigid stylus with the mass, weight, friction, encoders and limits of a
/// preset. The stylus is at rest in its holder until a hand first holds it. Gravity is along -z of D. Real-time safe
/// after construction.
class VirtualHapticDevice final : public HapticDevice {
 public:
  static constexpr int kMaxDelay = 8;

  VirtualHapticDevice(stylus::DevicePreset preset, const SimulatedDeviceParams& params) noexcept;

  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return "virtual:" + preset_.name; }
  /// Advances the stylus to `now_s`, in steps of at most 1 ms. A gap counts as at most 0.1 s.
  DeviceReading read(double now_s) noexcept override;
  /// Limits the wrench to the peaks of the preset; torque is ignored without motors for it. Returns false for an
  /// invalid wrench.
  bool write(const Wrench& wrench_D) noexcept override;
  /// Ignores an invalid target: a value is not finite, or an amount is negative.
  void hold(const DeviceHand& hand) noexcept override;
  bool is_in_real_hand() const noexcept override { return false; }
  Status reconnect() override { return {}; }

  /// The exact pose of the stylus, before encoder quantisation.
  const Pose& X_DS() const noexcept { return stylus_.X_PS; }
  const Vec3& v_D() const noexcept { return stylus_.v_P; }

 private:
  void step(double time_s, double dt_s) noexcept;
  stylus::StylusHold grip(const HandNow& hand) const noexcept;
  stylus::VirtualStylusParams stylus_params() const noexcept;
  Vec3 wall_n() const noexcept;
  DeviceReading tell() noexcept;

  stylus::DevicePreset preset_;
  SimulatedDeviceParams params_;
  DeviceHand hand_;
  bool was_ever_held_ = false;
  double placed_s_ = 0.0;  ///< Time of the last target with is_placed that was applied.

  stylus::VirtualStylusState stylus_;  ///< Its frame P is D.

  double last_s_ = 0.0;
  bool is_started_ = false;
  Wrench acting_D_;                                      ///< About S.
  Wrench commanded_D_;                                   ///< About S: last written wrench.
  std::array<Wrench, kMaxDelay + 1> written_{};          ///< commanded_D_ at the last reads, newest first.
  std::array<DeviceReading, kMaxDelay + 1> readings_{};  ///< Newest first.
};

}  // namespace trocar::devices
