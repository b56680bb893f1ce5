#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/result.h"
#include "xray/projection/xray_volume.h"

namespace trocar::xray {

/// An X-ray tube with a tungsten anode.
struct Tube {
  double kv = 80.0;           ///< Peak voltage. Range 40..150.
  double aluminium_mm = 3.0;  ///< Filtration, that of the tube included. Range 0.5..20.
  double copper_mm = 0.1;     ///< Additional filter. Range 0..1.

  bool operator==(const Tube&) const = default;
};

/// Photons of a beam by energy.
struct Spectrum {
  std::vector<double> energy_kev;  ///< Middles of the bins, rising.
  std::vector<double> photons;     ///< Per mm² at 1 m from the source and mAs, by bin.
};

/// Spectrum behind the filters (docs/physics.md, X2). Error: a value out of its range.
Result<Spectrum> tube_spectrum(const Tube& tube);
/// A beam of one energy (keV): for tests and comparisons. Error: not 10..150 keV.
Result<Spectrum> one_energy(double kev);

/// Air kerma (mGy) at 1 m per mAs (docs/physics.md, X3).
double air_kerma_mgy(const Spectrum& spectrum);
/// Thickness (mm) of aluminium that halves the air kerma.
double half_value_layer_mm(const Spectrum& spectrum);

/// Signal of a detector of caesium iodide behind masses of the basis materials: the energy that it absorbs, 1 without
/// anything in the beam (Beer's law, summed over the spectrum; docs/physics.md, X4).
class Beam {
 public:
  /// `detector_mm`: thickness of caesium iodide. Range 0.1..2. Errors: out of range, an empty spectrum.
  static Result<Beam> make(const Spectrum& spectrum, double detector_mm = 0.6);

  /// Signal behind masses (g/cm², in the order of Basis). Exact.
  double signal(const std::array<double, kBases>& g_per_cm2) const noexcept;
  /// The same for each pixel, in floats: within 1e-4 of the logarithm down to a signal of 1e-20. SIMD, all cores. Each
  /// mass image is empty (none) or has all pixels.
  void signals(const MassImage& masses, std::span<float> signal) const;

  /// Photons per mm² (at 1 m, per mAs) that the detector counts in the open beam.
  double detected_photons() const noexcept;
  /// Variance of the open beam's signal from one photon per pixel: 1 for one energy, above for a spectrum (Swank).
  double noise_factor() const noexcept;
  double air_kerma_mgy() const noexcept;  ///< At 1 m per mAs.

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace trocar::xray
