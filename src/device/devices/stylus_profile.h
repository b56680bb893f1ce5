#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/result.h"
#include "haptics/coupling/device_preset.h"

namespace trocar::devices {

/// Weight of the stylus of one device, measured by its user (server/stylus_weighing). It replaces that of the preset in
/// the weight compensation.
struct StylusProfile {
  std::string device;              ///< HapticDevice::name(): "openhaptics:Left Device".
  std::string preset;              ///< Row of data/devices.toml of the weighed device: "omni".
  double weight_n = 0.0;           ///< Range 0..5.
  std::optional<double> lever_mm;  ///< As DeviceCapability::stylus_lever_mm; absent: the preset's. Range -200..200.
};

/// File of a device's profile: its name, other characters than letters, digits, '-' and '_' as %XX.
std::filesystem::path stylus_profile_file(const std::filesystem::path& folder, const std::string& device);
/// Writes the profile completely or not at all; makes the folder. Replaces an earlier one of the device. Errors: a
/// number out of range, the disk.
Status save_stylus_profile(const StylusProfile& profile, const std::filesystem::path& folder);
/// Removes the profile of a device; false if there was none. Error: the disk.
Result<bool> remove_stylus_profile(const std::filesystem::path& folder, const std::string& device);
/// Empty if there is no profile. Errors name file and key: no valid TOML, an unknown key, a number that is not finite
/// or out of range, a profile of another device.
Result<std::optional<StylusProfile>> load_stylus_profile(const std::filesystem::path& folder,
                                                         const std::string& device);
/// The preset with the weight of the device's profile, unchanged without a profile or with an empty `folder`. Errors:
/// those of load_stylus_profile, a profile of another preset, a weight above the device's continuous force.
Result<haptics::DevicePreset> with_stylus_profile(haptics::DevicePreset preset, const std::filesystem::path& folder,
                                                  const std::string& device);

}  // namespace trocar::devices
