#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "ultrasound/doppler/doppler_settings.h"
#include "ultrasound/engine/b_mode.h"

namespace trocar::ultrasound {

inline constexpr int kTgcSliders = 8;

/// Map from a level's position in the dynamic range to gray.
enum class GrayMap {
  kLinear,        ///< Proportional to dB.
  kSoft,          ///< Dark tissue, bright borders, like the abdominal sweep of docs/validation.md.
  kHighContrast,  ///< As kSoft but steeper, and black below.
};

/// Display settings: they process existing echoes.
struct DisplaySettings {
  double gain_db = 0.0;                      ///< Range -40..40.
  std::array<double, kTgcSliders> tgc_db{};  ///< From near to far, in addition to the automatic part. Range -20..20.
  double automatic_tgc_db_per_cm_mhz = 0.5;  ///< Two-way loss that the gain compensates. Range 0..1.5 (one way).
  /// Upper limit of the automatic part, so that the receiver's noise stays darker than tissue. Range 0..120. Assumed
  /// from the sweep of docs/validation.md: its liver fades below 11 cm, and the depth below it stays black.
  double automatic_tgc_limit_db = 28.0;
  double dynamic_range_db = 60.0;  ///< Range 20..100.
  double persistence = 0.0;        ///< Share of the last picture that remains. Range 0..0.95.
  GrayMap gray_map = GrayMap::kSoft;
  /// True: +x of the transducer, its marked side, is on the left, as usual. In a transverse view the patient's right is
  /// then on the left, as in an axial slice. The orientation marker shows the side.
  bool is_mirrored = true;

  bool operator==(const DisplaySettings&) const = default;
};

/// An error names the control that is out of its range (exit status 2).
Status check(const DisplaySettings& settings);
/// Returns the settings clamped to their ranges; NaN is replaced by the default. Real-time safe.
DisplaySettings within_ranges(const DisplaySettings& settings) noexcept;

/// "linear", "soft", "high-contrast"; an unknown name is an error (exit status 2).
Result<GrayMap> parse_gray_map(std::string_view name);
std::string_view name_of(GrayMap map) noexcept;

/// Gain at a depth (docs/physics.md U11), dB: the automatic part and the sliders. The sliders are spread over the depth
/// of the scan and interpolated by a cubic that stays within the range of neighbouring sliders. Real-time safe.
double tgc_gain_db(const DisplaySettings& settings, double depth_mm, double scan_depth_mm,
                   double frequency_mhz) noexcept;

/// Level displayed as white at gain 0, relative to liver's speckle after TGC (root mean square). Assumed, range 10..35:
/// at this value liver behind a wall with a loss of about 8 dB has the gray level of the sweep in docs/validation.md.
inline constexpr double kWhite_db = 15.0;

/// Gray of a level after TGC and before gain, dB relative to liver's speckle (docs/physics.md U11). Increases with the
/// level. 0..255. Real-time safe.
std::uint8_t gray_of_level(double level_db, const DisplaySettings& settings) noexcept;

/// Gray that the automatic gain gives the brightness of tissue. Assumed: a mid gray on the dark side, as scanners do.
inline constexpr int kAutomaticGray = 96;

/// Gain (dB) with which the tissue of a frame has the gray kAutomaticGray with the other display settings, as a
/// scanner's button for automatic gain sets it. `levels`: of the scan, see Scanner::levels(). Tissue: the level that a
/// third of the samples with an echo exceed. Within the range of the gain; empty where less than a tenth of the scan
/// has an echo (a transducer in the air).
std::optional<double> automatic_gain_db(std::span<const std::uint8_t> levels, const DisplaySettings& settings);

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
