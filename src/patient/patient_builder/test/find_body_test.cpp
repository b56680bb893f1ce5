#include <gtest/gtest.h>

#include <algorithm>

#include "patient_builder/build_patient.h"
#include "patient_builder/test/make_torso.h"
#include "volume/morphology.h"

namespace trocar::patient_builder {
namespace {

/// Volumes of what is body and of what should be but is not, in ml.
struct Agreement {
  double body_ml = 0.0;
  double missed_ml = 0.0;
  double extra_ml = 0.0;
};

Agreement compare(const volume::MaskGrid& found, const volume::GridGeometry& geometry) {
  Agreement agreement;
  const double voxel_ml = geometry.voxel_volume_mm3() / 1000.0;
  Torso::for_each(geometry, [&](std::size_t n, const Vec3& p_P) {
    const bool is_body = Torso::is_inside(p_P);
    agreement.body_ml += is_body ? voxel_ml : 0.0;
    agreement.missed_ml += is_body && !found.voxels[n] ? voxel_ml : 0.0;
    agreement.extra_ml += !is_body && found.voxels[n] ? voxel_ml : 0.0;
  });
  return agreement;
}

volume::MaskGrid find_in(const Torso& torso, const volume::GridGeometry& geometry) {
  return find_body(torso.ct(geometry));
}

TEST(FindBody, IsTheFilledContourWithoutTableAndSheet) {
  // Isotropic, anisotropic fine, and thick slices.
  for (const Vec3& spacing_mm : {Vec3(3, 3, 3), Vec3(1.5, 1.5, 4), Vec3(2, 2, 7)}) {
    const volume::GridGeometry geometry = Torso::grid(spacing_mm);
    const Agreement agreement = compare(find_in(Torso(), geometry), geometry);
    // The shapes are sampled without partial volume: the contour is met voxel by voxel, but for a few at its corners.
    EXPECT_LT(agreement.missed_ml, 1e-4 * agreement.body_ml) << spacing_mm.transpose();
    EXPECT_EQ(agreement.extra_ml, 0.0) << spacing_mm.transpose();
  }
}

TEST(FindBody, CutsATableThatTouchesTheBack) {
  Torso torso;
  torso.table_gap_mm = -1.0;
  torso.sheet_gap_mm = -1.0;
  const volume::GridGeometry geometry = Torso::grid({2, 2, 3});
  const Agreement agreement = compare(find_in(torso, geometry), geometry);
  EXPECT_EQ(agreement.missed_ml, 0.0);
  // What touches the skin may stay as a film at the contact, not as a plate.
  EXPECT_LT(agreement.extra_ml, 0.01 * agreement.body_ml);
}

TEST(FindBody, IsOneComponentWithoutHoles) {
  const volume::MaskGrid body = find_in(Torso(), Torso::grid({3, 3, 3}));
  EXPECT_EQ(volume::connected_components(body).voxel_counts.size(), 1u);
  EXPECT_EQ(volume::fill_holes_in_slices(body).voxels, body.voxels);
}

TEST(FindBody, KeepsTheLungBehindAThinChestWall) {
  // Only 9 mm of chest wall before a lung that fills most of the trunk: less than any table is thick.
  const volume::GridGeometry geometry = Torso::grid({3, 3, 3});
  volume::CtGrid ct = Torso().ct(geometry);
  Torso::for_each(geometry, [&](std::size_t n, const Vec3& p_P) {
    const double r = Torso::radius(p_P);
    if (r < 0.93 && p_P.y() < 20.0) ct.voxels[n] = Torso::kLung;
  });
  const volume::MaskGrid body = find_body(ct);
  const Agreement agreement = compare(body, geometry);
  EXPECT_LT(agreement.missed_ml, 0.01 * agreement.body_ml);
  EXPECT_LT(agreement.extra_ml, 0.01 * agreement.body_ml);
}

TEST(FindBody, FollowsABodyCutByTheFieldOfView) {
  volume::GridGeometry geometry = Torso::grid({3, 3, 3});
  geometry.size[0] = 60;  // from x = -220 to -40 mm: the left two thirds are missing
  const Agreement agreement = compare(find_in(Torso(), geometry), geometry);
  EXPECT_EQ(agreement.missed_ml, 0.0);
  EXPECT_EQ(agreement.extra_ml, 0.0);
}

TEST(FindBody, FindsNothingInAir) {
  const volume::MaskGrid body = find_body(volume::CtGrid(Torso::grid({6, 6, 6}), -1000));
  EXPECT_EQ(std::count(body.voxels.begin(), body.voxels.end(), 1), 0);
}

}  // namespace
}  // namespace trocar::patient_builder
