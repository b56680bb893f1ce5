#include "attempt/servers/server_host.h"

#include "attempt/servers/haptic_servers.h"

namespace trocar::attempt {

DeviceControl device_control(const std::string& device_spec) {
  const std::string kind = device_spec.substr(0, device_spec.find(':'));
  if (kind == "virtual" || kind == "mouse") return DeviceControl::kTargets;
  if (kind == "gamepad" || kind == "spacemouse") return DeviceControl::kPlaced;
  return DeviceControl::kPersonsHand;
}

bool follows_targets(const std::string& device_spec) {
  return device_control(device_spec) == DeviceControl::kTargets;
}

std::string device_words(const std::string& device_spec) {
  if (device_spec == "spacemouse") return "SpaceMouse";
  if (device_spec.find(':') != std::string::npos) return device_title(device_spec);
  return device_spec.empty() ? "device" : device_spec;
}

void ParameterMemory::apply(const link::SetParameters& message) {
  const bool has_table = !message.tissues_toml.empty();
  if (has_table) all_.tissues_toml = message.tissues_toml;
  if (has_table || message.tissues) all_.tissues = message.tissues;
  if (!message.force_model.empty()) all_.force_model = message.force_model;
  if (message.coupling_stiffness_n_per_mm) all_.coupling_stiffness_n_per_mm = message.coupling_stiffness_n_per_mm;
  if (message.coupling_damping_ns_per_mm) all_.coupling_damping_ns_per_mm = message.coupling_damping_ns_per_mm;
  if (message.motion) all_.motion = message.motion;
  if (message.has_bending) all_.has_bending = message.has_bending;
}

}  // namespace trocar::attempt
