#pragma once

#include <string>
#include <vector>

namespace trocar::attempt {

/// A device that a tool may be moved by.
struct ToolDevice {
  std::string spec;   ///< As trocar-hapticd --device takes it.
  std::string title;  ///< "Left Device (OpenHaptics)"
};

/// Devices that can be chosen: mouse and keys, pointing devices, and haptic devices. Of OpenHaptics one entry a device
/// that the vendor's setup program knows by name ($GTDD_HOME/config or /usr/share/3DSystems/config, a file NAME.config
/// each); without any, its default device. Whether they are plugged in is not looked at.
std::vector<ToolDevice> tool_devices();
/// For a device of any name, also one that is not listed.
std::string device_title(const std::string& spec);

/// Whether needle and transducer may have these two: mouse and keys (and simulated devices) move both tools, any other
/// device is one piece of hardware in one hand.
bool can_be_used_together(const std::string& needle_spec, const std::string& probe_spec);

}  // namespace trocar::attempt
