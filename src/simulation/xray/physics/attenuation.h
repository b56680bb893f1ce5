#pragma once

#include <span>
#include <string>
#include <vector>

#include "xray/projection/mass_image.h"

namespace trocar::xray {

/// An element of a material and its share of the mass.
struct ElementShare {
  int atomic_number = 1;  ///< 1..92.
  double share = 1.0;     ///< 0..1; the shares of a material have the sum 1.
};

/// Mass attenuation coefficient (cm²/g) of a material, by xraylib's tables (photoelectric, incoherent and coherent
/// scattering: a narrow beam loses the photons of all three). Energy in keV, 5..200; 0 outside. Safe from any thread.
double attenuation_cm2_per_g(std::span<const ElementShare> material, double kev);
/// Mass energy-absorption coefficient (cm²/g) of dry air, 10..150 keV (held beyond): NIST's table (Hubbell and Seltzer,
/// NISTIR 5632), interpolated in logarithms. xraylib's own is up to a third lower between the table's energies.
double air_energy_absorption_cm2_per_g(double kev) noexcept;

/// Composition of a basis material: water; cortical bone (ICRP, NIST's table of compounds); iodine; stainless steel
/// (iron with 18 % chromium and 10 % nickel).
std::span<const ElementShare> composition_of(Basis basis) noexcept;
std::span<const ElementShare> aluminium() noexcept;

/// Atomic number of a chemical symbol ("Ca"); 0 if there is none.
int atomic_number_of(const std::string& symbol) noexcept;

inline constexpr double kAluminium_g_per_cm3 = 2.699, kCopper_g_per_cm3 = 8.96;

}  // namespace trocar::xray
