#include "panels/mirror_settings.h"

#include <QGuiApplication>
#include <QScreen>
#include <QSettings>
#include <algorithm>
#include <cmath>

namespace trocar::trainer {
namespace {

constexpr double kFarthestPicture_mm = 500.0;
constexpr double kLeastAngle_rad = 0.05, kMostAngle_rad = 1.5;  // of CameraView

double screen_width_mm() {
  constexpr double kLeast_mm = 100.0;  // a screen with unknown size reports 0
  const QScreen* screen = QGuiApplication::primaryScreen();
  const double told_mm = screen == nullptr ? 0.0 : screen->physicalSize().width();
  return told_mm >= kLeast_mm ? told_mm : MirrorSettings().screen_width_mm;
}

double stored_number(const QSettings& settings, const char* key, double otherwise, double least, double most) {
  const double value = settings.value(QStringLiteral("mirror/") + QString::fromLatin1(key), otherwise).toDouble();
  return std::isfinite(value) ? std::clamp(value, least, most) : otherwise;
}

}  // namespace

MirrorSettings load_mirror_settings() {
  const QSettings settings;
  MirrorSettings mirror;
  mirror.axis = static_cast<MirrorAxis>(static_cast<int>(stored_number(settings, "axis", 0, 0, 2)));
  mirror.is_camera_fixed = settings.value(QStringLiteral("mirror/fixed-camera")).toBool();
  const char* const keys[] = {"right-mm", "away-mm", "up-mm"};
  for (int i = 0; i < 3; ++i)
    mirror.picture_W[i] = stored_number(settings, keys[i], 0.0, -kFarthestPicture_mm, kFarthestPicture_mm);
  mirror.tilt_deg = stored_number(settings, "tilt-deg", mirror.tilt_deg, 0.0, 90.0);
  mirror.screen_width_mm = stored_number(settings, "width-mm", screen_width_mm(), 100.0, 2000.0);
  mirror.eye_distance_mm = stored_number(settings, "eye-mm", mirror.eye_distance_mm, 200.0, 2000.0);
  return mirror;
}

void save_mirror_settings(const MirrorSettings& mirror) {
  QSettings settings;
  const auto save = [&](const char* key, const QVariant& value) {
    settings.setValue(QStringLiteral("mirror/") + QString::fromLatin1(key), value);
  };
  save("axis", static_cast<int>(mirror.axis));
  save("fixed-camera", mirror.is_camera_fixed);
  save("right-mm", mirror.picture_W.x());
  save("away-mm", mirror.picture_W.y());
  save("up-mm", mirror.picture_W.z());
  save("tilt-deg", mirror.tilt_deg);
  save("width-mm", mirror.screen_width_mm);
  save("eye-mm", mirror.eye_distance_mm);
}

scene::CameraView mirror_camera_W(const MirrorSettings& settings, const ViewPlace& place) noexcept {
  const double tilt_rad = radians(settings.tilt_deg);
  const Vec3 right_W = Vec3::UnitX();
  const Vec3 up_W(0.0, std::sin(tilt_rad), std::cos(tilt_rad));
  const Vec3 towards_eye_W = right_W.cross(up_W);
  scene::CameraView view;
  view.focus_P = settings.picture_W + place.mm_per_pixel * (place.right_px * right_W - place.down_px * up_W);
  view.eye_P = view.focus_P + settings.eye_distance_mm * towards_eye_W;
  view.up_P = up_W;
  const double half_mm = 0.5 * place.mm_per_pixel * place.rows;
  view.view_angle_rad =
      std::clamp(2.0 * std::atan(half_mm / settings.eye_distance_mm), kLeastAngle_rad, kMostAngle_rad);
  return view;
}

scene::CameraView moved(const Pose& X_PW, const scene::CameraView& view_W) noexcept {
  scene::CameraView view = view_W;
  view.eye_P = X_PW * view_W.eye_P;
  view.focus_P = X_PW * view_W.focus_P;
  view.up_P = X_PW.R() * view_W.up_P;
  return view;
}

}  // namespace trocar::trainer
