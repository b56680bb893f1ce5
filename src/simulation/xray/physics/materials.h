#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "xray/projection/xray_volume.h"

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

/// A material as a mixture of the basis materials water and bone: mass of each per mass of the material. One of them
/// may be negative.
struct BasisShares {
  double water = 1.0, bone = 0.0;
  double worst_error = 0.0;  ///< Largest relative error of the attenuation, 30..120 keV.
};
/// Least squares of the relative error over 30..120 keV.
BasisShares fit_basis(std::span<const ElementShare> material);

/// Densities (g/cm³) of the basis materials in a voxel.
struct BasisDensity {
  double water = 0.0, bone = 0.0;
};

/// Densities of the basis materials over HU: linear between knots; below the first one linear to nothing at -1000 HU,
/// above the last one in proportion to the attenuation.
class HuCurve {
 public:
  struct Knot {
    double hu = 0.0;
    BasisDensity density;
  };
  /// `knots`: at least one, HU rising, above -1000.
  explicit HuCurve(std::vector<Knot> knots) : knots_(std::move(knots)) {}
  BasisDensity at(double hu) const noexcept;

 private:
  std::vector<Knot> knots_;
};

/// Water up to 0 HU, a mixture by volume of water and cortical bone (1.85 g/cm³) above.
HuCurve water_and_bone_curve();

/// A material of data/xray_materials.toml.
struct XrayMaterial {
  std::string name;
  double density_g_per_cm3 = 1.0;
  std::vector<ElementShare> elements;
  BasisShares shares;
  double hu = 0.0;  ///< Of the material in a CT.
};

/// Materials, and the curve of each tissue (docs/physics.md, X5).
struct XrayMaterials {
  std::vector<XrayMaterial> materials;
  std::map<std::string, HuCurve, std::less<>> tissues;
  HuCurve unlabelled{{HuCurve::Knot{}}};

  /// Curve of a tissue; the one of unlabelled voxels if it has none.
  const HuCurve& curve_of(std::string_view tissue) const noexcept;
};

/// Reads data/xray_materials.toml. Errors name the line: an unknown element or material, shares whose sum is not 1,
/// materials that do not rise in HU.
Result<XrayMaterials> load_xray_materials(const std::filesystem::path& file);

}  // namespace trocar::xray
