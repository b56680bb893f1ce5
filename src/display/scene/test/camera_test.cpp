#include "scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace trocar::scene {
namespace {

const std::vector<Vec3> kCorners_P = {{-150, -100, 0}, {150, 100, 300}, {-150, 100, 0}, {150, -100, 300}};

void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-9) {
  EXPECT_NEAR((a - b).norm(), 0.0, tolerance) << a.transpose() << " and " << b.transpose();
}

TEST(Camera, PresetsLookFromTheirSideWithTheHeadUp) {
  const auto view = [](CameraPreset preset) { return fit_camera(kCorners_P, preset, 1.3); };
  expect_near(view(CameraPreset::kAnterior).forward_P(), {0, 1, 0});
  expect_near(view(CameraPreset::kAnterior).right_P(), {1, 0, 0});  // the patient's left is on the right
  expect_near(view(CameraPreset::kPosterior).right_P(), {-1, 0, 0});
  expect_near(view(CameraPreset::kRight).forward_P(), {1, 0, 0});
  expect_near(view(CameraPreset::kLeft).forward_P(), {-1, 0, 0});
  expect_near(view(CameraPreset::kCranial).forward_P(), {0, 0, -1});
  expect_near(view(CameraPreset::kCranial).up_P, {0, -1, 0});
  for (const CameraPreset preset :
       {CameraPreset::kAnterior, CameraPreset::kRight, CameraPreset::kLeft, CameraPreset::kPosterior}) {
    expect_near(view(preset).up_P, {0, 0, 1});
  }
}

TEST(Camera, PunctureSideFacesTheViewer) {
  EXPECT_EQ(preset_facing({-1, 0, 0}), CameraPreset::kRightAnteriorOblique);
  EXPECT_EQ(preset_facing({-0.3, -0.95, 0}), CameraPreset::kRightAnteriorOblique);
  EXPECT_EQ(preset_facing({0.6, -0.8, 0}), CameraPreset::kLeftAnteriorOblique);
  EXPECT_EQ(preset_facing({0.1, 0.9, -0.4}), CameraPreset::kPosterior);
}

TEST(Camera, FitHoldsAllPoints) {
  for (const double aspect : {0.5, 1.0, 2.0}) {
    const CameraView view = fit_camera(kCorners_P, CameraPreset::kRightAnteriorOblique, aspect);
    for (const Vec3& p_P : kCorners_P) {
      const Vec3 from_eye = p_P - view.eye_P;
      const double depth = from_eye.dot(view.forward_P());
      EXPECT_LE(std::abs(from_eye.dot(view.up_P)) / depth, std::tan(0.5 * view.view_angle_rad));
      EXPECT_LE(std::abs(from_eye.dot(view.right_P())) / depth, aspect * std::tan(0.5 * view.view_angle_rad));
    }
  }
}

TEST(Camera, OrbitKeepsFocusDistanceAndHeadUp) {
  CameraView view = fit_camera(kCorners_P, CameraPreset::kAnterior, 1.0);
  const CameraView start = view;
  for (int i = 0; i < 200; ++i) {
    view = orbited(view, 0.11, 0.07 * std::sin(i * 0.3));
    EXPECT_NEAR(view.distance_mm(), start.distance_mm(), 1e-6);
    expect_near(view.focus_P, start.focus_P);
    EXPECT_GE(view.up_P.z(), 0.0);
    EXPECT_NEAR(view.up_P.dot(view.forward_P()), 0.0, 1e-9);
    EXPECT_NEAR(view.right_P().z(), 0.0, 1e-9);
  }
}

TEST(Camera, DraggingRightShowsThePatientsRightSide) {
  // As if one took the body by its front and pulled it to the right: what comes into sight is what was on the left of
  // the picture, the patient's right.
  const CameraView view = orbited(fit_camera(kCorners_P, CameraPreset::kAnterior, 1.0), 0.5, 0.0);
  EXPECT_LT((view.eye_P - view.focus_P).x(), 0.0);
}

TEST(Camera, OrbitStopsShortOfThePoles) {
  CameraView view = fit_camera(kCorners_P, CameraPreset::kAnterior, 1.0);
  for (int i = 0; i < 100; ++i) view = orbited(view, 0.0, 0.3);
  EXPECT_LT((view.eye_P - view.focus_P).normalized().z(), -0.99);
  EXPECT_GT((view.eye_P - view.focus_P).normalized().z(), -1.0);
}

TEST(Camera, PanMovesTheFocusByAFractionOfTheHeight) {
  const CameraView view = fit_camera(kCorners_P, CameraPreset::kAnterior, 1.0);
  const CameraView moved = panned(view, 0.25, 0.0);
  const double height_mm = view.mm_per_pixel(view.focus_P, 1);
  expect_near(moved.focus_P, view.focus_P - 0.25 * height_mm * view.right_P(), 1e-6);
}

TEST(Camera, ZoomStaysWithinItsLimits) {
  CameraView view = fit_camera(kCorners_P, CameraPreset::kAnterior, 1.0);
  EXPECT_NEAR(zoomed(view, 2.0).distance_mm(), 0.5 * view.distance_mm(), 1e-9);
  for (int i = 0; i < 50; ++i) view = zoomed(view, 3.0);
  EXPECT_NEAR(view.distance_mm(), 20.0, 1e-9);
}

TEST(Camera, FollowingTheTipKeepsTheDirection) {
  const CameraView view = fit_camera(kCorners_P, CameraPreset::kAnterior, 1.0);
  const CameraView next = following(view, FollowMode::kTip, {{0, -200, 100}, {10, -50, 120}}, true);
  expect_near(next.focus_P, {10, -50, 120});
  expect_near(next.forward_P(), view.forward_P());
  EXPECT_NEAR(next.distance_mm(), view.distance_mm(), 1e-9);
}

TEST(Camera, SideViewIsPerpendicularToAnyNeedle) {
  for (const Vec3& axis_P : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1), Vec3(0.5, 0.6, -0.3)}) {
    const Segment needle_P{-150.0 * axis_P.normalized(), {0, 0, 0}};
    const CameraView view = following({}, FollowMode::kSide, needle_P, true);
    EXPECT_NEAR(view.forward_P().dot(needle_P.direction()), 0.0, 1e-9);
    EXPECT_NEAR(view.up_P.dot(view.forward_P()), 0.0, 1e-9);
    expect_near(view.focus_P, needle_P.b);
    const CameraView along = following({}, FollowMode::kAlongNeedle, needle_P, true);
    EXPECT_GT(along.forward_P().dot(needle_P.direction()), 0.99);
    EXPECT_NEAR(along.up_P.dot(along.forward_P()), 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace trocar::scene
