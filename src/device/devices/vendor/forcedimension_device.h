#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/result.h"
#include "devices/haptic_device.h"
#include "devices/vendor/detail/servo_exchange.h"

namespace trocar::devices {

struct ForceDimensionOptions {
  std::filesystem::path devices_file;  ///< data/devices.toml
  std::string preset;                  ///< Row of devices.toml; empty: selected by the model that the device reports.
  std::shared_ptr<ServoPace> pace;     ///< Clock of the device thread; null: real time at 2 kHz.
};

/// Opens an omega, sigma or delta with the vendor's DHD library (libdhd.so, loaded at run time). The library's calls
/// wait for USB and take locks, so that a separate thread makes them and exchanges data through triple buffers. The
/// vendor's watchdog, velocity brake and gravity compensation stay on. Errors: no library, no device, not calibrated.
Result<std::unique_ptr<HapticDevice>> open_forcedimension_device(const ForceDimensionOptions& options);

}  // namespace trocar::devices
