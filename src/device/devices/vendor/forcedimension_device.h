#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/result.h"
#include "devices/haptic_device.h"
#include "devices/vendor/servo_pace.h"

namespace trocar::devices {

struct ForceDimensionOptions {
  std::filesystem::path devices_file;  ///< data/devices.toml
  std::string preset;                  ///< Row of it; empty: by the model that the device says.
  std::shared_ptr<ServoPace> pace;     ///< Of the thread that talks to the device; none: real time at 2 kHz.
};

/// An omega, sigma or delta by the vendor's DHD library (libdhd.so, opened now). Its calls wait for USB and take locks:
/// a thread of ours makes them, read and write only meet it in triple buffers. The vendor's watchdog, velocity brake
/// and gravity compensation stay on. Errors: no library, no device, not calibrated.
Result<std::unique_ptr<HapticDevice>> open_forcedimension_device(const ForceDimensionOptions& options);

}  // namespace trocar::devices
