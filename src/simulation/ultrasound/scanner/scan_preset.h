#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "ultrasound/doppler/doppler_settings.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/scanner/display_settings.h"

namespace trocar::ultrasound {

/// Settings of a scanner for an examination (data/scan_presets.toml).
struct ScanPreset {
  std::string name;                                         ///< "liver-biopsy".
  std::string title;                                        ///< "Liver biopsy".
  std::string transducer;                                   ///< A name of data/transducers.toml.
  std::optional<double> depth_mm, frequency_mhz, focus_mm;  ///< Empty: the transducer's own.
  DisplaySettings display;
  bool has_doppler = false;
  double doppler_scale_cm_per_s = 30.0;
};

/// All presets of a file. Errors name file, preset and key: unknown key, out of range.
Result<std::vector<ScanPreset>> load_scan_presets(const std::filesystem::path& path);
/// The transducer's acquisition with the preset applied.
Acquisition acquisition_of(const ScanPreset& preset, const Transducer& transducer);

}  // namespace trocar::ultrasound
