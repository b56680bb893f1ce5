#pragma once

#include "core/result.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound {

/// Colour box, as shares of the picture's width and depth; 0..1 each, first < last.
struct DopplerBox {
  double first_line = 0.2, last_line = 0.8;
  double near = 0.2, far = 0.9;

  bool operator==(const DopplerBox&) const = default;
};

/// The controls of colour Doppler.
struct DopplerSettings {
  /// Velocity at the ends of the colour scale, along the beam: c PRF / (4 f). Limited by the box's depth. Range 2..200.
  double scale_cm_per_s = 30.0;
  double frequency_mhz = 2.5;  ///< Transmit frequency for colour, below the picture's. Range 1..15. Assumed for a C5-2.
  double wall_filter = 0.1;    ///< Cut-off velocity (-3 dB) as a fraction of the scale. Range 0..0.6.
  double gain_db = 0.0;        ///< Higher values display weaker flow, then noise. Range -40..40.
  double persistence = 0.4;    ///< Share of the last picture that remains. Range 0..0.95.
  double baseline = 0.0;  ///< Shift of the colour scale's middle, as a fraction of the scale, towards flow to the face.
                          ///< Range -0.9..0.9.
  bool is_inverted = false;  ///< Flow to the transducer blue instead of red.
  int write_priority = 150;  ///< Pixels with a brighter gray value are not coloured. Range 0..255.
  int ensemble = 10;         ///< Pulses per scanline. Range 3..32.
  DopplerBox box;

  bool operator==(const DopplerSettings&) const = default;
};

/// An error names the control that is out of its range (exit status 2).
Status check(const DopplerSettings& settings);
/// Returns the settings with each control clamped to its range; NaN is replaced by the default. Real-time safe.
DopplerSettings within_ranges(const DopplerSettings& settings) noexcept;

/// Largest velocity without aliasing at a pulse repetition frequency: c PRF / (4 f), cm/s.
double nyquist_cm_per_s(double prf_hz, double frequency_mhz) noexcept;
/// Inverse of nyquist_cm_per_s().
double prf_hz(double nyquist_cm_per_s, double frequency_mhz) noexcept;
/// Scale in use: the requested one, or the largest that the time of flight of echoes from the deepest gate permits.
double usable_scale_cm_per_s(const DopplerSettings& settings, double deepest_mm) noexcept;
/// Doppler shift (Hz) of blood at that velocity, at that angle between its direction and the beam: 2 f v cos / c.
double doppler_shift_hz(double velocity_cm_per_s, double angle_rad, double frequency_mhz) noexcept;

/// A line placed by the user along the vessel; gives the speed along the vessel from the velocity along the beam.
struct FlowCaliper {
  Vec2 p_T{0.0, 50.0};     ///< Middle of the gate.
  Vec2 along_T{1.0, 0.0};  ///< Direction of the vessel; its sign does not matter.

  /// Angle between the beam and the vessel, 0..pi/2.
  double angle_rad(const ScanGeometry& scan) const noexcept;
  /// Speed along the vessel; unreliable at angles beyond 60 degrees, 0 beyond 89.
  double corrected_cm_per_s(double along_beam_cm_per_s, const ScanGeometry& scan) const noexcept;
};

}  // namespace trocar::ultrasound
