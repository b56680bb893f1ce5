#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "devices/device_spec.h"

namespace trocar::devices {

using OpenedDevice = Result<std::unique_ptr<HapticDevice>>;

/// One factory per kind; device_spec.cpp lists them. Each opens the device; its error states what is missing and how to
/// get it.
OpenedDevice open_virtual(const DeviceSpec& spec, const DeviceOptions& options);
OpenedDevice open_pointer(const DeviceSpec& spec, const DeviceOptions& options);
OpenedDevice open_replay(const DeviceSpec& spec, const DeviceOptions& options);
OpenedDevice open_gamepad(const DeviceSpec& spec, const DeviceOptions& options);
OpenedDevice open_spacemouse(const DeviceSpec& spec, const DeviceOptions& options);
OpenedDevice open_openhaptics(const DeviceSpec& spec, const DeviceOptions& options);
OpenedDevice open_forcedimension(const DeviceSpec& spec, const DeviceOptions& options);
OpenedDevice open_haply(const DeviceSpec& spec, const DeviceOptions& options);

/// For factories: loads the row options.preset, or the row `own` if options.preset is empty.
Result<stylus::DevicePreset> load_preset_of(const DeviceOptions& options, std::string_view own);

inline constexpr double kMmPerM = 1000.0;

}  // namespace trocar::devices
