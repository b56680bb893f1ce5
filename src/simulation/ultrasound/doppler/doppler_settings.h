#pragma once

#include "core/result.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound {

/// Where colour is looked for, as shares of the picture's width and depth; 0..1 each, first < last.
struct DopplerBox {
  double first_line = 0.2, last_line = 0.8;
  double near = 0.2, far = 0.9;

  bool operator==(const DopplerBox&) const = default;
};

/// The controls of colour Doppler.
struct DopplerSettings {
  /// Velocity at the ends of the colour scale, along the beam: c PRF / (4 f). Held to what the box's depth allows.
  /// Range 2..200.
  double scale_cm_per_s = 30.0;
  double frequency_mhz = 2.5;  ///< Transmitted for colour, below the picture's. Range 1..15. Assumed for a C5-2.
  double wall_filter = 0.1;    ///< Velocities below this part of the scale are stopped (-3 dB). Range 0..0.6.
  double gain_db = 0.0;        ///< Weaker flow is shown, then noise. Range -40..40.
  double persistence = 0.4;    ///< Part of the last picture that stays. Range 0..0.95.
  double baseline = 0.0;  ///< Shift of the colour scale's middle, in scales, towards flow to the face. Range -0.9..0.9.
  bool is_inverted = false;  ///< Flow to the transducer blue instead of red.
  int write_priority = 150;  ///< Where the picture is brighter than this it is not coloured. Range 0..255.
  int ensemble = 10;         ///< Pulses a scanline. Range 3..32.
  DopplerBox box;

  bool operator==(const DopplerSettings&) const = default;
};

/// An error names the control that is out of its range (exit status 2).
Status check(const DopplerSettings& settings);
/// The same settings with each control held in its range; one that is not a number gets its default. Real-time safe.
DopplerSettings within_ranges(const DopplerSettings& settings) noexcept;

/// Largest velocity without aliasing at a pulse repetition frequency: c PRF / (4 f), cm/s.
double nyquist_cm_per_s(double prf_hz, double frequency_mhz) noexcept;
/// Its inverse.
double prf_hz(double nyquist_cm_per_s, double frequency_mhz) noexcept;
/// The scale that is used: the wish, or what echoes from the deepest gate leave time for.
double usable_scale_cm_per_s(const DopplerSettings& settings, double deepest_mm) noexcept;
/// Doppler shift of blood at that velocity, whose direction makes that angle with the beam (Hz): 2 f v cos / c.
double doppler_shift_hz(double velocity_cm_per_s, double angle_rad, double frequency_mhz) noexcept;

/// A line that the user lays along the vessel, for speed along it from the velocity along the beam.
struct FlowCaliper {
  Vec2 p_T{0.0, 50.0};     ///< Middle of the gate.
  Vec2 along_T{1.0, 0.0};  ///< Direction of the vessel; its sign does not matter.

  /// Between the beam and the vessel, 0..pi/2.
  double angle_rad(const ScanGeometry& scan) const noexcept;
  /// Speed along the vessel; the corrected value is untrustworthy beyond 60 degrees, and 0 beyond 89.
  double corrected_cm_per_s(double along_beam_cm_per_s, const ScanGeometry& scan) const noexcept;
};

}  // namespace trocar::ultrasound
