#include "scene/render_patient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "two_organs.h"

namespace trocar::scene {
namespace {

SceneOptions small(CameraPreset camera) {
  SceneOptions options;
  options.columns = 160;
  options.rows = 160;
  options.camera = camera;
  return options;
}

class RenderPatient : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!can_render()) GTEST_SKIP() << "no X server: run under scripts/with_display";
  }
};

TEST_F(RenderPatient, AnteriorViewShowsPatientsRightOnTheLeft) {
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

TEST_F(RenderPatient, DrawsTheNeedleFromHubToTarget) {
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

TEST(RenderPatientArguments, ErrorWithoutXServerGivesAdvice) {
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
}  // namespace trocar::scene
