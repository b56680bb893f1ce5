#include "ultrasound/engine/beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"

namespace trocar::ultrasound {
namespace {

/// Standard deviation of the Gaussian aperture that replaces a uniform one of width 1. The two-way profile of two equal
/// focused apertures is then as wide at -6 dB as the exact one, sinc^2: 0.8859 wavelengths times f-number.
constexpr double kGaussianAperture = 0.2991;

/// One-way width of a Gaussian beam (docs/physics.md U3). Standard deviation of the amplitude, mm.
double one_way_sigma_mm(double depth_mm, double aperture_mm, double focus_mm, double wavelength_mm) noexcept {
  const double face_mm = kGaussianAperture * aperture_mm;
  const double geometric_mm = face_mm * (1.0 - depth_mm / focus_mm);
  const double diffraction_mm = wavelength_mm * depth_mm / (2.0 * std::numbers::pi * face_mm);
  return std::hypot(geometric_mm, diffraction_mm);
}

}  // namespace

double Beam::spectrum_sigma() const noexcept {
  return 0.5 * bandwidth / std::sqrt(2.0 * std::numbers::ln2);
}

double Beam::wavelength_at_mm(double depth_mm) const noexcept {
  return wavelength_mm / (1.0 - std::min(downshift_per_mm * std::max(depth_mm, 0.0), kMostDownshift));
}

double nominal_downshift_per_mm(const Beam& beam) noexcept {
  constexpr double kNeperPerDb = std::numbers::ln10 / 20.0, kPerCm = 0.1;
  const double loss = 2.0 * kNominalLoss_db_per_cm_mhz * kPerCm * beam.frequency_mhz * kNeperPerDb;
  return beam.spectrum_sigma() * beam.spectrum_sigma() * loss;
}

double Beam::lateral_sigma_mm(double depth_mm) const noexcept {
  const double here_mm = wavelength_at_mm(depth_mm);
  const double transmit_aperture_mm = std::min(focus_mm / f_number, aperture_mm);
  const double transmit_mm = one_way_sigma_mm(depth_mm, transmit_aperture_mm, focus_mm, here_mm);
  // Receiving is focused at every depth with an aperture that grows with the depth up to its full size: hence the
  // diffraction limit of the larger of two f-numbers.
  const double receive_f_number = std::max(f_number, depth_mm / aperture_mm);
  const double receive_mm = here_mm * receive_f_number / (2.0 * std::numbers::pi * kGaussianAperture);
  return transmit_mm * receive_mm / std::hypot(transmit_mm, receive_mm);
}

double Beam::elevation_sigma_mm(double depth_mm) const noexcept {
  // The lens focuses transmission and reception equally.
  return one_way_sigma_mm(depth_mm, elevation_aperture_mm, elevation_focus_mm, wavelength_at_mm(depth_mm)) /
         std::numbers::sqrt2;
}

Beam make_beam(const Transducer& transducer, double frequency_mhz, double focus_mm) {
  TROCAR_CHECK(frequency_mhz > 0.0 && focus_mm > 0.0);
  Beam beam;
  beam.frequency_mhz = frequency_mhz;
  beam.bandwidth = transducer.bandwidth;
  beam.wavelength_mm = kScannerSpeed_mm_per_us / frequency_mhz;
  // Half the amplitude at half the bandwidth from the centre; the depth is half the sound path (docs/physics.md U2).
  beam.axial_sigma_mm =
      std::sqrt(2.0 * std::numbers::ln2) / (2.0 * std::numbers::pi) * beam.wavelength_mm / transducer.bandwidth;
  beam.focus_mm = focus_mm;
  beam.f_number = transducer.f_number;
  beam.aperture_mm = transducer.aperture_mm();
  beam.elevation_aperture_mm = transducer.elevation_aperture_mm;
  beam.elevation_focus_mm = transducer.elevation_focus_mm;
  return beam;
}

}  // namespace trocar::ultrasound
