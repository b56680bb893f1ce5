#include "attempt/servers/device_control.h"

#include "attempt/servers/tool_devices.h"

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

}  // namespace trocar::attempt
