#include "ultrasound/engine/beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/result.h"

namespace trocar::ultrasound {
namespace {

/// One-way width of a Gaussian beam (docs/physics.md U3). Standard deviation of the amplitude, mm.
double one_way_sigma_mm(double depth_mm, double aperture_mm, double focus_mm, double wavelength_mm) noexcept {
  const double face_mm = kGaussianAperture * aperture_mm;
  const double geometric_mm = face_mm * (1.0 - depth_mm / focus_mm);
  const double diffraction_mm = wavelength_mm * depth_mm / (2.0 * std::numbers::pi * face_mm);
  return std::hypot(geometric_mm, diffraction_mm);
}

/// One-way width of what is transmitted: of the fundamental, or of the harmonic that it generates, which follows the
/// square of its pressure.
double transmit_sigma_mm(const Beam& beam, double depth_mm, double aperture_mm, double focus_mm) noexcept {
  const double here_mm = beam.wavelength_at_mm(depth_mm);
  if (!beam.is_harmonic) return one_way_sigma_mm(depth_mm, aperture_mm, focus_mm, here_mm);
  return one_way_sigma_mm(depth_mm, aperture_mm, focus_mm, 2.0 * here_mm) / std::numbers::sqrt2;
}

/// Pressure of the transmitted fundamental on the axis over that at the face: two line foci.
double focusing_gain(const Beam& beam, double depth_mm) noexcept {
  const double aperture_mm = std::min(beam.focus_mm / beam.f_number, beam.aperture_mm);
  const auto squeezed = [&](double width_mm, double focus_mm) {
    return kGaussianAperture * width_mm / one_way_sigma_mm(depth_mm, width_mm, focus_mm, 2.0 * beam.wavelength_mm);
  };
  return std::sqrt(squeezed(aperture_mm, beam.focus_mm) *
                   squeezed(beam.elevation_aperture_mm, beam.elevation_focus_mm));
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
  const double transmit_mm = transmit_sigma_mm(*this, depth_mm, transmit_aperture_mm, focus_mm);
  // Receiving is focused at every depth with an aperture that grows with the depth up to its full size: hence the
  // diffraction limit of the larger of two f-numbers.
  const double receive_f_number = std::max(f_number, depth_mm / aperture_mm);
  const double receive_mm = here_mm * receive_f_number / (2.0 * std::numbers::pi * kGaussianAperture);
  return transmit_mm * receive_mm / std::hypot(transmit_mm, receive_mm);
}

double Beam::elevation_sigma_mm(double depth_mm) const noexcept {
  // The lens focuses transmission and reception equally.
  const double receive_mm =
      one_way_sigma_mm(depth_mm, elevation_aperture_mm, elevation_focus_mm, wavelength_at_mm(depth_mm));
  if (!is_harmonic) return receive_mm / std::numbers::sqrt2;
  const double transmit_mm = transmit_sigma_mm(*this, depth_mm, elevation_aperture_mm, elevation_focus_mm);
  return transmit_mm * receive_mm / std::hypot(transmit_mm, receive_mm);
}

double harmonic_share(const Beam& beam, double depth_mm) noexcept {
  if (!beam.is_harmonic) return 1.0;
  constexpr double kNonlinearity = 4.4;  // 1 + B/2A of liver, B/A = 6.8 (6.2..7.6), Duck 1990
  constexpr double kDensity_kg_per_m3 = 1060.0;
  constexpr double kSpeed_m_per_s = 1000.0 * kScannerSpeed_mm_per_us;
  constexpr double kFocalPressure_pa = 1.2e6;  // an MI of 0.8 at 2.2 MHz [assumed], range 0.5..2.5 MPa
  constexpr double kStep_mm = 1.0;
  double grown_mm = 0.0;
  for (double at_mm = 0.5 * kStep_mm; at_mm < depth_mm; at_mm += kStep_mm)
    grown_mm += kStep_mm * focusing_gain(beam, at_mm);
  const double transmitted_rad_per_s = std::numbers::pi * 1e6 * beam.frequency_mhz;  // half of the received one
  const double face_pa = kFocalPressure_pa / focusing_gain(beam, beam.focus_mm);
  const double per_m =
      kNonlinearity * transmitted_rad_per_s * face_pa / (2.0 * kDensity_kg_per_m3 * std::pow(kSpeed_m_per_s, 3.0));
  return std::min(1e-3 * per_m * grown_mm, 1.0);
}

double clutter_level_db(const Beam& beam, double two_way_db) noexcept {
  return beam.is_harmonic ? 1.5 * two_way_db : two_way_db;
}

std::optional<double> harmonic_mhz(const Transducer& transducer, double wanted_mhz) noexcept {
  if (2.0 * transducer.lowest_mhz > transducer.highest_mhz) return std::nullopt;
  return std::clamp(wanted_mhz, 2.0 * transducer.lowest_mhz, transducer.highest_mhz);
}

Beam make_harmonic_beam(const Transducer& transducer, double received_mhz, double focus_mm) {
  Beam beam = make_beam(transducer, received_mhz, focus_mm);
  beam.is_harmonic = true;
  // The square of a Gaussian pulse of half the frequency is shorter than that pulse by the root of two.
  beam.bandwidth /= std::numbers::sqrt2;
  beam.axial_sigma_mm *= std::numbers::sqrt2;
  return beam;
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

std::vector<float> harmonic_levels(const Beam& beam, const ScanGeometry& geometry) {
  // Between depths of a table: harmonic_share() integrates from the face each time.
  constexpr double kStep_mm = 2.0;
  const double at_focus = harmonic_share(beam, beam.focus_mm);
  std::vector<double> table;
  for (double depth_mm = 0.0; depth_mm < geometry.depth_mm + 2.0 * kStep_mm; depth_mm += kStep_mm)
    table.push_back(harmonic_share(beam, depth_mm) / at_focus);
  std::vector<float> levels;
  for (int s = 0; s < geometry.samples; ++s) {
    const double place = (static_cast<double>(s) + 0.5) * geometry.sample_mm() / kStep_mm;
    const auto below = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(below);
    levels.push_back(static_cast<float>(table[below] + part * (table[below + 1] - table[below])));
  }
  return levels;
}

double harmonic_gain_db(float level) noexcept {
  constexpr double kLeast = 1e-6;
  return std::min(-20.0 * std::log10(std::max(static_cast<double>(level), kLeast)), kMostHarmonicGain_db);
}

}  // namespace trocar::ultrasound
