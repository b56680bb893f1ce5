#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/result.h"
#include "devices/haptic_device.h"

namespace trocar::devices {

struct OpenHapticsOptions {
  std::string device;                  ///< Its name in the vendor's settings ("Left Device"); empty: the default one.
  std::filesystem::path devices_file;  ///< data/devices.toml
  std::string preset;                  ///< Row of it; empty: by the model that the device says.
  /// Somebody holds it where its calibration wants it: calibrated anew while it is opened, encoder reset included.
  bool is_calibrating = false;
  double (*clock_s)() noexcept = nullptr;  ///< Steady clock of the callback; nullptr: the system's.
};

/// A PHANTOM or Touch by the vendor's OpenHaptics HD API (libHD.so, opened now). The vendor's scheduler runs our
/// callback at 1 kHz; all exchange with the device is there, read and write only meet it in triple buffers. One device
/// a process: the scheduler is one. Errors: no library, no device, not calibrated.
Result<std::unique_ptr<HapticDevice>> open_openhaptics_device(const OpenHapticsOptions& options);

}  // namespace trocar::devices
