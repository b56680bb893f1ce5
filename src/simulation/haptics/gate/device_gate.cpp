#include "haptics/gate/device_gate.h"

#include <algorithm>

namespace trocar::haptics {
namespace {

// Known ratios: 6.2/37.5 N and 0.88/3.3 N, 188/515 N mm (data/devices.toml, premium and omni).
constexpr double kContinuousForceShare = 0.2;   // [assumed, 0.15..0.5]
constexpr double kContinuousTorqueShare = 0.3;  // [assumed, 0.15..0.5]
constexpr double kLooseHand_ns_per_mm = 0.003;  // a quarter of the hand of H1 [assumed, 0.001..0.012]
constexpr double kNeverVibrating_mw = 1e6;      // end of the gate's range
constexpr double kSoftestScale = 0.1;           // a smaller value would disable the energy account [assumed]

}  // namespace

GateParams gate_params(const DevicePreset& preset) noexcept {
  const DeviceCapability& device = preset.capability;
  GateParams params;
  params.peak_force_n = device.peak_force_n;
  params.peak_torque_nmm = device.peak_torque_nmm;
  params.continuous_force_n =
      std::min(device.peak_force_n, preset.continuous_force_n.value_or(kContinuousForceShare * device.peak_force_n));
  params.continuous_torque_nmm = std::min(
      device.peak_torque_nmm, preset.continuous_torque_nmm.value_or(kContinuousTorqueShare * device.peak_torque_nmm));
  params.peak_roll_nmm = device.peak_roll_nmm;
  params.continuous_roll_nmm = std::min(
      device.peak_roll_nmm, preset.continuous_roll_nmm.value_or(kContinuousTorqueShare * device.peak_roll_nmm));
  params.max_damping_ns_per_mm = preset.max_damping_ns_per_mm;
  params.brake_ns_per_mm = std::min(params.brake_ns_per_mm, params.max_damping_ns_per_mm);
  // Stiffness of the patient's springs at the device; never stiffer, which would limit more.
  params.softest_n_per_mm *= std::clamp(preset.force_scale * preset.motion_scale, kSoftestScale, 1.0);
  params.softest_nmm_per_rad *= std::clamp(preset.force_scale, kSoftestScale, 1.0);
  params.physical_damping_ns_per_mm = preset.viscosity_ns_per_mm + kLooseHand_ns_per_mm;
  if (!preset.has_force()) params.max_vibration_mw = kNeverVibrating_mw;  // a displayed force moves nothing
  params.count_mm = preset.encoder.count_mm;
  params.count_rad = preset.encoder.count_rad;
  return params;
}

}  // namespace trocar::haptics
