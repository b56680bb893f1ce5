#include "phantom/layered/layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "anatomy/tissue/hounsfield.h"
#include "core/files/folders.h"
#include "patient_builder/build_patient.h"
#include "phantom/layered/layer_scene.h"
#include "volume/sampling.h"

namespace trocar::phantom {
namespace {

const anatomy::VirtualPatient& scene(const std::string& name) {
  static std::map<std::string, anatomy::VirtualPatient> scenes;
  auto it = scenes.find(name);
  if (it == scenes.end()) {
    auto patient = generate_phantom(name);
    EXPECT_TRUE(patient) << patient.error().text();
    it = scenes.emplace(name, patient ? *std::move(patient) : anatomy::VirtualPatient{}).first;
  }
  return it->second;
}

const LayerData& data() {
  static const LayerData kData = load_layer_data(data_dir() / kLayersFile).value();
  return kData;
}

/// Label and the depth at which it begins, along the expert path and 50 mm beyond.
std::vector<std::pair<std::string, double>> layers_on_path(const anatomy::VirtualPatient& patient) {
  const Segment& line = patient.paths.at(0).line_P;
  std::vector<std::pair<std::string, double>> layers;
  for (double depth = 0.05; depth < line.length_mm() + 50.0; depth += 0.05) {
    const anatomy::Label* label = anatomy::find_label(patient, line.a + depth * line.direction());
    const std::string name = label == nullptr ? "nothing" : label->name;
    if (layers.empty() || layers.back().first != name) layers.emplace_back(name, depth);
  }
  return layers;
}

void expect_layers(const std::string& name, const std::vector<std::pair<std::string, float>>& expected) {
  const auto layers = layers_on_path(scene(name));
  ASSERT_GE(layers.size(), expected.size());
  for (std::size_t n = 0; n < expected.size(); ++n) {
    EXPECT_EQ(layers[n].first, expected[n].first) << name << " " << n;
    // A border falls between two voxel centres, 0.8 mm apart.
    EXPECT_NEAR(layers[n].second, static_cast<double>(expected[n].second), 0.5) << name << " " << expected[n].first;
  }
}

TEST(LayeredScene, LumbarPathMeetsLayersAtTheirDepths) {
  expect_layers("layers-lumbar", {{"fat", 0.0F},
                                  {"supraspinous_ligament", data().lumbar.supraspinous},
                                  {"interspinous_ligament", data().lumbar.interspinous},
                                  {"ligamentum_flavum", data().lumbar.flavum},
                                  {"epidural_fat", data().lumbar.epidural},
                                  {"csf", data().lumbar.dura},
                                  {"epidural_fat", data().lumbar.sac_end}});
}

TEST(LayeredScene, AscitesPathMeetsLayersAtTheirDepths) {
  expect_layers("layers-ascites", {{"fat", 0.0F},
                                   {"muscle", data().ascites.muscle},
                                   {"fat", data().ascites.muscle_end},
                                   {"ascites", data().ascites.peritoneum},
                                   {"small_bowel", data().ascites.bowel}});
}

TEST(LayeredScene, LiverPathMeetsWallCapsuleDuctAndVein) {
  expect_layers("layers-liver", {{"fat", 0.0F},
                                 {"muscle", data().liver.muscle},
                                 {"peritoneum", data().liver.peritoneum},
                                 {"liver", data().liver.capsule},
                                 {"bile_duct", data().liver.duct - data().liver.duct_radius},
                                 {"liver", data().liver.duct + data().liver.duct_radius},
                                 {"portal_vein", data().liver.vein - data().liver.vein_radius},
                                 {"liver", data().liver.vein + data().liver.vein_radius}});
}

TEST(LayeredScene, PathRunsInwardsFromTheSkin) {
  for (const PhantomInfo& info : layered_scenes()) {
    const anatomy::VirtualPatient& patient = scene(info.name);
    ASSERT_EQ(patient.paths.size(), 1u);
    const Segment& line = patient.paths[0].line_P;
    EXPECT_NEAR(volume::sample_linear(patient.skin_distance_mm, line.a), 0.0, 1e-4) << info.name;
    EXPECT_NEAR(volume::sample_linear(patient.skin_distance_mm, line.b), -line.length_mm(), 1e-3) << info.name;
    EXPECT_EQ(line.direction().y() < 0.0, info.name == "layers-lumbar") << info.name;
    EXPECT_EQ(patient.description.substr(0, 18), "layered test scene");
  }
}

TEST(LayeredScene, BoneLiesBesideTheLumbarPath) {
  const anatomy::VirtualPatient& patient = scene("layers-lumbar");
  const Segment& line = patient.paths[0].line_P;
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
    const anatomy::Label* label = patient.label_table.find(patient.labels.voxels[n]);
    if (label == nullptr || label->tissue != "bone") continue;
    const volume::Index3 ijk = patient.labels.geometry.index_of(n);
    const Vec3 p = patient.labels.geometry.centre_mm(ijk);
    nearest_mm = std::min(nearest_mm, distance_mm(line, p));
  }
  EXPECT_GT(nearest_mm, 5.0);
  EXPECT_LT(nearest_mm, 9.0);
}

TEST(LayeredScene, HounsfieldUnitsFitTheLabels) {
  for (const PhantomInfo& info : layered_scenes()) {
    const anatomy::VirtualPatient& patient = scene(info.name);
    for (const anatomy::Finding& finding : anatomy::find_implausible_hu(patient, anatomy::label_statistics(patient)))
      ADD_FAILURE() << info.name << ": " << finding.text;
  }
  // The flavum does not show against the interspinous ligament, the dura does.
  const anatomy::VirtualPatient& lumbar_patient = scene("layers-lumbar");
  std::map<std::string, double> mean;
  for (const anatomy::LabelStatistics& s : anatomy::label_statistics(lumbar_patient))
    mean[lumbar_patient.label_table.find(s.id)->name] = s.mean_hu;
  EXPECT_LT(std::abs(mean["ligamentum_flavum"] - mean["interspinous_ligament"]), 60.0);
  EXPECT_GT(mean["csf"] - mean["epidural_fat"], 60.0);
}

TEST(LayeredScene, SeedChangesOnlyTextureAndNoise) {
  const PhantomResolution coarse{{40, 70, 40}};
  const anatomy::VirtualPatient first = *generate_phantom("layers-liver", 3, coarse);
  const anatomy::VirtualPatient again = *generate_phantom("layers-liver", 3, coarse);
  const anatomy::VirtualPatient other = *generate_phantom("layers-liver", 4, coarse);
  EXPECT_EQ(first.content_hash, again.content_hash);
  EXPECT_NE(first.ct.voxels, other.ct.voxels);
  EXPECT_EQ(first.labels.voxels, other.labels.voxels);
  EXPECT_EQ(first.skin_distance_mm.voxels, other.skin_distance_mm.voxels);
}

TEST(LayeredScene, UnknownNameListsTheScenes) {
  const auto patient = generate_phantom("layers-knee");
  ASSERT_FALSE(patient);
  EXPECT_EQ(patient.error().exit_status, 2);
  EXPECT_NE(patient.error().advice.find("layers-lumbar, layers-ascites, layers-liver"), std::string::npos);
  EXPECT_FALSE(make_layered_scene("abdomen", 1));
}

}  // namespace
}  // namespace trocar::phantom
