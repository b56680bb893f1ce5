#pragma once

#include <cstdint>
#include <string>

namespace trocar::attempt {

/// How a device is moved to the start pose of an attempt.
enum class DeviceControl : std::uint8_t {
  kTargets,      ///< Follows hand targets: "virtual…", "mouse".
  kPlaced,       ///< Moves itself and can be put to a pose: "gamepad", "spacemouse".
  kPersonsHand,  ///< A person holds it: it begins where it is, and gets no forces again without a person's consent.
};
/// Of a device as trocar-hapticd --device takes it.
DeviceControl device_control(const std::string& device_spec);
/// True if hand targets move it.
bool follows_targets(const std::string& device_spec);
/// For messages: "gamepad", "SpaceMouse", "Left Device (OpenHaptics)".
std::string device_words(const std::string& device_spec);

}  // namespace trocar::attempt
