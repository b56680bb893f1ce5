#pragma once

#include <optional>
#include <vector>

#include "ultrasound/probe/scan_geometry.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::ultrasound {

/// Two-way point spread of a transducer's beam (docs/physics.md U3), as standard deviations of Gaussian amplitude
/// profiles; the full width at half maximum of the amplitude, the -6 dB width of the echo, is 2.355 times the standard
/// deviation.
struct Beam {
  double frequency_mhz = 3.5;   ///< Centre of the spectrum at the face.
  double bandwidth = 0.4;       ///< -6 dB, a fraction of `frequency_mhz`.
  double wavelength_mm = 0.44;  ///< In tissue with 1540 m/s, at `frequency_mhz`.
  double axial_sigma_mm = 0.2;
  double focus_mm = 80.0;  ///< Lateral transmit focus.
  double f_number = 3.0;
  double aperture_mm = 40.0;
  double elevation_aperture_mm = 12.0;
  double elevation_focus_mm = 70.0;
  /// Decrease of the echo's centre frequency with depth, as a share of `frequency_mhz`, up to kMostDownshift: tissue
  /// attenuates high frequencies more (docs/physics.md U4). 0: none.
  double downshift_per_mm = 0.0;
  /// Tissue harmonic imaging: frequency and wavelength are those of the received second harmonic, which the tissue
  /// generates from a transmitted beam of half the frequency (docs/physics.md U19).
  bool is_harmonic = false;

  /// Standard deviation of the amplitude spectrum, as a share of `frequency_mhz`.
  double spectrum_sigma() const noexcept;
  /// Wavelength of the centre frequency of echoes from a depth.
  double wavelength_at_mm(double depth_mm) const noexcept;
  double lateral_sigma_mm(double depth_mm) const noexcept;
  double elevation_sigma_mm(double depth_mm) const noexcept;
};

/// Amplitude of the harmonic at a depth over that of a fundamental of the same frequency, transmitted with the same
/// pressure at the face; without attenuation. Grows with depth from 0, fastest about the focus; at most 1. 1 for a
/// fundamental beam. One call integrates over the depth: for tables.
double harmonic_share(const Beam& beam, double depth_mm) noexcept;
/// Level (dB) in the harmonic image of clutter that has `two_way_db` in a fundamental one: its transmitted half counts
/// twice, because the harmonic grows with the square of the pressure. Unchanged for a fundamental beam.
double clutter_level_db(const Beam& beam, double two_way_db) noexcept;

/// Standard deviation of the Gaussian aperture that replaces a uniform one of width 1. The two-way profile of two equal
/// focused apertures is then as wide at -6 dB as the exact one, sinc^2: 0.8859 wavelengths times f-number.
inline constexpr double kGaussianAperture = 0.2991;

/// Attenuation by which scanners calculate, one way (IEC 61391-2).
inline constexpr double kNominalLoss_db_per_cm_mhz = 0.5;
/// Limit of the downshift: the spectrum has no negative frequencies (assumed).
inline constexpr double kMostDownshift = 0.4;

inline constexpr double kScannerSpeed_mm_per_us = 1.540;  ///< Speed of sound that every scanner assumes, IEC 61391-1.

/// The beam at a frequency (MHz, within the transducer's band) and a transmit focus, without attenuation.
Beam make_beam(const Transducer& transducer, double frequency_mhz, double focus_mm);
/// Frequency (MHz) of the received harmonic nearest to the wanted one: twice a frequency of the transducer's band, and
/// in the band. Empty: the band has less than an octave.
std::optional<double> harmonic_mhz(const Transducer& transducer, double wanted_mhz) noexcept;
/// The beam of tissue harmonic imaging that receives at a frequency of harmonic_mhz().
Beam make_harmonic_beam(const Transducer& transducer, double received_mhz, double focus_mm);
/// Beam::downshift_per_mm in tissue with the nominal attenuation.
double nominal_downshift_per_mm(const Beam& beam) noexcept;

/// Amplitude of the harmonic at each sample of a scanline, over that at the focus. docs/physics.md U19.
std::vector<float> harmonic_levels(const Beam& beam, const ScanGeometry& geometry);
/// Gain (dB) with which a scanner makes up for a level: its inverse, at most kMostHarmonicGain_db.
double harmonic_gain_db(float level) noexcept;
inline constexpr double kMostHarmonicGain_db = 24.0;  ///< Near the face there is no harmonic yet. [assumed]

}  // namespace trocar::ultrasound
