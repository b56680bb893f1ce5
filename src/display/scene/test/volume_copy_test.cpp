#include "scene/detail/volume_copy.h"

#include <gtest/gtest.h>

namespace trocar::scene::detail {
namespace {

constexpr std::uint8_t kBone = 1, kVessel = 2;
constexpr std::array<std::int64_t, 3> kAll = {1, 1, 1};

/// 40 x 40 x 40 mm of soft tissue with marrow (i below 10) and a vessel in contact with it (i 10 and 11), both 200 HU.
anatomy::VirtualPatient marrow_beside_vessel() {
  anatomy::VirtualPatient patient;
  volume::GridGeometry g;
  g.size = {40, 40, 40};
  patient.ct = volume::CtGrid(g, 50);
  patient.labels = volume::LabelGrid(g);
  patient.label_table.labels = {{kBone, "vertebra", "bone"}, {kVessel, "aorta", "vessel"}};
  for (std::size_t n = 0; n < patient.ct.voxels.size(); ++n) {
    const std::int64_t i = g.index_of(n)[0];
    if (i > 11) continue;
    patient.ct.voxels[n] = 200;
    patient.labels.voxels[n] = i < 10 ? kBone : kVessel;
  }
  return patient;
}

TEST(VolumeCopy, KeepsVesselsWhenRemovingBone) {
  const anatomy::VirtualPatient patient = marrow_beside_vessel();
  const volume::CtGrid cloud = make_cloud(patient, CloudContent::kWithoutBone, kAll);
  EXPECT_LT((cloud[{5, 20, 20}]), 100);
  EXPECT_LT((cloud[{9, 20, 20}]), 100);
  EXPECT_EQ((cloud[{10, 20, 20}]), 200);
  EXPECT_EQ((cloud[{30, 20, 20}]), 50);
  EXPECT_EQ(make_cloud(patient, CloudContent::kWhole, kAll).voxels, patient.ct.voxels);
}

TEST(VolumeCopy, RemovesTheBlurredEdgeOfBone) {
  anatomy::VirtualPatient patient = marrow_beside_vessel();
  for (std::uint8_t& label : patient.labels.voxels) label = label == kVessel ? 0 : label;
  EXPECT_LT((make_cloud(patient, CloudContent::kWithoutBone, kAll)[{11, 20, 20}]), 100);
}

TEST(VolumeCopy, RemovesNothingWithoutLabels) {
  anatomy::VirtualPatient patient = marrow_beside_vessel();
  patient.labels = {};
  EXPECT_EQ(make_cloud(patient, CloudContent::kWithoutBone, kAll).voxels, patient.ct.voxels);
}

TEST(VolumeCopy, SkinOnlyReplacesTheTableByAirAndGasByFat) {
  anatomy::VirtualPatient patient;
  volume::GridGeometry g;
  g.size = {3, 1, 1};
  patient.ct = volume::CtGrid(g, -950);
  patient.ct.voxels[0] = 300;  // table
  patient.skin_distance_mm = volume::FloatGrid(g, -20.0F);
  patient.skin_distance_mm.voxels = {30.0F, -0.5F, -20.0F};
  EXPECT_EQ(make_cloud(patient, CloudContent::kWithoutGas, kAll).voxels,
            (std::vector<std::int16_t>{-1000, -950, -100}));
  EXPECT_EQ(make_cloud(patient, CloudContent::kWhole, kAll).voxels, (std::vector<std::int16_t>{-1000, -950, -950}));
}

TEST(VolumeCopy, BlocksAreNearlyCubicAndCentredOnTheirVoxels) {
  volume::GridGeometry g;
  g.size = {512, 512, 119};
  g.spacing_mm = {0.743, 0.743, 1.6};
  g.origin_P = {-100, -50, 20};
  const auto steps = cloud_steps(g, 220);
  EXPECT_EQ(steps, (std::array<std::int64_t, 3>{2, 2, 1}));
  anatomy::VirtualPatient patient;
  g.size = {9, 4, 2};
  patient.ct = volume::CtGrid(g);
  for (std::size_t n = 0; n < patient.ct.voxels.size(); ++n)
    patient.ct.voxels[n] = static_cast<std::int16_t>(100 * g.index_of(n)[0]);
  const volume::CtGrid cloud = make_cloud(patient, CloudContent::kWhole, steps);
  EXPECT_EQ(cloud.geometry.size, (std::array<std::int64_t, 3>{4, 2, 2}));
  EXPECT_NEAR((cloud.geometry.origin_P - g.to_mm({0.5, 0.5, 0.0})).norm(), 0.0, 1e-12);
  EXPECT_EQ((cloud[{1, 1, 1}]), 250);
}

TEST(VolumeCopy, SmallGridStaysOneBlock) {
  volume::GridGeometry g;
  g.size = {440, 1, 1};
  g.spacing_mm = {1.0, 0.1, 0.1};
  EXPECT_EQ(cloud_steps(g, 220), (std::array<std::int64_t, 3>{2, 1, 1}));
}

}  // namespace
}  // namespace trocar::scene::detail
