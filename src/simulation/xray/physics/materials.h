#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "xray/physics/attenuation.h"

namespace trocar::xray {

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
