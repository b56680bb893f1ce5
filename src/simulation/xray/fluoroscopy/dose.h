#pragma once

#include <array>

#include "xray/geometry/c_arm.h"

namespace trocar::xray {

/// Pulses per second of pulsed fluoroscopy.
inline constexpr std::array<double, 3> kPulseRates_per_s{7.5, 15.0, 30.0};

/// Air kerma and photons fall with the square of the distance from the source. `at_1_m`: at 1000 mm.
double at_distance(double at_1_m, double distance_mm) noexcept;

/// Distance of the patient entrance reference point from the source: 150 mm before the isocentre (IEC 60601-2-43).
double reference_distance_mm(const CArm& arm) noexcept;

/// Irradiated area (cm²) of the collimated beam at a distance from the source.
double irradiated_area_cm2(const CArm& arm, double distance_mm) noexcept;

/// Dose indicators of an examination, summed over its pulses (docs/physics.md, X11).
struct Dose {
  double beam_on_s = 0.0;             ///< Time with the pedal down.
  double air_kerma_mgy = 0.0;         ///< At the reference point, without backscatter.
  double area_product_mgy_cm2 = 0.0;  ///< Air kerma times irradiated area, the same at every distance.
  int pulses = 0;
};

/// Adds pulses. `kerma_mgy_per_mas`: air kerma at 1 m (Beam::air_kerma_mgy); `mas`: of one pulse.
void add_pulses(int pulses, double mas, double kerma_mgy_per_mas, const CArm& arm, Dose& dose) noexcept;

}  // namespace trocar::xray
