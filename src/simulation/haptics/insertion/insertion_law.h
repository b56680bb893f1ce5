#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace trocar::haptics {

/// Force laws of paper A, section 4.1, as printed, or as in docs/physics.md where the paper leaves a choice. Pure,
/// closed form, real-time safe. Forces are resistances: positive pushes the needle out.

/// Coefficients of one layer's loading law.
struct LoadingLaw {
  double stiffness_n_per_mm = 0.0;   ///< k
  double viscosity_ns_per_mm = 0.0;  ///< nu
  double delta_x_mm = 1.0;           ///< Displacement after which a further Voigt element is added; > 0.
};

/// Pre-puncture force (N) of the incremental viscoelastic model at displacement x and velocity v (physics.md P1):
/// x (6 nu v dx + k x^2 + 3 k x dx + 2 k dx^2) / (6 dx^2); zero for x <= 0 and never negative on retreat.
double prepuncture_force_n(double x_mm, double v_mm_per_s, const LoadingLaw& law) noexcept;

/// Static displacement (mm) at which the layer carries `force_n`: the inverse of prepuncture_force_n at v = 0.
double static_displacement_mm(double force_n, const LoadingLaw& law) noexcept;

/// Static tangent stiffness dF/dx (N/mm) at displacement x.
double tangent_stiffness_n_per_mm(double x_mm, const LoadingLaw& law) noexcept;

/// Contact area of the shaft with one tissue in cm^2 (physics.md F1: in mm^2 the friction would be a hundred times too
/// high).
double contact_area_cm2(double radius_mm, double inserted_mm) noexcept;

/// Fluctuation of the friction, -1..1, uniform at its nodes: a seeded function of the travelled distance with
/// correlation length 0.2 mm, independent of the tick rate (physics.md F2).
double friction_noise(std::uint64_t seed, std::uint32_t tissue, double travel_mm) noexcept;

/// Fades out a force as the needle comes to rest: 0 at rest, 1 from 0.5 mm/s (physics.md F2).
inline constexpr double kRestSpeed_mm_per_s = 0.5;
inline double motion_fade(double speed_mm_per_s) noexcept {
  return std::clamp(std::abs(speed_mm_per_s) / kRestSpeed_mm_per_s, 0.0, 1.0);
}

/// Viscous friction of the body proxies as a share of the linear one (physics.md B6): 1 at rest, 1/2 at
/// kThinning_mm_per_s.
inline constexpr double kThinning_mm_per_s = 15.0;  ///< Range 10..100. [assumed]
inline double shear_thinning(double speed_mm_per_s) noexcept {
  return 1.0 / (1.0 + std::abs(speed_mm_per_s) / kThinning_mm_per_s);
}

inline constexpr double kNoiseCorrelation_mm = 0.2;

}  // namespace trocar::haptics
