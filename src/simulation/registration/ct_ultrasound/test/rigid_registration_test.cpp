#include "registration/ct_ultrasound/rigid_registration.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/parallel.h"
#include "lab/registration/generated_pair.h"
#include "registration/ct_ultrasound/overlay_picture.h"

namespace trocar::registration {
namespace {

/// Measured at most 0.5 mm at this coarse spacing of 2 mm.
constexpr double kWorst_mm = 0.8;

testing::GeneratedPair pair_off(std::uint64_t seed, double mm = 10.0, double degrees = 10.0) {
  testing::PairOptions options;
  options.seed = seed;
  options.offset_mm = mm;
  options.offset_rad = degrees * kRadPerDeg;
  return testing::make_pair(options);
}

Beams beams_of(const volume::LabelGrid& us) {
  return *Beams::along_axis("+y", us.geometry);
}

double error_mm(const testing::GeneratedPair& pair, const Pose& X_CU) {
  return *mean_distance_mm(pair.us, beams_of(pair.us), X_CU, pair.X_CU);
}

TEST(RigidRegistration, FindsTheKnownPose) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const testing::GeneratedPair pair = pair_off(seed);
    const auto found = register_rigid(pair.ct, pair.us, beams_of(pair.us), {});
    ASSERT_TRUE(found) << found.error().text();
    EXPECT_GT(error_mm(pair, Pose()), 8.0);  // the start is far away
    EXPECT_LT(error_mm(pair, found->X_CU), kWorst_mm) << "seed " << seed;
    EXPECT_GE(found->confidence, kLeastConfidence) << "seed " << seed;
    EXPECT_GT(found->overlap, 0.8);
  }
}

TEST(RigidRegistration, IsIndependentOfTheNumberOfThreads) {
  const testing::GeneratedPair pair = pair_off(1);
  const auto found = register_rigid(pair.ct, pair.us, beams_of(pair.us), {});
  ASSERT_TRUE(found);
  run_on_threads(1, [&] {
    const auto again = register_rigid(pair.ct, pair.us, beams_of(pair.us), {});
    ASSERT_TRUE(again);
    EXPECT_EQ(again->X_CU.R(), found->X_CU.R());
    EXPECT_EQ(again->X_CU.p(), found->X_CU.p());
    EXPECT_EQ(again->confidence, found->confidence);
  });
}

TEST(RigidRegistration, HasLowConfidenceForAnotherPatient) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const testing::GeneratedPair pair = pair_off(seed);
    const testing::GeneratedPair other = pair_off(seed + 50);
    const auto found = register_rigid(other.ct, pair.us, beams_of(pair.us), {});
    EXPECT_TRUE(!found || found->confidence < kLeastConfidence) << "seed " << seed << ' ' << found->confidence;
  }
}

TEST(RigidRegistration, HasLowConfidenceUpsideDown) {
  const testing::GeneratedPair pair = pair_off(1, 0.0, 0.0);
  volume::LabelGrid flipped(pair.us.geometry);
  const auto size = flipped.geometry.size;
  for (std::size_t n = 0; n < flipped.voxels.size(); ++n) {
    const volume::Index3 ijk = flipped.geometry.index_of(n);
    flipped.voxels[n] = pair.us[{ijk[0], size[1] - 1 - ijk[1], size[2] - 1 - ijk[2]}];
  }
  const auto found = register_rigid(pair.ct, flipped, *Beams::along_axis("-y", flipped.geometry), {});
  EXPECT_TRUE(!found || found->confidence < kLeastConfidence);
}

TEST(RigidRegistration, RefusesVolumesThatCannotBeRegistered) {
  const testing::GeneratedPair pair = pair_off(1);
  const auto what = [&](const volume::LabelGrid& us, const Pose& X_CU) {
    RigidOptions options;
    options.X_CU = X_CU;
    const auto found = register_rigid(pair.ct, us, beams_of(us), options);
    return found ? std::string() : found.error().what;
  };
  EXPECT_NE(what(volume::LabelGrid(pair.us.geometry, 90), Pose()).find("same gray level"), std::string::npos);
  EXPECT_NE(what(pair.us, Pose::translation(Vec3(500, 0, 0))).find("do not overlap"), std::string::npos);
  volume::LabelGrid shadow = pair.us;
  for (std::size_t n = 0; n < shadow.voxels.size(); ++n)
    if (shadow.geometry.index_of(n)[1] > 1) shadow.voxels[n] = 1;
  EXPECT_NE(what(shadow, Pose()).find("shadow"), std::string::npos);
}

TEST(RigidRegistration, EndsWhenCancelled) {
  const testing::GeneratedPair pair = pair_off(1);
  RigidOptions options;
  options.is_cancelled = [] { return true; };
  const auto found = register_rigid(pair.ct, pair.us, beams_of(pair.us), options);
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().what.find("cancelled"), std::string::npos);
}

TEST(OverlayPicture, ShowsBothVolumesSideBySide) {
  const testing::GeneratedPair pair = pair_off(2);
  const auto picture = overlay_picture(pair.ct, pair.us, beams_of(pair.us), pair.X_CU);
  ASSERT_TRUE(picture);
  EXPECT_GT(picture->columns, picture->rows);
  // The blend is orange where there is ultrasound: red above blue.
  const image::Rgb blend = picture->at(picture->columns - picture->columns / 8, picture->rows / 4);
  EXPECT_GT(blend[0], blend[2]);
  const image::Rgb gray = picture->at(picture->columns / 8, picture->rows / 4);
  EXPECT_EQ(gray[0], gray[2]);
}

}  // namespace
}  // namespace trocar::registration
