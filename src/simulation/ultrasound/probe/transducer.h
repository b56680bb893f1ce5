#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar::ultrasound {

enum class TransducerKind {
  kConvex,            ///< Elements on an arc, scanlines along its radii.
  kLinear,            ///< Elements on a line, parallel scanlines.
  kPhased,            ///< A small face, scanlines steered from its middle.
  kMechanicalConvex,  ///< A convex array that a motor swings in elevation (3D sweep).
};

/// A transducer (data/transducers.toml). Frame T: x lateral, y away from the array, z = x × y elevation, origin at the
/// array's centre.
struct Transducer {
  std::string name;  ///< "C5-2".
  std::string description;
  TransducerKind kind = TransducerKind::kConvex;
  double frequency_mhz = 3.5;  ///< Centre frequency of the transmitted pulse. Range 1..20.
  double lowest_mhz = 2.0;
  double highest_mhz = 5.0;
  double bandwidth = 0.6;               ///< Fractional, -6 dB, of the pulse and its echo. Range 0.2..1.2.
  int elements = 128;                   ///< Range 16..1024.
  int active_elements = 64;             ///< Largest number of elements that work together. Range 8..elements.
  double pitch_mm = 0.5;                ///< Distance between elements' centres, along the face.
  double radius_mm = 60.0;              ///< Radius of the array's arc; convex kinds only.
  double field_of_view_rad = 1.2;       ///< Angle between the outermost scanlines; fans only.
  double elevation_aperture_mm = 12.0;  ///< Height of an element.
  double elevation_focus_mm = 70.0;     ///< Depth of the lens' focus.
  double f_number = 3.0;                ///< Smallest ratio of depth to receiving aperture.
  double depth_mm = 160.0;              ///< Default depth of the picture.
  double greatest_depth_mm = 300.0;
  double focus_mm = 80.0;        ///< Default depth of the transmit focus.
  int scanlines = 256;           ///< Default.
  double sweep_rad = 0.0;        ///< Whole angle of the mechanical sweep; kMechanicalConvex only.
  double sweep_radius_mm = 0.0;  ///< Distance of the motor's axis behind the middle of the face; the axis is along x.

  /// Width of the face along its surface, mm.
  double face_width_mm() const noexcept { return pitch_mm * elements; }
  /// Largest active aperture, mm.
  double aperture_mm() const noexcept { return pitch_mm * active_elements; }
};

/// All transducers of a file. Errors name file, transducer and key: unknown key, out of range, no source.
Result<std::vector<Transducer>> load_transducers(const std::filesystem::path& path);
/// One by name; an unknown one is an error that lists the names (exit status 2).
Result<Transducer> load_transducer(const std::filesystem::path& path, std::string_view name);

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
