#pragma once

#include <string>
#include <vector>

namespace trocar::attempt {

/// A device that can move a tool.
struct ToolDevice {
  std::string spec;   ///< In the form of trocar-hapticd --device.
  std::string title;  ///< "Left Device (OpenHaptics)"
};

/// Devices that can be chosen: mouse and keys, pointing devices, and haptic devices. OpenHaptics has one entry for each
/// device that the vendor's setup program lists by name ($GTDD_HOME/config or /usr/share/3DSystems/config, a file
/// NAME.config each); without any, one for its default device. The list also contains devices that are not plugged in.
std::vector<ToolDevice> tool_devices();
/// Title of any device, also of one that is not listed.
std::string device_title(const std::string& spec);

/// True if needle and transducer can use these two devices together. Mouse and keys (and simulated devices) move both
/// tools; any other device is one piece of hardware in one hand.
bool can_be_used_together(const std::string& needle_spec, const std::string& probe_spec);

}  // namespace trocar::attempt
