#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trocar::xray {

/// A flat-panel detector of caesium iodide with an anti-scatter grid.
struct DetectorParams {
  double scintillator_mm = 0.6;  ///< Thickness of the caesium iodide. Range 0.1..2.
  /// Scatter-to-primary ratio before the grid per g/cm² on the ray, in a field much wider than scatter_spread_mm: 3
  /// behind 20 cm of water, as in a field of 30 x 30 cm (Bushberg et al., The Essential Physics of Medical Imaging,
  /// chapter on radiography). Range 0..0.5.
  double scatter_per_g_per_cm2 = 0.15;
  double scatter_spread_mm = 40.0;  ///< Standard deviation at the detector; assumed. Range 5..150.
  double grid_primary = 0.70;       ///< Share of the primary that the grid transmits; assumed. Range 0.3..1.
  double grid_scatter = 0.15;       ///< Share of the scatter that the grid transmits; assumed. Range 0..1.
  /// Modulation transfer at half its value, line pairs per mm; of a panel with 0.5 mm of caesium iodide. Range 0.3..10.
  double mtf_half_lp_per_mm = 1.4;
  double focal_spot_mm = 0.6;  ///< Edge of the focal spot (IEC 60336 nominal value). Range 0..2.
  double lag_share = 0.03;     ///< Share of the signal that is left 1/30 s later; assumed. Range 0..0.5.
};

/// First-order lag of the detector: a share of the former signal is left in the next image. docs/physics.md, X10.
class Lag {
 public:
  /// Mixes the former images into a signal that is read `elapsed_s` after the former one, and keeps it. `share`:
  /// DetectorParams::lag_share, left after 1/30 s. The first image, and the first of another size, are unchanged.
  void apply(double share, double elapsed_s, std::span<float> signal);
  void reset() noexcept { former_.clear(); }

 private:
  std::vector<float> former_;
};

/// Number of photons behind a signal.
struct PhotonCount {
  double open_beam = 0.0;     ///< Detected photons per pixel and exposure in the open beam (signal 1). > 0.
  double noise_factor = 1.0;  ///< Beam::noise_factor().
};

/// Adds the noise of counted photons: normal, independent from pixel to pixel, with the variance
/// noise_factor * signal / open_beam, and keeps the signal >= 0. The numbers depend on the seed and the pixel only,
/// not on the number of threads. All cores, no allocation. docs/physics.md, X9.
void add_quantum_noise(const PhotonCount& photons, std::uint64_t seed, std::span<float> signal);

}  // namespace trocar::xray
