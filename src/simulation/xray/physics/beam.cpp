#include "xray/physics/beam.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/result.h"
#include "xray/physics/detail/beam_sum.h"
#include "xray/physics/materials.h"

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

namespace {

constexpr double kLowestPhoton_kev = 10.0;  ///< Photons below do not leave the tube's filter.
constexpr double kBin_kev = 1.0;
constexpr double kAnode_deg = 12.0;
constexpr double kTungstenKEdge_kev = 69.525;
constexpr double kElectronRest_kev = 510.999;
constexpr double kElectronsPerMas = 6.241509e15;
constexpr double kSphere_mm2 = 4.0 * std::numbers::pi * 1e6;  ///< Of 1 m radius: the photons leave to all sides alike.
constexpr double kJoulePerKev = 1.602177e-16;
constexpr std::array<ElementShare, 1> kTungsten{{{74, 1.0}}};
constexpr std::array<ElementShare, 1> kCopper{{{29, 1.0}}};

// The model of Tucker, Barnes and Chakraborty, Med Phys 18:402 (1991): bremsstrahlung and K lines arise along the way
// of an electron into the anode, and the anode attenuates them on their way out. Constants: tables 1 and 2 there.

/// alpha r_e² Z² / A (cm²/g) for tungsten.
constexpr double kRadiation_cm2_per_g = 0.57955e-27 * 74.0 * 74.0 / (183.84 * 1.660539e-24);

/// Thomson and Whiddington's constant (keV² cm²/g): T² falls by it per mass along the way.
double slowing_of(double kv) {
  constexpr std::array<std::array<double, 2>, 5> kTable{
      {{50.0, 5.4e5}, {75.0, 6.25e5}, {100.0, 7.0e5}, {150.0, 8.4e5}, {200.0, 1.0e6}}};
  for (std::size_t n = 1; n < kTable.size(); ++n) {
    const auto& [kv_a, a] = kTable[n - 1];
    const auto& [kv_b, b] = kTable[n];
    if (kv <= kv_b) return a + (b - a) * (std::max(kv, kv_a) - kv_a) / (kv_b - kv_a);
  }
  return kTable.back()[1];
}

/// Radiated energy per photon energy of an electron of energy T, in units of alpha r_e² Z² (T + mc²) / T, at a photon
/// energy that is this share of T. The paper lists a thousandth of the factor (stopping power in MeV).
double radiation_of(double kv, double share) {
  return (36.85 + 0.0290 * kv) * (1.0 + share * (-5.049 + share * (10.847 + share * (-10.516 + share * 3.842))));
}

double stopping_kev_cm2_per_g(double t_kev) {
  return 2024.1 + 10361.0 * std::exp(-0.04695 * t_kev);
}

/// Bremsstrahlung photons per electron and keV that leave the anode.
double bremsstrahlung(double kv, double kev) {
  constexpr int kSteps = 100;
  const double way_out = attenuation_cm2_per_g(kTungsten, kev) / (slowing_of(kv) * std::sin(radians(kAnode_deg)));
  const double step = (kv - kev) / kSteps;
  double sum = 0.0;
  for (int n = 0; n < kSteps; ++n) {
    const double t = kev + (n + 0.5) * step;
    sum += radiation_of(kv, kev / t) * (t + kElectronRest_kev) / t / stopping_kev_cm2_per_g(t) *
           std::exp(-way_out * (kv * kv - t * t));
  }
  return kRadiation_cm2_per_g / kev * sum * step;
}

struct Line {
  double kev, share;
};
constexpr std::array<Line, 4> kLines{{{59.32, 0.4500}, {57.98, 0.2592}, {67.20, 0.1521}, {69.10, 0.0387}}};

/// Photons per electron of a K line that leave the anode.
double line_photons(double kv, const Line& line) {
  if (kv <= kTungstenKEdge_kev) return 0.0;
  constexpr int kSteps = 100;
  constexpr double kYield = 1.349e-3, kExponent = 1.648;
  const double depth = (kv * kv - kTungstenKEdge_kev * kTungstenKEdge_kev) / slowing_of(kv);
  const double way_out = attenuation_cm2_per_g(kTungsten, line.kev) * depth / std::sin(radians(kAnode_deg));
  double escaping = 0.0;
  for (int n = 0; n < kSteps; ++n) {
    const double x = (n + 0.5) / kSteps;
    escaping += 1.5 * (1.0 - x * x) * std::exp(-way_out * x) / kSteps;
  }
  return kYield * std::pow(kv / kTungstenKEdge_kev - 1.0, kExponent) * line.share * escaping;
}

Status check_tube(const Tube& tube) {
  struct TubeLimit {
    const char* name;
    double value, low, high;
    const char* unit;
  };
  const TubeLimit limits[] = {{"tube voltage", tube.kv, 40.0, 150.0, "kV"},
                              {"aluminium filter", tube.aluminium_mm, 0.5, 20.0, "mm"},
                              {"copper filter", tube.copper_mm, 0.0, 1.0, "mm"}};
  for (const TubeLimit& limit : limits)
    if (!(limit.value >= limit.low && limit.value <= limit.high))
      return fail_usage(fmt::format("the {} is {:g} {}", limit.name, limit.value, limit.unit), "X-ray tube",
                        fmt::format("give a value from {:g} to {:g} {}", limit.low, limit.high, limit.unit));
  return {};
}

/// Air kerma behind a further thickness of aluminium.
double kerma_behind_mgy(const Spectrum& spectrum, double aluminium_mm) {
  constexpr double kMm2PerCm2 = 100.0, kMilligrayPerJoulePerGram = 1e6;
  double sum = 0.0;
  for (std::size_t n = 0; n < spectrum.energy_kev.size(); ++n) {
    const double kev = spectrum.energy_kev[n];
    const double through =
        std::exp(-attenuation_cm2_per_g(aluminium(), kev) * kAluminium_g_per_cm3 * 0.1 * aluminium_mm);
    sum += spectrum.photons[n] * through * kev * air_energy_absorption_cm2_per_g(kev);
  }
  return sum * kMm2PerCm2 * kJoulePerKev * kMilligrayPerJoulePerGram;
}

}  // namespace

Result<Spectrum> tube_spectrum(const Tube& tube) {
  TROCAR_TRY_STATUS(check_tube(tube));
  const auto bins = static_cast<std::size_t>(std::lround((tube.kv - kLowestPhoton_kev) / kBin_kev));
  const double width = (tube.kv - kLowestPhoton_kev) / static_cast<double>(bins);
  Spectrum spectrum;
  for (std::size_t n = 0; n < bins; ++n) {
    spectrum.energy_kev.push_back(kLowestPhoton_kev + (static_cast<double>(n) + 0.5) * width);
    spectrum.photons.push_back(bremsstrahlung(tube.kv, spectrum.energy_kev.back()) * width);
  }
  for (const Line& line : kLines) {
    const auto bin = static_cast<std::size_t>((line.kev - kLowestPhoton_kev) / width);
    if (bin < bins) spectrum.photons[bin] += line_photons(tube.kv, line);
  }
  for (std::size_t n = 0; n < bins; ++n) {
    const double kev = spectrum.energy_kev[n];
    const double filter = 0.1 * (attenuation_cm2_per_g(aluminium(), kev) * kAluminium_g_per_cm3 * tube.aluminium_mm +
                                 attenuation_cm2_per_g(kCopper, kev) * kCopper_g_per_cm3 * tube.copper_mm);
    spectrum.photons[n] *= kElectronsPerMas / kSphere_mm2 * std::exp(-filter);
  }
  return spectrum;
}

Result<Spectrum> one_energy(double kev) {
  if (!(kev >= kLowestPhoton_kev && kev <= 150.0))
    return fail_usage(fmt::format("the photon energy is {:g} keV", kev), "X-ray spectrum",
                      "give a value from 10 to 150 keV");
  return Spectrum{{kev}, {1.0}};
}

double air_kerma_mgy(const Spectrum& spectrum) {
  return kerma_behind_mgy(spectrum, 0.0);
}

double half_value_layer_mm(const Spectrum& spectrum) {
  const double half = 0.5 * kerma_behind_mgy(spectrum, 0.0);
  double low = 0.0, high = 1.0;
  while (kerma_behind_mgy(spectrum, high) > half && high < 1e3) high *= 2.0;
  constexpr int kHalvings = 50;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (low + high);
    (kerma_behind_mgy(spectrum, middle) > half ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace trocar::xray
