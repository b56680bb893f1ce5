#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "devices/haptic_device.h"
#include "devices/simulated/fault_schedule.h"
#include "devices/simulated/replay_file.h"

namespace trocar::devices {

/// A device as a command line names it: "virtual", "virtual:omni", "mouse", "gamepad", "spacemouse", "replay:FILE",
/// "openhaptics", "openhaptics:NAME", "forcedimension", "haply", "haply:ws://HOST:PORT".
struct DeviceSpec {
  std::string kind;
  std::string argument;  ///< After the first colon.
};
/// Unknown kind, or an argument that is missing: exit status 2, the message lists the kinds.
Result<DeviceSpec> parse_device_spec(std::string_view text);

/// Arguments of opening in addition to the name.
struct DeviceOptions {
  std::filesystem::path devices_file;  ///< data/devices.toml
  std::string preset;                  ///< Row of it; empty: the kind's own.
  std::vector<ScheduledFault> faults;  ///< Not empty: wrapped by a FaultyDevice.
  RecordedMotion motion;               ///< For "replay", whose argument is the file it is from.
  bool has_weight_compensation = true;
  /// The device is in its calibration position (stylus in the inkwell, arm in the reset position) and is calibrated
  /// while it is opened. Only for "openhaptics".
  bool is_calibrating = false;
};

/// Opens the device. Errors state what is missing: vendor library, device, or service.
Result<std::unique_ptr<HapticDevice>> open_device(const DeviceSpec& spec, const DeviceOptions& options);

}  // namespace trocar::devices
