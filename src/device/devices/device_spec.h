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

namespace trocar::devices {

/// A device as a command line names it: "virtual", "virtual:omni", "mouse", "gamepad", "spacemouse", "replay:FILE",
/// "openhaptics", "openhaptics:NAME", "forcedimension", "haply", "haply:ws://HOST:PORT".
struct DeviceSpec {
  std::string kind;
  std::string argument;  ///< After the first colon.
};
/// Unknown kind, or an argument that is missing: exit status 2, the message lists the kinds.
Result<DeviceSpec> parse_device_spec(std::string_view text);

/// What opening needs beside the name.
struct DeviceOptions {
  std::filesystem::path devices_file;  ///< data/devices.toml
  std::string preset;                  ///< Row of it; empty: the kind's own.
  std::vector<ScheduledFault> faults;  ///< Not empty: wrapped by a FaultyDevice.
  /// Poses X_DS of a recorded session, one a period at rate_hz; for "replay" (who reads sessions is above this module).
  std::vector<Pose> replay;
  double replay_rate_hz = 1000.0;
  bool has_weight_compensation = true;
  /// Somebody holds the device where its calibration wants it (stylus in the inkwell, arm in the reset position): it is
  /// calibrated there while it is opened. Of "openhaptics" alone; the others calibrate themselves.
  bool is_calibrating = false;
};

/// Opens the device. Errors say what is missing and how to get it: no vendor library, no device, no service.
Result<std::unique_ptr<HapticDevice>> open_device(const DeviceSpec& spec, const DeviceOptions& options);

}  // namespace trocar::devices
