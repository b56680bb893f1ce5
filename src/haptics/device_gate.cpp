#include "haptics/device_gate.h"

#include <algorithm>

namespace trocar {
namespace {

// Known shares: 6.2/37.5 N and 0.88/3.3 N, 188/515 N mm (data/devices.toml, premium and omni).
constexpr double kContinuousForceShare = 0.2;   // [assumed, 0.15..0.5]
constexpr double kContinuousTorqueShare = 0.3;  // [assumed, 0.15..0.5]
// Damping that a loop of 1 kHz bears beside its stiffest spring, as the couplings have it (physics.md V1, H2).
constexpr double kDampingTime_s = 0.003;  // [assumed, 0.002..0.004]

}  // namespace

GateParams gate_params(const DevicePreset& preset) noexcept {
  const DeviceCapability& device = preset.capability;
  GateParams params;
  const double most_damping_ns_per_mm = params.max_damping_ns_per_mm;
  params.peak_force_n = device.peak_force_n;
  params.peak_torque_nmm = device.peak_torque_nmm;
  params.continuous_force_n =
      std::min(device.peak_force_n, preset.continuous_force_n.value_or(kContinuousForceShare * device.peak_force_n));
  params.continuous_torque_nmm = std::min(
      device.peak_torque_nmm, preset.continuous_torque_nmm.value_or(kContinuousTorqueShare * device.peak_torque_nmm));
  params.max_damping_ns_per_mm = std::min(most_damping_ns_per_mm, kDampingTime_s * device.max_stiffness_n_per_mm);
  params.brake_ns_per_mm = std::min(params.brake_ns_per_mm, params.max_damping_ns_per_mm);
  return params;
}

}  // namespace trocar
