#pragma once

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

}  // namespace trocar::xray
