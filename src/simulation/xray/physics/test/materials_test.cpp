#include "xray/physics/materials.h"

#include <gtest/gtest.h>

#include <fstream>

#include "anatomy/testing/shipped_tissues.h"
#include "core/files/folders.h"

namespace trocar::xray {
namespace {

XrayMaterials shipped() {
  auto materials = load_xray_materials(data_dir() / "xray_materials.toml");
  EXPECT_TRUE(materials) << materials.error().text();
  return std::move(materials).value();
}

TEST(BasisShares, ReproduceEachTissueWithinOnePercent) {
  for (const XrayMaterial& material : shipped().materials) {
    EXPECT_LT(material.shares.worst_error, 0.01) << material.name;  // at any energy from 30 to 120 keV
  }
}

TEST(BasisShares, AreUnitForTheBasisMaterials) {
  const BasisShares water = fit_basis(composition_of(Basis::kWater)), bone = fit_basis(composition_of(Basis::kBone));
  EXPECT_NEAR(water.water, 1.0, 1e-9);
  EXPECT_NEAR(water.bone, 0.0, 1e-9);
  EXPECT_NEAR(bone.water, 0.0, 1e-9);
  EXPECT_NEAR(bone.bone, 1.0, 1e-9);
}

TEST(BasisShares, CannotReproduceIodine) {
  EXPECT_GT(fit_basis(composition_of(Basis::kIodine)).worst_error, 0.1);  // its edge
}

TEST(XrayMaterials, GiveEachTissueACurve) {
  const XrayMaterials materials = shipped();
  const auto tissues = anatomy::load_tissue_table(data_dir() / "tissues.toml");
  ASSERT_TRUE(tissues);
  for (const anatomy::TissueParams& tissue : tissues->tissues) {
    if (tissue.name == "air") continue;
    EXPECT_TRUE(materials.tissues.contains(tissue.name)) << tissue.name;
  }
}

TEST(XrayMaterials, KeepTheAttenuationOfTheCt) {
  // Whatever a voxel is taken for, at the CT's energy (70 keV) it attenuates as its HU say.
  const XrayMaterials materials = shipped();
  const double water = attenuation_cm2_per_g(composition_of(Basis::kWater), 70.0);
  const double bone = attenuation_cm2_per_g(composition_of(Basis::kBone), 70.0);
  for (const auto& [tissue, curve] : materials.tissues)
    for (double hu = -900.0; hu <= 2000.0; hu += 50.0) {
      const BasisDensity density = curve.at(hu);
      const double found = (density.water * water + density.bone * bone) / water;
      EXPECT_NEAR(found, 1.0 + hu / 1000.0, 0.004 * (1.0 + hu / 1000.0)) << tissue << " " << hu;  // the fit's error
    }
}

TEST(XrayMaterials, TreatDenseBoneVoxelsAsBone) {
  const XrayMaterials materials = shipped();
  const BasisDensity cortical = materials.curve_of("bone").at(1500.0), vessel = materials.curve_of("vessel").at(250.0);
  EXPECT_GT(cortical.bone, 1.7);
  EXPECT_LT(std::abs(vessel.bone), 0.05);  // contrast agent in a CT is not bone
  EXPECT_GT(materials.curve_of("no such tissue").at(1000.0).bone, 1.0);
  EXPECT_EQ(materials.unlabelled.at(-1000.0).water, 0.0);
}

TEST(XrayMaterials, RefuseBrokenFiles) {
  std::ifstream shipped_file(data_dir() / "xray_materials.toml");
  const std::string text((std::istreambuf_iterator<char>(shipped_file)), {});
  const TemporaryFolder folder;
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string other = text;
    EXPECT_NE(other.find(from), std::string::npos);
    other.replace(other.find(from), from.size(), to);
    std::ofstream(folder.path() / "a.toml") << other;
    const auto result = load_xray_materials(folder.path() / "a.toml");
    return result ? std::string() : result.error().text();
  };
  EXPECT_NE(changed("H = 0.114", "Xx = 0.114").find("Xx"), std::string::npos);
  EXPECT_NE(changed("H = 0.114", "H = 0.514").find("sum"), std::string::npos);
  EXPECT_NE(changed("skin = [\"skin\"]", "skin = [\"hide\"]").find("hide"), std::string::npos);
  EXPECT_NE(changed("[\"adipose\", \"liver\"]", "[\"liver\", \"adipose\"]").find("rising"), std::string::npos);
}

}  // namespace
}  // namespace trocar::xray
