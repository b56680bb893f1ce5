#pragma once

#include <array>
#include <cstddef>

namespace trocar::anatomy {

/// Resistance of tissue as a function of HU, for unlabelled tissue (paper B, eqs. 1 to 5; physics.md B1 to B4).
struct HuLaw {
  double stiffness_n_per_mm = 1.0;         ///< Stiffness k before the proxy moves. Range 0.01..50.
  double normal_n = 0.0;                   ///< T_N: threshold along the gradient, into denser tissue. Range 0..200.
  double tangential_n = 0.0;               ///< T_T: threshold across the gradient. Range 0..50.
  double resistance_n = 0.0;               ///< R0: force that the tip needs to move at all. Range 0..50.
  double viscosity_ns_per_mm = 0.0;        ///< c: R = R0 + c|v|. Range 0..1.
  double shaft_n_per_mm = 0.0;             ///< Dry friction per mm of inserted shaft. Range 0..0.1.
  double shaft_viscosity_ns_per_mm = 0.0;  ///< nu of the friction law F1. Range 0..1.
  double young_kpa = 10.0;                 ///< Young's modulus under slow load. Range 0..100000.
};

/// Transfer functions over HU, piecewise linear between knots, constant beyond the outermost. Fixed size: read in the
/// tick.
struct HuTransfer {
  static constexpr std::size_t kMaxKnots = 24;
  std::array<double, kMaxKnots> hu{};  ///< Strictly rising.
  std::array<HuLaw, kMaxKnots> laws{};
  std::size_t knot_count = 0;  ///< 0: no transfer functions; the proxy models refuse the table.

  double gradient_scale_mm = 1.5;         ///< Half distance of the central differences. Range 0.2..5.
  double gradient_none_hu_per_mm = 15.0;  ///< Gradient below which there is no border, only viscosity. Range 0..500.
  /// Gradient from which the border has full effect. Range above the former..1000.
  double gradient_full_hu_per_mm = 30.0;

  /// Real-time safe; NaN reads as the first knot.
  HuLaw at(double hu_value) const noexcept;
};

}  // namespace trocar::anatomy
