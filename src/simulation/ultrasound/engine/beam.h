#pragma once

#include "ultrasound/probe/transducer.h"

namespace trocar::ultrasound {

/// Two-way point spread of a transducer's beam (docs/physics.md U3), as standard deviations of Gaussian amplitude
/// profiles; the full width at half maximum of the amplitude, the -6 dB width of the echo, is 2.355 times the standard
/// deviation.
struct Beam {
  double frequency_mhz = 3.5;
  double wavelength_mm = 0.44;  ///< In tissue with 1540 m/s.
  double axial_sigma_mm = 0.2;
  double focus_mm = 80.0;  ///< Lateral transmit focus.
  double f_number = 3.0;
  double aperture_mm = 40.0;
  double elevation_aperture_mm = 12.0;
  double elevation_focus_mm = 70.0;

  double lateral_sigma_mm(double depth_mm) const noexcept;
  double elevation_sigma_mm(double depth_mm) const noexcept;
};

inline constexpr double kScannerSpeed_mm_per_us = 1.540;  ///< Speed of sound that every scanner assumes, IEC 61391-1.

/// The beam at a frequency (MHz, within the transducer's band) and a transmit focus.
Beam make_beam(const Transducer& transducer, double frequency_mhz, double focus_mm);

}  // namespace trocar::ultrasound
