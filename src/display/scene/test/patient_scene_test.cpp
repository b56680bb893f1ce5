#include "scene/patient_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "motion/testing/sliding_motion.h"
#include "scene/render_patient.h"
#include "two_organs.h"

namespace trocar::scene {
namespace {

constexpr int kSize = 160;

/// A red organ on the patient's right and a green one towards the head, in a skin.
class PatientSceneTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!can_render()) GTEST_SKIP() << "no X server: run under scripts/with_display";
    auto made = PatientScene::make(kSize, kSize);
    ASSERT_TRUE(made) << made.error().text();
    scene = std::move(*made);
    Scene organs = two_organs();
    organs.patient.landmarks = {{"umbilicus", {0, -100, 0}}};
    patient = std::make_shared<const anatomy::VirtualPatient>(std::move(organs.patient));
    scene->show_patient(patient, std::make_shared<const std::vector<anatomy::NamedMesh>>(std::move(organs.meshes)));
    scene->set_camera(CameraPreset::kAnterior);
    scene->finish_loading();
  }
  image::RgbImage draw(const Detail& detail = DetailPolicy::full()) {
    EXPECT_TRUE(scene->render(detail));
    return picture();
  }
  image::RgbImage picture() const {
    std::vector<std::uint32_t> pixels(static_cast<std::size_t>(kSize) * kSize);
    scene->copy_picture(pixels);
    image::RgbImage image(kSize, kSize);
    std::transform(pixels.begin(), pixels.end(), image.pixels.begin(), [](std::uint32_t p) {
      return image::Rgb{static_cast<std::uint8_t>(p >> 16), static_cast<std::uint8_t>(p >> 8),
                        static_cast<std::uint8_t>(p)};
    });
    return image;
  }
  void move(const motion::PatientMotion& motion) {
    frame.motion = motion;
    scene->show(frame);
  }
  void show_needle(std::span<const Vec3> shaft_P, double diameter_mm, NeedleModel model = NeedleModel::kChiba) {
    frame.shaft_P = shaft_P;
    frame.diameter_mm = diameter_mm;
    frame.model = model;
    scene->show(frame);
  }

  std::unique_ptr<PatientScene> scene;
  std::shared_ptr<const anatomy::VirtualPatient> patient;
  SceneView frame;
};

bool is_bright(const image::Rgb& c) {
  return c[0] > 120 && c[1] > 120 && c[2] > 120;
}
bool is_teal(const image::Rgb& c) {
  return c[1] > 150 && c[2] > 140 && c[0] < 130;
}
bool is_orange(const image::Rgb& c) {
  return c[0] > 130 && c[0] > c[1] + 50 && c[1] > c[2] + 10 && c[1] > 60;
}
bool is_magenta(const image::Rgb& c) {
  return c[0] > 200 && c[2] > 200 && c[1] < 60;
}

TEST_F(PatientSceneTest, AnteriorViewIsOrientedRightAtEveryDetail) {
  for (const Detail& detail : {DetailPolicy::full(), DetailPolicy::moving(0), DetailPolicy::moving(2)}) {
    const image::RgbImage image = draw(detail);
    EXPECT_LT(middle_of(image, is_reddish).x(), 60.0);
    EXPECT_NEAR(middle_of(image, is_reddish).y(), 80.0, 4.0);
    EXPECT_LT(middle_of(image, is_greenish).y(), 60.0);
  }
}

TEST_F(PatientSceneTest, ShowsTheBodyBeforeItsSurfacesExist) {
  anatomy::VirtualPatient ball;
  ball.skin_distance_mm.geometry.size = {40, 40, 40};
  ball.skin_distance_mm.geometry.spacing_mm = {5.0, 5.0, 5.0};
  ball.skin_distance_mm.geometry.origin_P = {-47.5, -97.5, -197.5};  // about (50, 0, -100)
  ball.skin_distance_mm = volume::FloatGrid(ball.skin_distance_mm.geometry);
  const Vec3 middle_P(50.0, 0.0, -100.0);
  for (std::size_t n = 0; n < ball.skin_distance_mm.voxels.size(); ++n) {
    const volume::GridGeometry& geometry = ball.skin_distance_mm.geometry;
    ball.skin_distance_mm.voxels[n] =
        static_cast<float>((geometry.centre_mm(geometry.index_of(n)) - middle_P).norm() - 80.0);
  }
  scene->show_patient(std::make_shared<const anatomy::VirtualPatient>(std::move(ball)),
                      std::make_shared<const std::vector<anatomy::NamedMesh>>());
  EXPECT_TRUE(scene->render(DetailPolicy::full()));
  const CameraView view = scene->view();
  EXPECT_LT((view.focus_P - middle_P).norm(), 5.0) << view.focus_P.transpose();
  EXPECT_GT(view.forward_P().x(), 0.5) << "from the right";
  EXPECT_GT(view.forward_P().y(), 0.5) << "from the front";
  const double half_height_mm = view.distance_mm() * std::tan(0.5 * view.view_angle_rad);
  EXPECT_GT(half_height_mm, 80.0);
  EXPECT_LT(half_height_mm, 150.0);
}

TEST_F(PatientSceneTest, SurfacesMoveWithThePatientAtEveryDetail) {
  const auto model = motion::testing::uniform_model({0.0, 0.0, -30.0});
  for (const Detail& detail : {DetailPolicy::full(), DetailPolicy::moving(0), DetailPolicy::moving(2)}) {
    move({});
    const auto rest = middle_of(draw(detail), is_reddish);
    move({model.get(), {.drivers = {1.0}}});
    const auto moved = middle_of(draw(detail), is_reddish);
    EXPECT_NEAR(moved.x(), rest.x(), 1.0);
    EXPECT_NEAR(moved.y() - rest.y(), 30.0 * 80.0 / 105.0, 2.5);
    move({});
    EXPECT_NEAR(middle_of(draw(detail), is_reddish).y(), rest.y(), 0.01);
  }
}

TEST_F(PatientSceneTest, PicksAMovedSurfaceAtItsNewPosition) {
  scene->set_opacity("skin", 0.0);
  const auto before = middle_of(draw(), is_reddish);
  const auto at = [&](double row) { return scene->pick(before.x() / kSize, row / kSize); };
  ASSERT_TRUE(at(before.y()));
  const Vec3 rest_P = *at(before.y());
  const auto model = motion::testing::uniform_model({0.0, 0.0, -50.0});
  move({model.get(), {.drivers = {1.0}}});
  EXPECT_FALSE(at(before.y()));
  const auto now = middle_of(draw(), is_reddish);
  ASSERT_TRUE(at(now.y()));
  EXPECT_NEAR((*at(now.y()) - rest_P).z(), -50.0, 3.0);
}

TEST_F(PatientSceneTest, OpacityHidesAndShowsOneStructure) {
  scene->set_opacity("right", 0.0);
  EXPECT_EQ(count_of(draw(), is_reddish), 0);
  EXPECT_GT(count_of(draw(), is_greenish), 50);
  scene->set_opacity("right", 1.0);
  EXPECT_GT(count_of(draw(), is_reddish), 50);
}

TEST_F(PatientSceneTest, SkinOnlyPresetHidesTheOrgans) {
  scene->apply_preset(StructurePreset::kSkinOnly);
  EXPECT_EQ(count_of(draw(), is_reddish), 0);
  EXPECT_GT(count_of(draw(), is_bright), 2000);
  scene->apply_preset(StructurePreset::kAll);
  EXPECT_GT(count_of(draw(), is_reddish), 50);
}

TEST_F(PatientSceneTest, DrawsTheNeedleAtItsPose) {
  scene->apply_preset(StructurePreset::kBones);  // there are none
  const Vec3 shaft_P[3] = {{-60, 0, -50}, {0, 0, -48}, {60, 0, -40}};
  for (const NeedleModel model : {NeedleModel::kChiba, NeedleModel::kTuohy, NeedleModel::kQuincke,
                                  NeedleModel::kBiopsyGun, NeedleModel::kTrocar}) {
    show_needle(shaft_P, 2.0, model);
    const auto middle = middle_of(draw(), is_bright);
    EXPECT_NEAR(middle.y(), 80.0 + 48.0 * 80.0 / 105.0, 12.0) << static_cast<int>(model);
  }
  show_needle({}, 2.0, NeedleModel::kChiba);
  EXPECT_EQ(count_of(draw(), is_bright), 0);
}

TEST_F(PatientSceneTest, DrawsAShotUntilItIsCleared) {
  scene->apply_preset(StructurePreset::kBones);
  const int before = count_of(draw(), is_orange);
  frame.stylet_P = Segment{{-60, 0, -50}, {0, 0, -50}};
  frame.core_P = Segment{{10, 0, -50}, {60, 0, -50}};
  scene->show(frame);
  const image::RgbImage image = draw();
  EXPECT_GT(count_of(image, is_orange), before + 20);
  EXPECT_GT(count_of(image, is_bright), 20);
  scene->show({});
  EXPECT_EQ(count_of(draw(), is_orange), before);
}

TEST_F(PatientSceneTest, DrawsTheThrowDashedAndThickerAtTheNotch) {
  scene->apply_preset(StructurePreset::kBones);
  const image::RgbImage before = draw();
  const auto changed = [&](const image::RgbImage& image) {
    int count = 0;
    for (std::size_t n = 0; n < image.pixels.size(); ++n) count += image.pixels[n] == before.pixels[n] ? 0 : 1;
    return count;
  };
  const Segment throw_P{{-60, 0, -50}, {60, 0, -20}};  // oblique: not between two rows of pixels
  frame.throw_P = throw_P;
  scene->show(frame);
  const int thin = changed(draw());
  EXPECT_GT(thin, 20);
  frame.notch_P = Segment{{-60, 0, -50}, {40, 0, -25}};
  scene->show(frame);
  EXPECT_GT(changed(draw()), thin);
  scene->show({});
  EXPECT_EQ(changed(draw()), 0);
}

TEST_F(PatientSceneTest, ThinNeedleStaysVisibleFromAfar) {
  scene->apply_preset(StructurePreset::kBones);
  const Vec3 shaft_P[2] = {{-60, 0, -50}, {60, 0, -50}};
  show_needle(shaft_P, 0.05, NeedleModel::kQuincke);
  EXPECT_GT(count_of(draw(), is_bright), 60);
}

TEST_F(PatientSceneTest, DrawsTheUltrasoundImageInItsPlaneWithinTheFan) {
  scene->apply_preset(StructurePreset::kBones);
  const image::RgbImage picture(10, 10, {255, 0, 255});
  std::vector<std::uint8_t> alpha(100, 255);
  const std::array<Vec3, 3> corners_P = {Vec3(-50, -110, 50), Vec3(50, -110, 50), Vec3(-50, -110, -50)};
  frame.scan.emplace();
  frame.scan->X_PT = Pose(Mat3::Identity(), {0.0, 0.0, 1000.0});  // out of sight
  frame.scan->picture = picture;
  frame.scan->alpha = alpha;
  frame.scan->corners_P = corners_P;
  scene->show(frame);
  const int whole = count_of(draw(), is_magenta);
  EXPECT_GT(whole, 3000);
  std::fill(alpha.begin(), alpha.begin() + 50, std::uint8_t{0});  // the upper half
  scene->show(frame);
  const image::RgbImage half = draw();
  EXPECT_NEAR(count_of(half, is_magenta), 0.5 * whole, 0.08 * whole);
  EXPECT_GT(middle_of(half, is_magenta).y(), 90.0);
  scene->show({});
  EXPECT_EQ(count_of(draw(), is_magenta), 0);
}

TEST_F(PatientSceneTest, GuidanceIsShownAndHidden) {
  scene->set_path(Segment{{60, -95, -50}, {20, 0, -50}}, 15.0);
  EXPECT_GT(count_of(draw(), is_teal), 30);
  scene->set_guidance_visible(false);
  EXPECT_EQ(count_of(draw(), is_teal), 0);
}

TEST_F(PatientSceneTest, TargetGuidanceShowsOnlyTargetAndEntryZone) {
  scene->apply_preset(StructurePreset::kBones);  // there are none: nothing hides the marks
  scene->set_path(Segment{{60, -95, -50}, {20, 0, -50}}, 15.0);
  const image::RgbImage guided = draw();
  scene->set_guidance(Guidance::kTarget);
  const image::RgbImage assisted = draw();
  EXPECT_GT(count_of(guided, is_orange), 5);
  EXPECT_NEAR(count_of(assisted, is_orange), count_of(guided, is_orange), 3);
  EXPECT_GT(count_of(assisted, is_teal), 20);
  EXPECT_LT(count_of(assisted, is_teal), count_of(guided, is_teal) - 20);
  scene->set_guidance(Guidance::kNone);
  const image::RgbImage exam = draw();
  EXPECT_EQ(count_of(exam, is_orange) + count_of(exam, is_teal), 0);
}

TEST_F(PatientSceneTest, HidesLesionsWithoutGuidance) {
  anatomy::VirtualPatient sick = *patient;
  sick.label_table.labels = {{1, "right", "kidney", kRed}, {2, "upper", "liver_lesion", kGreen}};
  scene->set_guidance(Guidance::kNone);
  scene->show_patient(std::make_shared<const anatomy::VirtualPatient>(std::move(sick)),
                      std::make_shared<const std::vector<anatomy::NamedMesh>>(two_organs().meshes));
  scene->set_camera(CameraPreset::kAnterior);
  scene->finish_loading();
  const auto withheld = [&] {
    return std::count_if(scene->structures().begin(), scene->structures().end(),
                         [](const StructureInfo& s) { return s.is_withheld; });
  };
  const Detail moving{.mesh_level = 1};
  for (const StructurePreset preset : {StructurePreset::kAll, StructurePreset::kTarget, StructurePreset::kVessels}) {
    scene->apply_preset(preset);
    EXPECT_EQ(count_of(draw(), is_greenish), 0);
    EXPECT_EQ(count_of(draw(moving), is_greenish), 0);
  }
  scene->set_opacity("skin", 0.0);
  EXPECT_EQ(withheld(), 1);
  EXPECT_FALSE(scene->pick(0.5, 0.33).has_value());
  scene->set_guidance(Guidance::kTarget);
  EXPECT_EQ(withheld(), 0);
  EXPECT_GT(count_of(draw(), is_greenish), 100);
  EXPECT_GT(count_of(draw(moving), is_greenish), 100);
  EXPECT_TRUE(scene->pick(0.5, 0.33).has_value());
}

TEST_F(PatientSceneTest, CentresTheEntryZone) {
  scene->apply_preset(StructurePreset::kBones);
  scene->set_path(Segment{{60, -95, -50}, {20, 0, -50}}, 15.0);
  scene->set_guidance(Guidance::kTarget);
  const auto about_path = middle_of(draw(), is_teal);
  scene->set_entry_centre(Vec3(60, -95, 20));
  const auto about_centre = middle_of(draw(), is_teal);
  EXPECT_NEAR(about_centre.x(), about_path.x(), 4.0);
  EXPECT_LT(about_centre.y(), about_path.y() - 40.0);  // 70 mm towards the head
}

TEST_F(PatientSceneTest, ShowsLandmarksOnRequest) {
  scene->apply_preset(StructurePreset::kBones);
  const image::RgbImage without = draw();
  scene->set_landmarks_visible(true);
  const image::RgbImage with = draw();
  EXPECT_NE(with.pixels, without.pixels);
}

TEST_F(PatientSceneTest, ShowsTheLandmarksSetLast) {
  scene->apply_preset(StructurePreset::kBones);
  scene->set_landmarks_visible(true);
  const image::RgbImage own = draw();
  scene->set_landmarks({{"xiphoid process", {0, -100, 60}}, {"umbilicus", {0, -100, 0}}});
  EXPECT_TRUE(scene->has_changed());
  const image::RgbImage others = draw();
  EXPECT_NE(others.pixels, own.pixels);
  scene->set_landmarks(patient->landmarks);
  EXPECT_EQ(draw().pixels, own.pixels);
}

TEST_F(PatientSceneTest, PickFindsTheFrontmostSurface) {
  draw();
  const auto skin_P = scene->pick(0.5, 0.5);
  ASSERT_TRUE(skin_P);
  EXPECT_NEAR((*skin_P - Vec3(0, -100, 0)).norm(), 0.0, 2.0);
  EXPECT_FALSE(scene->pick(0.01, 0.01));
}

TEST_F(PatientSceneTest, BreakAbortsTheFrame) {
  draw();
  scene->set_opacity("right", 0.5);
  EXPECT_FALSE(scene->render(DetailPolicy::full(), [] { return true; }));
  EXPECT_TRUE(scene->has_changed());
  EXPECT_TRUE(scene->render(DetailPolicy::full(), [] { return false; }));
  EXPECT_FALSE(scene->has_changed());
}

TEST_F(PatientSceneTest, MirroredImageIsTheFlippedImage) {
  const image::RgbImage image = draw();
  StereoOptions options;
  options.is_mirrored_left_right = true;
  scene->set_stereo(options);
  const image::RgbImage flipped = draw();
  for (int column = 0; column < kSize; ++column) EXPECT_EQ(image.at(column, 80), flipped.at(kSize - 1 - column, 80));
  options.is_mirrored_up_down = true;
  scene->set_stereo(options);
  const image::RgbImage turned = draw();
  for (int row = 0; row < kSize; ++row) EXPECT_EQ(image.at(100, row), turned.at(kSize - 1 - 100, kSize - 1 - row));
}

TEST_F(PatientSceneTest, RendersOneImagePerEyeWithParallax) {
  scene->apply_preset(StructurePreset::kBones);
  // Before the plane without parallax: what is near stands farther right for the left eye.
  const Vec3 shaft_P[2] = {{-30, -90, 0}, {30, -90, 0}};
  show_needle(shaft_P, 4.0, NeedleModel::kChiba);
  draw();
  CameraView view = scene->view();
  view.focus_P = {0, 0, 0};
  scene->set_view(view);
  StereoOptions options;
  options.mode = StereoMode::kQuadBuffer;
  options.eye_angle_deg = 6.0;
  scene->set_stereo(options);
  ASSERT_TRUE(scene->render(DetailPolicy::full(), {}, Eye::kLeft));
  const double left = middle_of(picture(), is_bright).x();
  ASSERT_TRUE(scene->render(DetailPolicy::full(), {}, Eye::kRight));
  const double right = middle_of(picture(), is_bright).x();
  EXPECT_GT(left, right + 2.0);
}

TEST_F(PatientSceneTest, ImageFollowsTheSetSize) {
  draw();
  scene->set_size(kSize / 2, kSize / 4);
  ASSERT_TRUE(scene->render(DetailPolicy::full()));
  std::vector<std::uint32_t> pixels(static_cast<std::size_t>(kSize) / 2 * kSize / 4);
  scene->copy_picture(pixels);
  const auto is_red = [](std::uint32_t p) { return (p >> 16 & 255U) > (p >> 8 & 255U) + 40; };
  EXPECT_GT(std::count_if(pixels.begin(), pixels.end(), is_red), 20);
}

TEST_F(PatientSceneTest, AnaglyphSplitsTheEyesIntoRedAndCyan) {
  scene->apply_preset(StructurePreset::kSkinOnly);
  StereoOptions options;
  options.mode = StereoMode::kAnaglyph;
  options.eye_angle_deg = 6.0;
  scene->set_stereo(options);
  // A tinted pixel is one that only one eye's picture lights: along the outline of the skin.
  const auto is_tinted = [](const image::Rgb& c) { return std::abs(c[0] - c[1]) > 60; };
  const image::RgbImage anaglyph = draw();
  EXPECT_GT(count_of(anaglyph, is_tinted), 20);
  scene->set_stereo({});
  const image::RgbImage mono = draw();
  EXPECT_EQ(count_of(mono, is_tinted), 0);
}

TEST_F(PatientSceneTest, SideBySideShowsTheOrganTwice) {
  StereoOptions options;
  options.mode = StereoMode::kSideBySide;
  scene->set_stereo(options);
  const image::RgbImage image = draw();
  int left = 0, right = 0;
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      if (is_reddish(image.at(column, row))) ++(column < kSize / 2 ? left : right);
    }
  }
  EXPECT_GT(left, 20);
  EXPECT_NEAR(left, right, 0.3 * left);
}

TEST_F(PatientSceneTest, EvenScreenRowsShowTheLeftEyeAtAnyOffset) {
  scene->apply_preset(StructurePreset::kBones);
  // Before the plane without parallax: what is near stands farther right for the left eye.
  const Vec3 shaft_P[2] = {{0, -90, -60}, {0, -90, 60}};
  show_needle(shaft_P, 4.0, NeedleModel::kChiba);
  draw();
  CameraView view = scene->view();
  view.focus_P = {0, 0, 0};
  scene->set_view(view);
  StereoOptions options;
  options.mode = StereoMode::kInterlaced;
  options.eye_angle_deg = 6.0;
  const auto left_lead_px = [&](int first_row) {
    scene->set_stereo(options);
    scene->set_first_row(first_row);
    image::RgbImage of_eye[2] = {draw(), {}};
    of_eye[1] = of_eye[0];
    for (int row = 0; row < kSize; ++row) {
      image::RgbImage& other = of_eye[(first_row + row + 1) % 2];
      for (int column = 0; column < kSize; ++column) other.at(column, row) = {0, 0, 0};
    }
    return middle_of(of_eye[0], is_bright).x() - middle_of(of_eye[1], is_bright).x();
  };
  EXPECT_GT(left_lead_px(0), 2.0);
  EXPECT_GT(left_lead_px(1), 2.0);
  options.is_mirrored_up_down = true;
  EXPECT_GT(left_lead_px(0), 2.0);
  EXPECT_GT(left_lead_px(1), 2.0);
  options.swaps_eyes = true;
  EXPECT_LT(left_lead_px(0), -2.0);
}

TEST_F(PatientSceneTest, DetectsASoftwareRenderer) {
  draw();
  ASSERT_FALSE(scene->renderer_name().empty());
  EXPECT_EQ(scene->has_gpu(), scene->renderer_name().find("llvmpipe") == std::string::npos);
}

}  // namespace
}  // namespace trocar::scene
