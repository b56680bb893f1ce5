// Freehand reconstruction of real sweeps, where the test data lies beside the checkout.

#include "ultrasound/sweep/freehand.h"

#include <gtest/gtest.h>

#include "core/testing/test_data.h"
#include "io/image/image_file.h"
#include "io/sequence/plus_config.h"
#include "io/sequence/sequence_file.h"
#include "lab/volume/correlation.h"

namespace trocar::testing {
namespace {
namespace fs = std::filesystem;

constexpr double kNamesInTheFile_mm = 1e-3;  ///< The reference's origin is written with six digits.

struct SpinePhantom {
  ultrasound::TrackedSequence sequence;
  io::PlusConfig config;
  volume::LabelGrid reference;  ///< What PLUS made of it.
};

Result<SpinePhantom> load_spine_phantom(const fs::path& folder) {
  SpinePhantom phantom;
  TROCAR_TRY(phantom.sequence, io::read_sequence(folder / "SpinePhantomFreehand.igs.mha"));
  TROCAR_TRY(phantom.config,
             io::read_plus_config(folder / "PlusDeviceSet_VolumeReconstructionOnly_SpinePhantom_NN_MEAN.xml"));
  TROCAR_TRY(phantom.reference, io::read_labels(folder / "vtkVolumeReconstructorTestNNMEANvolumeRef.mha"));
  return phantom;
}

TEST(RealFreehand, SpinePhantomMatchesPlus) {
  const fs::path folder = test_data() / "us-spine-phantom";
  if (!fs::exists(folder)) GTEST_SKIP() << "no test data at " << folder;
  const auto phantom = load_spine_phantom(folder);
  ASSERT_TRUE(phantom) << phantom.error().text();
  const auto volume =
      ultrasound::reconstruct_freehand(phantom->sequence, phantom->config.transforms, phantom->config.reconstruction);
  ASSERT_TRUE(volume) << volume.error().text();
  ASSERT_EQ(volume->gray.geometry.size, phantom->reference.geometry.size);
  EXPECT_LT((volume->gray.geometry.origin_P - phantom->reference.geometry.origin_P).norm(), kNamesInTheFile_mm);
  // Measured: 0.9986 over both sets. What is left is mostly PLUS' running mean, which is cut to whole numbers.
  EXPECT_GT(volume::correlation(volume->gray.voxels, phantom->reference.voxels), 0.998);
  EXPECT_GT(volume::correlation(volume->gray.voxels, phantom->reference.voxels, volume::ComparedVoxels::kBothAboveZero),
            0.998);
}

TEST(RealFreehand, SpinePhantomWithoutCalibrationIsRefused) {
  const fs::path folder = test_data() / "us-spine-phantom";
  if (!fs::exists(folder)) GTEST_SKIP() << "no test data at " << folder;
  const auto sequence = io::read_sequence(folder / "SpinePhantomFreehand.igs.mha");
  ASSERT_TRUE(sequence) << sequence.error().text();
  const auto volume = ultrasound::reconstruct_freehand(*sequence, {}, {});
  ASSERT_FALSE(volume);
  EXPECT_NE(volume.error().what.find("no transform from Image to Reference"), std::string::npos);
}

TEST(RealFreehand, LiverSweepUsesItsRecordedPoses) {
  const fs::path path = test_data() / "us-liver-sweep" / "liver_sweep_decoded.igs.mha";
  if (!fs::exists(path)) GTEST_SKIP() << "no test data at " << path;
  const auto sequence = io::read_sequence(path);
  ASSERT_TRUE(sequence) << sequence.error().text();
  ultrasound::FreehandOptions options;
  options.spacing_mm = Vec3::Constant(2.0);
  options.is_black_left_out = true;
  const auto volume = ultrasound::reconstruct_freehand(*sequence, {}, options);
  ASSERT_TRUE(volume) << volume.error().text();
  EXPECT_EQ(volume->frames_used, 140U);
  // The fan is 233 mm wide, 187 mm deep and swept over some tens of degrees: between 1 and 4 litres.
  const double litres = static_cast<double>(volume->voxels_met) * volume->gray.geometry.voxel_volume_mm3() * 1e-6;
  EXPECT_GT(litres, 1.0);
  EXPECT_LT(litres, 4.0);
}

}  // namespace
}  // namespace trocar::testing
