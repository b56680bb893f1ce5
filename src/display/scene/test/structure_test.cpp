#include "scene/structure.h"

#include <gtest/gtest.h>

namespace trocar::scene {
namespace {

constexpr std::uint8_t kLiver = 1, kLesion = 2, kFat = 3;

/// 100 mm of liver in fat, with a lesion of 10 mm in its middle.
anatomy::VirtualPatient liver_in_fat() {
  anatomy::VirtualPatient patient;
  volume::GridGeometry g;
  g.size = {80, 80, 80};
  g.spacing_mm = {2.0, 2.0, 2.0};
  patient.labels = volume::LabelGrid(g, kFat);
  patient.label_table.labels = {
      {kLiver, "liver", "liver"}, {kLesion, "tumour", "liver_lesion"}, {kFat, "fat", "adipose"}};
  const Vec3 middle_P(80, 80, 80);
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
    const volume::Index3 ijk = g.index_of(n);
    const double away_mm = (g.centre_mm(ijk) - middle_P).norm();
    if (away_mm < 50.0) patient.labels.voxels[n] = away_mm < 5.0 ? kLesion : kLiver;
  }
  return patient;
}

TEST(Structure, FindsALesionAsTargetWithinItsOrgan) {
  EXPECT_EQ(find_aim(liver_in_fat(), {80, 80, 80}), (Aim{"tumour", "liver"}));
}

TEST(Structure, FindsTheOrganAroundADeepPoint) {
  EXPECT_EQ(find_aim(liver_in_fat(), {80, 80, 106}), (Aim{"", "liver"}));
}

TEST(Structure, DoesNotTargetFat) {
  EXPECT_EQ(find_aim(liver_in_fat(), {80, 80, 5}), (Aim{"", ""}));
  EXPECT_EQ(find_aim(liver_in_fat(), {80, 80, 140}), (Aim{"", "liver"}));  // 10 mm beside the liver
}

TEST(Structure, TargetPresetShowsTheOrganAroundABarePoint) {
  const StructureInfo liver{"liver", StructureKind::kOrgan, {}, 0.5, 0.5};
  const Aim aim = find_aim(liver_in_fat(), {80, 80, 106});
  const double opacity = preset_opacity(liver, StructurePreset::kTarget, aim.around_name);
  EXPECT_GT(opacity, 0.1);
  EXPECT_LT(opacity, 0.6);
}

}  // namespace
}  // namespace trocar::scene
