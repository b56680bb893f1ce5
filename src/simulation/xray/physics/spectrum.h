#pragma once

#include <vector>

#include "core/result.h"

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

}  // namespace trocar::xray
