#include "io/sequence/transform_file.h"

#include <fmt/format.h>

#include <cmath>

#include "core/random.h"
#include "io/detail/itk_transform.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::read_bytes;
using testing::write_bytes;

std::string tfm(const std::string& type, const std::string& parameters, const std::string& fixed) {
  return "#Insight Transform File V1.0\n#Transform 0\nTransform: " + type + "\nParameters: " + parameters +
         "\nFixedParameters: " + fixed + "\n";
}

Result<Pose> read_text(const std::string& text) {
  TemporaryFolder folder;
  write_bytes(folder / "x.tfm", text);
  return read_transform(folder / "x.tfm");
}

TEST(TransformFile, RoundTrips) {
  TemporaryFolder folder;
  const Pose X_PT((Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized())).toRotationMatrix(), {12.5, -300.25, 1e-3});
  ASSERT_TRUE(write_transform(X_PT, folder / "probe.tfm"));
  const auto read = read_transform(folder / "probe.tfm");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_LT((read->R() - X_PT.R()).norm(), 1e-12);
  EXPECT_LT((read->p() - X_PT.p()).norm(), 1e-12);
  EXPECT_TRUE(read_bytes(folder / "probe.tfm").starts_with("#Insight Transform File V1.0"));
}

TEST(TransformFile, DeformationMatchesItk) {
  TemporaryFolder folder;
  const Pose X_AB((Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized())).toRotationMatrix(), {40.0, -20.0, 7.0});
  volume::SplineField field;
  field.lattice.size = {7, 6, 8};
  field.lattice.spacing_mm = Vec3(20, 25, 30);
  field.lattice.origin_P = Vec3(-50, 12, 3);
  field.lattice.R_PV = Eigen::AngleAxisd(0.5, Vec3(2, 1, 2) / 3.0).toRotationMatrix();
  Random random(3);
  for (std::size_t n = 0; n < field.lattice.voxel_count(); ++n)
    field.coefficients_mm.emplace_back(random.normal(), random.normal(), random.normal());
  ASSERT_TRUE(write_deformation(X_AB, field, folder / "x.tfm"));
  std::vector<Vec3> points;
  std::vector<std::array<double, 3>> numbers;
  for (int n = 0; n < 30; ++n) {
    points.push_back(
        field.lattice.to_mm(Vec3(random.uniform(1.1, 4.9), random.uniform(1.1, 3.9), random.uniform(1.1, 5.9))));
    numbers.push_back({points.back().x(), points.back().y(), points.back().z()});
  }
  const auto mapped = detail::map_points_with_itk(folder / "x.tfm", numbers);
  ASSERT_TRUE(mapped) << mapped.error().text();
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Vec3 expected = X_AB * (points[n] + volume::displacement_at(field, points[n]));
    EXPECT_LT((expected - Vec3((*mapped)[n].data())).norm(), 1e-6);
  }
  EXPECT_FALSE(read_transform(folder / "x.tfm"));  // not one linear transform
  field.coefficients_mm[0].x() = std::nan("");
  EXPECT_FALSE(write_deformation(X_AB, field, folder / "y.tfm"));
  EXPECT_FALSE(std::filesystem::exists(folder / "y.tfm"));
}

TEST(TransformFile, KeepsNotesAsComments) {
  TemporaryFolder folder;
  const Pose X_PT((Eigen::AngleAxisd(0.3, Vec3::UnitZ())).toRotationMatrix(), {1.0, 2.0, 3.0});
  const TransformNotes notes = {{"depth_mm", "112.5"}, {"transducer", "C5-2"}};
  ASSERT_TRUE(write_transform(X_PT, folder / "probe.tfm", notes));
  const auto read = read_transform(folder / "probe.tfm");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_LT((read->p() - X_PT.p()).norm(), 1e-12);
  EXPECT_EQ(read_transform_notes(folder / "probe.tfm").value(), notes);
  write_bytes(folder / "other.tfm", tfm("AffineTransform_double_3_3", "1 0 0 0 1 0 0 0 1 0 0 0", "0 0 0"));
  EXPECT_TRUE(read_transform_notes(folder / "other.tfm").value().empty());
  EXPECT_FALSE(read_transform_notes(folder / "missing.tfm"));
}

TEST(TransformFile, ReadsAffineRowByRow) {
  // A quarter turn about z: x goes to y.
  const auto pose = read_text(tfm("AffineTransform_double_3_3", "0 -1 0 1 0 0 0 0 1 10 20 30", "0 0 0"));
  ASSERT_TRUE(pose) << pose.error().text();
  EXPECT_LT((*pose * Vec3(1, 0, 0) - Vec3(10, 21, 30)).norm(), 1e-12);
}

TEST(TransformFile, AppliesTheCentreOfRotation) {
  const auto pose = read_text(tfm("AffineTransform_double_3_3", "0 -1 0 1 0 0 0 0 1 10 20 30", "5 6 7"));
  ASSERT_TRUE(pose) << pose.error().text();
  EXPECT_LT((*pose * Vec3(5, 6, 7) - Vec3(15, 26, 37)).norm(), 1e-12);
  EXPECT_LT((*pose * Vec3(6, 6, 7) - Vec3(15, 27, 37)).norm(), 1e-12);
}

TEST(TransformFile, ReadsTheRigidTransformsOfItk) {
  const double half = std::sqrt(0.5);
  for (const std::string& text : {tfm("Euler3DTransform_double_3_3", "0 0 1.5707963267948966 1 2 3", "0 0 0 0"),
                                  tfm("VersorRigid3DTransform_double_3_3", fmt::format("0 0 {} 1 2 3", half), "0 0 0"),
                                  tfm("MatrixOffsetTransformBase_double_3_3", "0 -1 0 1 0 0 0 0 1 1 2 3", "0 0 0"),
                                  tfm("AffineTransform_float_3_3", "0 -1 0 1 0 0 0 0 1 1 2 3", "0 0 0")}) {
    const auto pose = read_text(text);
    ASSERT_TRUE(pose) << pose.error().text() << text;
    EXPECT_LT((*pose * Vec3(1, 0, 0) - Vec3(1, 3, 3)).norm(), 1e-5) << text;
  }
}

TEST(TransformFile, RefusesNonRigidTransforms) {
  for (const char* parameters :
       {"1.001 0 0 0 1 0 0 0 1 0 0 0", "1 0.01 0 0 1 0 0 0 1 0 0 0", "-1 0 0 0 1 0 0 0 1 0 0 0",
        "0 0 0 0 0 0 0 0 0 0 0 0", "nan 0 0 0 1 0 0 0 1 0 0 0", "1 0 0 0 1 0 0 0 1 nan 0 0"})
    EXPECT_FALSE(read_text(tfm("AffineTransform_double_3_3", parameters, "0 0 0"))) << parameters;
  EXPECT_TRUE(read_text(tfm("AffineTransform_double_3_3", "1.00001 0 0 0 1 0 0 0 1 0 0 0", "0 0 0")));
}

TEST(TransformFile, RefusesNonTransformFiles) {
  for (const char* text :
       {"", "hello", "#Insight Transform File V1.0\n", "#Insight Transform File V1.0\nTransform: Nonsense_double_3_3\n",
        "#Insight Transform File V1.0\nTransform: AffineTransform_double_3_3\nParameters: 1 2\nFixedParameters: 0\n",
        "#Insight Transform File V1.0\nTransform: AffineTransform_double_3_3\nParameters: x y z\n"}) {
    ::testing::internal::CaptureStderr();
    EXPECT_FALSE(read_text(text)) << text;
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  }
  EXPECT_FALSE(read_transform("/nowhere/x.tfm"));
}

TEST(TransformFile, RefusesEveryTruncatedFile) {
  const std::string whole = tfm("Euler3DTransform_double_3_3", "0.1 0.2 0.3 10.25 -20.5 30.75", "1.5 2.5 3.5 0");
  ASSERT_TRUE(read_text(whole));
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes)
    EXPECT_FALSE(read_text(whole.substr(0, bytes))) << whole.substr(0, bytes);
}

TEST(TransformFile, RefusesAWrongNumberOfParameters) {
  const char* type = "AffineTransform_double_3_3";
  EXPECT_FALSE(read_text(tfm(type, "1 0 0 0 1 0 0 0 1 5 6", "0 0 0")));
  EXPECT_FALSE(read_text(tfm(type, "1 0 0 0 1 0 0 0 1 5 6 7 8", "0 0 0")));
  EXPECT_FALSE(read_text(tfm(type, "1 0 0 0 1 0 0 0 1 5 6 7", "0 0")));
}

TEST(TransformFile, RefusesToWriteANonFinitePose) {
  TemporaryFolder folder;
  EXPECT_FALSE(write_transform(Pose::translation({std::nan(""), 0, 0}), folder / "x.tfm"));
  EXPECT_TRUE(folder.is_empty());
}

}  // namespace
}  // namespace trocar::io
