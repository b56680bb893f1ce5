#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/result.h"
#include "devices/haptic_device.h"

namespace trocar::devices {

struct OpenHapticsOptions {
  std::string device;                  ///< Name in the vendor's settings ("Left Device"); empty: the default device.
  std::filesystem::path devices_file;  ///< data/devices.toml
  std::string preset;                  ///< Row of devices_file; empty: selected by the model that the device reports.
  /// A person holds the device in its calibration position: it is calibrated again while it is opened; an encoder
  /// reset is allowed.
  bool is_calibrating = false;
  std::filesystem::path stylus_folder;     ///< As in DeviceOptions.
  double (*clock_s)() noexcept = nullptr;  ///< Steady clock of the callback; nullptr: the system's clock.
};

/// Opens a PHANTOM or Touch with the vendor's OpenHaptics HD API (libHD.so, loaded at run time). The vendor's scheduler
/// runs a callback at 1 kHz. Only the callback accesses the device; read and write exchange data with it through triple
/// buffers. A process can open one device, because the library has one scheduler. Errors: no library, no device, not
/// calibrated.
Result<std::unique_ptr<HapticDevice>> open_openhaptics_device(const OpenHapticsOptions& options);

}  // namespace trocar::devices
