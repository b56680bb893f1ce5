#include "xray/physics/beam.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/parallel.h"
#include "xray/physics/attenuation.h"
#include "xray/physics/detail/beam_sum.h"

namespace trocar::xray {

struct Beam::Impl {
  std::vector<double> weight;  ///< Share of an energy in the open beam's signal.
  std::array<std::vector<double>, kBases> cm2_per_g;
  detail::BeamTerms terms;  ///< The same in floats, for images.
  double detected_photons = 0.0, noise_factor = 1.0, air_kerma_mgy = 0.0;
};

namespace {

// A layer of needles of caesium iodide, 80 % of it filled (columnar scintillators: 75 to 85 %).
constexpr double kDetector_g_per_cm3 = 0.8 * 4.51;
constexpr std::array<ElementShare, 2> kCaesiumIodide{{{53, 0.48846}, {55, 0.51154}}};
constexpr double kNegligible = 1e-9;  ///< Share of the signal below which an energy is left out.

/// Share of the photons that interact in the detector. A photon gives all its energy: the fluorescence that follows
/// is absorbed nearby.
double absorbed_share(double kev, double detector_mm) {
  return -std::expm1(-attenuation_cm2_per_g(kCaesiumIodide, kev) * kDetector_g_per_cm3 * 0.1 * detector_mm);
}

constexpr std::size_t kGrainAbsorbed = 4096;  ///< Pixels of a part of the work.

}  // namespace

Result<Beam> Beam::make(const Spectrum& spectrum, double detector_mm) {
  if (!(detector_mm >= 0.1 && detector_mm <= 2.0))
    return fail_usage(fmt::format("the detector's caesium iodide is {:g} mm thick", detector_mm), "X-ray detector",
                      "give a value from 0.1 to 2 mm");
  auto impl = std::make_shared<Impl>();
  double energy = 0.0, energy_squared = 0.0;
  for (std::size_t n = 0; n < spectrum.energy_kev.size(); ++n) {
    const double kev = spectrum.energy_kev[n];
    const double counted = spectrum.photons[n] * absorbed_share(kev, detector_mm);
    impl->detected_photons += counted;
    energy += counted * kev;
    energy_squared += counted * kev * kev;
  }
  if (!(energy > 0.0) || !std::isfinite(energy))
    return fail_usage("the beam has no photons", "X-ray beam", "give a spectrum of energies from 10 to 150 keV");
  for (std::size_t n = 0; n < spectrum.energy_kev.size(); ++n) {
    const double kev = spectrum.energy_kev[n];
    const double weight = spectrum.photons[n] * absorbed_share(kev, detector_mm) * kev / energy;
    if (weight < kNegligible) continue;
    impl->weight.push_back(weight);
    impl->terms.weight.push_back(static_cast<float>(weight));
    for (std::size_t m = 0; m < kBases; ++m) {
      const double c = attenuation_cm2_per_g(composition_of(static_cast<Basis>(m)), kev);
      impl->cm2_per_g[m].push_back(c);
      impl->terms.cm2_per_g[m].push_back(static_cast<float>(c));
    }
  }
  impl->noise_factor = energy_squared * impl->detected_photons / (energy * energy);
  impl->air_kerma_mgy = trocar::xray::air_kerma_mgy(spectrum);
  Beam beam;
  beam.impl_ = std::move(impl);
  return beam;
}

double Beam::signal(const std::array<double, kBases>& g_per_cm2) const noexcept {
  double sum = 0.0;
  for (std::size_t n = 0; n < impl_->weight.size(); ++n) {
    double exponent = 0.0;
    for (std::size_t m = 0; m < kBases; ++m) exponent += g_per_cm2[m] * impl_->cm2_per_g[m][n];
    sum += impl_->weight[n] * std::exp(-exponent);
  }
  return sum;
}

void Beam::signals(const MassImage& masses, std::span<float> signal) const {
  TROCAR_CHECK(signal.size() == masses.size());  // one signal a pixel
  std::array<const float*, kBases> first{};
  for (std::size_t m = 0; m < kBases; ++m) {
    const std::vector<float>& image = masses.g_per_cm2[m];
    TROCAR_CHECK(image.empty() || image.size() == masses.size());
    first[m] = image.empty() ? nullptr : image.data();
  }
  parallel_for(signal.size(), kGrainAbsorbed, [&](std::size_t begin, std::size_t end) {
    std::array<const float*, kBases> from{};
    for (std::size_t m = 0; m < kBases; ++m) from[m] = first[m] == nullptr ? nullptr : first[m] + begin;
    detail::sum_terms(impl_->terms, from, end - begin, signal.data() + begin);
  });
}

double Beam::detected_photons() const noexcept {
  return impl_->detected_photons;
}

double Beam::noise_factor() const noexcept {
  return impl_->noise_factor;
}

double Beam::air_kerma_mgy() const noexcept {
  return impl_->air_kerma_mgy;
}

}  // namespace trocar::xray
