#include <gtest/gtest.h>

#include "motion/rest_plane.h"
#include "motion/testing/sliding_motion.h"
#include "slices/paint_slice.h"

namespace trocar::slices {
namespace {

/// A body of 0 HU with a ball of 3000 HU and label 1.
anatomy::VirtualPatient tagged_body(const Vec3& tag_A) {
  anatomy::VirtualPatient patient;
  volume::GridGeometry geometry;
  geometry.size = {100, 100, 100};
  geometry.origin_P = Vec3::Constant(-49.5);
  patient.ct = volume::CtGrid(geometry, 0);
  patient.labels = volume::LabelGrid(geometry, 0);
  patient.label_table.labels = {{1, "tag", "liver", {0, 200, 0}}};
  for (std::size_t n = 0; n < patient.ct.voxels.size(); ++n) {
    if ((geometry.centre_mm(geometry.index_of(n)) - tag_A).norm() > 2.5) continue;
    patient.ct.voxels[n] = 3000;
    patient.labels.voxels[n] = 1;
  }
  return patient;
}

TEST(MovingSlice, ShowsATaggedVoxelAtItsMovedPosition) {
  const Vec3 tag_A(8.0, 3.0, -5.0);
  const anatomy::VirtualPatient patient = tagged_body(tag_A);
  const auto model = motion::testing::sliding_model(-30.0, Vec3::Zero());
  const motion::MotionClock clock{model.get(), motion::testing::sliding_drive()};
  SliceBuffers buffers;
  SliceStyle style;
  style.label_opacity = 0.0;
  for (int n = 0; n < 10; ++n) {
    const motion::PatientMotion motion = clock.at(0.4 * n);
    const Vec3 now_P = motion.to_now(tag_A);
    volume::SlicePlane plane;
    plane.columns = plane.rows = 160;
    plane.step_u_P = 0.5 * Vec3::UnitX();
    plane.step_v_P = 0.5 * Vec3::UnitZ();
    plane.origin_P = {-40.0, now_P.y(), -40.0};
    for (const bool has_outlines : {false, true}) {
      style.has_outlines = has_outlines;
      image::RgbImage image;
      paint_slice(patient, plane, style, buffers, image, motion);
      Vec3 sum = Vec3::Zero();
      double count = 0.0;
      for (int row = 0; row < image.rows; ++row)
        for (int column = 0; column < image.columns; ++column) {
          const image::Rgb& pixel =
              image.pixels[static_cast<std::size_t>(row) * 160 + static_cast<std::size_t>(column)];
          if (has_outlines ? pixel[1] < pixel[0] + 60 : pixel[0] < 230) continue;
          sum += plane.origin_P + column * plane.step_u_P + row * plane.step_v_P;
          count += 1.0;
        }
      ASSERT_GT(count, 10.0);
      // Outlines are drawn inside the label, on whole pixels of half a millimetre.
      EXPECT_LT((sum / count - now_P).norm(), has_outlines ? 0.5 : 0.3) << n << (has_outlines ? ", label" : ", CT");
    }
  }
}

TEST(RestOfPlane, StaysWithinFiftyMicrometresOfTheExactMap) {
  const auto model = motion::testing::sliding_model(-12.27, {5.0, 0.0, 0.0});
  const motion::PatientMotion motion(model.get(), {.drivers = {1.0, 1.0}});
  volume::SlicePlane plane;
  plane.columns = 130;
  plane.rows = 97;
  plane.step_u_P = Vec3(0.8, 0.1, -0.2);
  plane.step_v_P = Vec3(0.1, 0.3, 0.75);
  plane.origin_P = {-50.0, -20.0, -40.0};
  std::vector<Vec3f> rest_A;
  motion::rest_of_plane(motion, plane, rest_A);
  ASSERT_EQ(rest_A.size(), 130U * 97U);
  for (int row = 0; row < plane.rows; ++row)
    for (int column = 0; column < plane.columns; ++column) {
      const Vec3 exact_A = motion.to_rest(plane.origin_P + column * plane.step_u_P + row * plane.step_v_P);
      const Vec3f& found_A = rest_A[static_cast<std::size_t>(row) * 130 + static_cast<std::size_t>(column)];
      ASSERT_LT((found_A.cast<double>() - exact_A).norm(), 0.05) << column << " " << row;
    }
}

}  // namespace
}  // namespace trocar::slices
