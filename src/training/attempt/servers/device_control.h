#pragma once

#include <cstdint>
#include <string>

namespace trocar::attempt {

/// Method by which a device is moved to the start pose of an attempt.
enum class DeviceControl : std::uint8_t {
  kTargets,      ///< Follows hand targets: "virtual…", "mouse".
  kPlaced,       ///< Moves itself and can be put to a pose: "gamepad", "spacemouse".
  kPersonsHand,  ///< A person holds it: it begins where it is, and gets no forces again without a person's consent.
};
/// Control of a device; `device_spec` in the form of trocar-hapticd --device.
DeviceControl device_control(const std::string& device_spec);
/// True if hand targets move it.
bool follows_targets(const std::string& device_spec);
/// Display name for messages: "gamepad", "SpaceMouse", "Left Device (OpenHaptics)".
std::string device_words(const std::string& device_spec);

}  // namespace trocar::attempt
