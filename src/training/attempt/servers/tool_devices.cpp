#include "attempt/servers/tool_devices.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "attempt/servers/device_control.h"
#include "core/files/list_folder.h"

namespace trocar::attempt {
namespace {

namespace fs = std::filesystem;

struct DeviceTitle {
  std::string_view spec;
  std::string_view title;
};
constexpr std::string_view kOpenHaptics = "openhaptics";
constexpr std::string_view kDefaultName = "Default Device";  // default of the vendor's library
constexpr std::array kPointers{DeviceTitle{"mouse", "Mouse and keyboard"}, DeviceTitle{"gamepad", "Gamepad"},
                               DeviceTitle{"spacemouse", "SpaceMouse"}};
constexpr std::array kOthers{DeviceTitle{"forcedimension", "Force Dimension"}, DeviceTitle{"haply", "Haply Inverse3"}};

/// Device names assigned in the vendor's setup program, in order.
std::vector<std::string> openhaptics_names() {
  const char* home = std::getenv("GTDD_HOME");
  const fs::path folder = fs::path(home != nullptr && *home != '\0' ? home : "/usr/share/3DSystems") / "config";
  std::vector<std::string> names;
  const auto files = list_folder(folder);
  if (!files) return names;
  for (const fs::path& file : *files)
    if (file.extension() == ".config") names.push_back(file.stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The hardware of a spec.
std::string hardware_of(const std::string& spec) {
  return spec == kOpenHaptics ? spec + ":" + std::string(kDefaultName) : spec;
}

}  // namespace

std::vector<ToolDevice> tool_devices() {
  std::vector<ToolDevice> devices;
  for (const DeviceTitle& pointer : kPointers)
    devices.push_back({std::string(pointer.spec), std::string(pointer.title)});
  const std::vector<std::string> names = openhaptics_names();
  if (names.empty()) devices.push_back({std::string(kOpenHaptics), device_title(std::string(kOpenHaptics))});
  for (const std::string& name : names) {
    const std::string spec = std::string(kOpenHaptics) + ":" + name;
    devices.push_back({spec, device_title(spec)});
  }
  for (const DeviceTitle& other : kOthers) devices.push_back({std::string(other.spec), std::string(other.title)});
  return devices;
}

std::string device_title(const std::string& spec) {
  if (spec == kOpenHaptics) return "3D Systems Touch (OpenHaptics)";
  for (const auto& titles :
       {std::vector(kPointers.begin(), kPointers.end()), std::vector(kOthers.begin(), kOthers.end())})
    for (const DeviceTitle& device : titles)
      if (device.spec == spec) return std::string(device.title);
  const std::size_t colon = spec.find(':');
  if (colon == std::string::npos) return spec;
  const std::string kind = spec.substr(0, colon), name = spec.substr(colon + 1);
  return name + (kind == kOpenHaptics ? " (OpenHaptics)" : " (" + device_title(kind) + ")");
}

bool can_be_used_together(const std::string& needle_spec, const std::string& probe_spec) {
  if (follows_targets(needle_spec) || follows_targets(probe_spec)) return true;
  return hardware_of(needle_spec) != hardware_of(probe_spec);
}

}  // namespace trocar::attempt
