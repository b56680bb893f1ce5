#include "scene/render_patient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace trocar {
namespace {

constexpr Rgb kRed = {220, 30, 30};
constexpr Rgb kGreen = {30, 200, 60};

/// A closed ball of latitude and longitude triangles, facing outward.
TriangleMesh ball(const Vec3& center_P, double radius_mm) {
  constexpr int kRings = 24;
  constexpr int kSectors = 48;
  TriangleMesh mesh;
  for (int ring = 0; ring <= kRings; ++ring) {
    const double theta = std::numbers::pi * ring / kRings;
    for (int sector = 0; sector < kSectors; ++sector) {
      const double phi = 2.0 * std::numbers::pi * sector / kSectors;
      const Vec3 n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      mesh.vertices.push_back((center_P + radius_mm * n).cast<float>());
    }
  }
  const auto id = [](int ring, int sector) { return static_cast<std::uint32_t>(ring * kSectors + sector % kSectors); };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      mesh.triangles.push_back({id(ring, sector), id(ring + 1, sector), id(ring + 1, sector + 1)});
      mesh.triangles.push_back({id(ring, sector), id(ring + 1, sector + 1), id(ring, sector + 1)});
    }
  }
  return mesh;
}

/// A red organ on the patient's right and a green one towards the head, in a skin.
struct Scene {
  VirtualPatient patient;
  std::vector<NamedMesh> meshes;
};

Scene two_organs() {
  Scene scene;
  scene.patient.label_table.labels = {{1, "right", "kidney", kRed}, {2, "upper", "spleen", kGreen}};
  scene.meshes = {
      {"skin", ball({0, 0, 0}, 100.0)}, {"right", ball({-50, 0, 0}, 20.0)}, {"upper", ball({0, 0, 50}, 20.0)}};
  return scene;
}

SceneOptions small(CameraPreset camera) {
  SceneOptions options;
  options.columns = 160;
  options.rows = 160;
  options.camera = camera;
  return options;
}

bool is_reddish(const Rgb& c) {
  return c[0] > 70 && c[0] > 2 * c[1] && c[0] > 2 * c[2];
}
bool is_greenish(const Rgb& c) {
  return c[1] > 60 && 2 * c[1] > 3 * c[0] && 2 * c[1] > 3 * c[2];
}

bool is_bluish(const Rgb& c) {
  return c[2] > 90 && c[2] > c[1] && 2 * c[2] > 5 * c[0];
}

/// Mean position of the pixels that pass, in pixels; NaN when none does.
Eigen::Vector2d middle_of(const RgbImage& image, bool (*passes)(const Rgb&)) {
  Eigen::Vector2d sum(0, 0);
  int count = 0;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      if (!passes(image.at(column, row))) continue;
      sum += Eigen::Vector2d(column, row);
      ++count;
    }
  }
  return sum / count;
}

class RenderPatient : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_render()) GTEST_SKIP() << "no X server: run under scripts/with_display";
  }
};

TEST_F(RenderPatient, AnteriorViewHasPatientsRightOnTheLeftAndHeadUp) {
  const Scene scene = two_organs();
  const auto image = render_patient(scene.patient, scene.meshes, small(CameraPreset::kAnterior));
  ASSERT_TRUE(image) << image.error().text();
  ASSERT_EQ(image->columns, 160);
  ASSERT_EQ(image->rows, 160);
  const auto red = middle_of(*image, is_reddish);
  const auto green = middle_of(*image, is_greenish);
  EXPECT_LT(red.x(), 60.0);
  EXPECT_NEAR(red.y(), 80.0, 4.0);
  EXPECT_NEAR(green.x(), 80.0, 4.0);
  EXPECT_LT(green.y(), 60.0);
}

TEST_F(RenderPatient, PosteriorViewMirrorsTheAnteriorOne) {
  const Scene scene = two_organs();
  const auto image = render_patient(scene.patient, scene.meshes, small(CameraPreset::kPosterior));
  ASSERT_TRUE(image) << image.error().text();
  EXPECT_GT(middle_of(*image, is_reddish).x(), 100.0);
  EXPECT_LT(middle_of(*image, is_greenish).y(), 60.0);
}

TEST_F(RenderPatient, RightViewLooksAlongTheLateralAxis) {
  const Scene scene = two_organs();
  const auto image = render_patient(scene.patient, scene.meshes, small(CameraPreset::kRight));
  ASSERT_TRUE(image) << image.error().text();
  EXPECT_NEAR(middle_of(*image, is_reddish).x(), 80.0, 4.0);
}

TEST_F(RenderPatient, OpaqueSkinHidesTheOrgans) {
  const Scene scene = two_organs();
  SceneOptions options = small(CameraPreset::kAnterior);
  options.skin_opacity = 1.0;
  const auto image = render_patient(scene.patient, scene.meshes, options);
  ASSERT_TRUE(image) << image.error().text();
  EXPECT_TRUE(std::isnan(middle_of(*image, is_reddish).x()));
}

TEST_F(RenderPatient, NeedleReachesFromItsHubOutsideToTheTarget) {
  const Scene scene = two_organs();
  SceneOptions options = small(CameraPreset::kAnterior);
  options.paths = {{"path", {{-100, 0, 0}, {-70, 0, 0}}}};
  const auto image = render_patient(scene.patient, scene.meshes, options);
  ASSERT_TRUE(image) << image.error().text();
  const auto hub = middle_of(*image, is_bluish);
  const auto red = middle_of(*image, is_reddish);
  EXPECT_LT(hub.x(), 40.0);  // outside of the skin, and in the picture
  EXPECT_NEAR(hub.y(), red.y(), 4.0);
}

TEST_F(RenderPatient, NothingToDrawIsAnError) {
  EXPECT_FALSE(render_patient({}, {}));
}

TEST(RenderPatientArguments, ImpossibleSizeIsAUsageError) {
  SceneOptions options;
  options.columns = 0;
  const auto image = render_patient({}, {}, options);
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().exit_status, 2);
}

TEST(RenderPatientArguments, WithoutXServerTheErrorSaysWhatToDo) {
  const char* before = std::getenv("DISPLAY");
  const std::string saved = before == nullptr ? "" : before;
  unsetenv("DISPLAY");
  const auto image = render_patient({}, {});
  if (!saved.empty()) setenv("DISPLAY", saved.c_str(), 1);
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().exit_status, 1);
  EXPECT_NE(image.error().text().find("xvfb-run"), std::string::npos);
}

}  // namespace
}  // namespace trocar
