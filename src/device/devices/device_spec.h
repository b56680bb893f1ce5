#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "devices/haptic_device.h"
#include "devices/simulated/faulty_device.h"
#include "devices/simulated/replay_device.h"

namespace trocar::devices {

/// A device as a command line names it: "virtual", "virtual:omni", "mouse", "gamepad", "spacemouse", "replay:FILE",
/// "openhaptics", "openhaptics:NAME", "forcedimension", "haply", "haply:ws://HOST:PORT".
struct DeviceSpec {
  std::string kind;
  std::string argument;  ///< After the first colon.
};
/// Errors (exit status 2): unknown kind, or a missing argument. The message lists the kinds.
Result<DeviceSpec> parse_device_spec(std::string_view text);

/// Options of open_device() in addition to the DeviceSpec.
struct DeviceOptions {
  std::filesystem::path devices_file;  ///< data/devices.toml
  std::string preset;                  ///< Row of devices_file; empty: the default row of the kind.
  std::vector<ScheduledFault> faults;  ///< If not empty, a FaultyDevice wraps the device.
  RecordedMotion motion;               ///< For "replay": the motion read from the file in DeviceSpec::argument.
  bool has_weight_compensation = true;
  /// The device is in its calibration position (stylus in the inkwell, arm in the reset position) and is calibrated
  /// while it is opened. Only for "openhaptics".
  bool is_calibrating = false;
  std::filesystem::path stylus_folder;  ///< Weights that users saved (devices/workspace_map.h); empty: none are used.
};

/// Opens the device. Errors state what is missing: vendor library, device, or service.
Result<std::unique_ptr<HapticDevice>> open_device(const DeviceSpec& spec, const DeviceOptions& options);

}  // namespace trocar::devices
