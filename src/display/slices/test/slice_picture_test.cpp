#include "slices/slice_picture.h"

#include <gtest/gtest.h>

#include <array>

namespace trocar::slices {
namespace {

/// A volume of air with one bright voxel at (left, back, head) of the origin, on a grid whose axes are permuted and
/// mirrored against P.
anatomy::VirtualPatient marked_patient() {
  anatomy::VirtualPatient patient;
  volume::GridGeometry geometry;
  geometry.size = {40, 60, 50};  // i: head, j: right, k: front
  geometry.spacing_mm = {2.0, 1.0, 1.5};
  geometry.R_PV.col(0) = Vec3(0, 0, 1);
  geometry.R_PV.col(1) = Vec3(-1, 0, 0);
  geometry.R_PV.col(2) = Vec3(0, -1, 0);
  geometry.origin_P = {30, 37, -40};
  patient.ct = volume::CtGrid(geometry, -1000);
  patient.labels = volume::LabelGrid(geometry, 0);
  patient.label_table.labels = {{1, "liver", "liver", {10, 200, 30}}, {2, "fat", "adipose", {1, 2, 3}}};
  const Vec3 index = geometry.to_index({20, 16, 10});
  patient.ct[{std::llround(index.x()), std::llround(index.y()), std::llround(index.z())}] = 3000;
  return patient;
}
constexpr std::array kOrientations{SliceOrientation::kAxial, SliceOrientation::kCoronal, SliceOrientation::kSagittal};

/// Column and row of the brightest pixel.
std::array<int, 2> brightest(const image::RgbImage& image) {
  std::array<int, 2> best{0, 0};
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.columns; ++column)
      if (image.at(column, row)[0] > image.at(best[0], best[1])[0]) best = {column, row};
  return best;
}

TEST(SlicePicture, ShowsPatientsLeftOnTheRightFrontAndHeadUp) {
  const anatomy::VirtualPatient patient = marked_patient();
  const SliceOptions options{{0.0, 4000.0}, 0.0, false, 200, 0.0, Vec3::Zero()};
  // The mark is left of, behind and above the volume's middle at (0.5, 0.25, -1).
  constexpr std::array<std::array<bool, 2>, 3> kIsRightAndLower{{{true, true}, {true, false}, {true, false}}};
  for (std::size_t n = 0; n < 3; ++n) {
    const auto picture = make_slice_picture(patient, kOrientations[n], {20, 16, 10}, options);
    const auto [column, row] = brightest(picture.image);
    EXPECT_GT(picture.image.at(column, row)[0], 100);
    EXPECT_EQ(column > picture.image.columns / 2, kIsRightAndLower[n][0]) << n;
    EXPECT_EQ(row > picture.image.rows / 2, kIsRightAndLower[n][1]) << n;
  }
}

TEST(SlicePicture, MapsPixelsToPointsAndBack) {
  const anatomy::VirtualPatient patient = marked_patient();
  for (const auto orientation : kOrientations) {
    SliceOptions options;
    options.size_px = 200;
    options.window = {0.0, 4000.0};
    const auto picture = make_slice_picture(patient, orientation, {20, 16, 10}, options);
    const auto [column, row] = brightest(picture.image);
    const Eigen::Vector2d pixel = picture.to_pixel({20, 16, 10});
    const double voxel_px = 2.0 / picture.plane.step_u_P.norm();
    EXPECT_NEAR(pixel.x(), column, voxel_px);
    EXPECT_NEAR(pixel.y(), row, voxel_px);
    const Vec3 back_P =
        picture.plane.origin_P + pixel.x() * picture.plane.step_u_P + pixel.y() * picture.plane.step_v_P;
    EXPECT_NEAR((back_P - Vec3(20, 16, 10)).norm(), 0.0, 1e-9);
  }
}

TEST(SlicePicture, HasSquarePixelsOverTheWholeVolume) {
  const anatomy::VirtualPatient patient = marked_patient();
  SliceOptions options;
  options.size_px = 240;
  const auto coronal = make_slice_picture(patient, SliceOrientation::kCoronal, Vec3::Zero(), options);
  EXPECT_EQ(coronal.image.columns, 180);  // 60 mm wide, 80 mm high
  EXPECT_EQ(coronal.image.rows, 240);
  EXPECT_NEAR(coronal.plane.step_u_P.norm(), coronal.plane.step_v_P.norm(), 1e-12);
}

TEST(SlicePicture, CropsToAFieldInsideTheVolume) {
  const anatomy::VirtualPatient patient = marked_patient();
  SliceOptions options;
  options.size_px = 100;
  options.field_mm = 50.0;
  options.center_P = {100.0, 0.0, 0.0};  // Beyond the left side: the field moves inside.
  const auto axial = make_slice_picture(patient, SliceOrientation::kAxial, Vec3::Zero(), options);
  EXPECT_EQ(axial.image.columns, 100);
  EXPECT_EQ(axial.image.rows, 100);
  const Vec3 right_border_P = axial.plane.origin_P + 99.5 * axial.plane.step_u_P;
  EXPECT_NEAR(right_border_P.x(), 30.5, 1e-9);
}

TEST(SlicePicture, AppliesTheGreyWindow) {
  anatomy::VirtualPatient patient = marked_patient();
  SliceOptions options;
  options.window = {40.0, 400.0};
  for (const auto& [hu, grey] : {std::pair{-200, 0}, {-160, 0}, {40, 128}, {240, 255}, {1000, 255}}) {
    std::fill(patient.ct.voxels.begin(), patient.ct.voxels.end(), static_cast<std::int16_t>(hu));
    const auto picture = make_slice_picture(patient, SliceOrientation::kAxial, {0, 0, 0}, options);
    EXPECT_EQ(picture.image.at(picture.image.columns / 2, picture.image.rows / 2)[0], grey) << hu;
  }
}

TEST(SlicePicture, FillsAndOutlinesOnlyStructures) {
  anatomy::VirtualPatient patient = marked_patient();
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n)
    patient.labels.voxels[n] = patient.labels.geometry.index_of(n)[1] < 30 ? 1 : 2;  // left half liver, right half fat
  SliceOptions options;
  options.label_opacity = 0.5;
  options.size_px = 120;
  const auto picture = make_slice_picture(patient, SliceOrientation::kAxial, Vec3::Zero(), options);
  EXPECT_EQ(picture.image.at(20, 50), (image::Rgb{0, 0, 0}));      // Fat on air.
  EXPECT_EQ(picture.image.at(80, 50), (image::Rgb{5, 100, 15}));   // Half of the liver's colour on air.
  EXPECT_EQ(picture.image.at(48, 50), (image::Rgb{10, 200, 30}));  // Its border.
}

}  // namespace
}  // namespace trocar::slices
