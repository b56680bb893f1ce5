#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.h"

namespace trocar::ultrasound {

/// Output of a transducer at full transmit power (data/transducers.toml).
struct AcousticOutput {
  double pressure_mpa = 4.0;  ///< Peak rarefactional pressure at the transmit focus in water. Range 0.1..10.
  double power_mw = 30.0;     ///< Time-averaged power of the middle centimetre of the aperture. Range 0.1..1000.
};

/// Indices that a scanner displays (IEC 62359; docs/physics.md).
struct AcousticIndices {
  double mechanical = 0.0;  ///< MI: pressure at the focus in tissue, MPa, over the root of the frequency, MHz.
  double thermal = 0.0;     ///< TIS: soft tissue, scanned mode.

  bool operator==(const AcousticIndices&) const = default;
};

/// Attenuation with which the standard derates pressures measured in water.
inline constexpr double kDerating_db_per_cm_mhz = 0.3;
/// Power that heats soft tissue by one degree at 1 MHz, mW MHz.
inline constexpr double kThermalPower_mw_mhz = 210.0;
/// Largest MI that a diagnostic scanner may emit (FDA, track 3). The scanner lowers its voltage to keep it.
inline constexpr double kMostMechanicalIndex = 1.9;

/// Indices of the B-mode pulses at a frequency (MHz, > 0) and transmit focus (mm, >= 0). The output is lowered where
/// the MI would exceed its limit; then the power falls with the square of the pressure.
AcousticIndices acoustic_indices(const AcousticOutput& output, double frequency_mhz, double focus_mm) noexcept;

/// The output of a transducer of the table. Errors as load_transducer().
Result<AcousticOutput> load_acoustic_output(const std::filesystem::path& path, std::string_view transducer);

}  // namespace trocar::ultrasound
