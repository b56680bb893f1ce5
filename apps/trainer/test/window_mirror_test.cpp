#include "ui_kit/window_mirror.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QHBoxLayout>
#include <QMainWindow>
#include <QMouseEvent>
#include <QPushButton>
#include <QWindow>
#include <memory>

#include "panels/mirror_settings.h"

namespace trocar::trainer {
namespace {

const QColor kGreen(0, 200, 0);

/// A window with a green button in its upper left corner that counts its clicks.
struct WindowMirrorTest : ::testing::Test {
  WindowMirrorTest() {
    auto* central = new QWidget;
    central->setStyleSheet(QStringLiteral("background: black;"));
    button = new QPushButton(central);
    button->setStyleSheet(QStringLiteral("background: rgb(0,200,0); border: none;"));
    button->setGeometry(0, 40, 100, 60);
    window.setCentralWidget(central);
    window.resize(400, 300);
    QObject::connect(button, &QPushButton::clicked, button, [this] { ++clicks; });
    mirror = std::make_unique<WindowMirror>(window, QStringLiteral("back"));
    window.show();
    settle();
  }
  static void settle() {
    QElapsedTimer timer;
    for (timer.start(); timer.elapsed() < 300;) QCoreApplication::processEvents(QEventLoop::AllEvents, 20);
  }
  QColor seen_at(int x, int y) {
    settle();
    return window.grab().toImage().pixelColor(x, y);
  }
  /// As the window system tells it, where something is drawn.
  void click_at(int x, int y) {
    QWindow& handle = *window.windowHandle();
    const QPointF at(x, y);
    const QPointF global = QPointF(handle.mapToGlobal(QPoint(0, 0))) + at;
    QMouseEvent down(QEvent::MouseButtonPress, at, at, global, Qt::LeftButton, Qt::LeftButton, {});
    QMouseEvent up(QEvent::MouseButtonRelease, at, at, global, Qt::LeftButton, Qt::NoButton, {});
    QCoreApplication::sendEvent(&handle, &down);
    QCoreApplication::sendEvent(&handle, &up);
  }

  QMainWindow window;
  QPushButton* button = nullptr;
  std::unique_ptr<WindowMirror> mirror;
  int clicks = 0;
};

TEST_F(WindowMirrorTest, SwapsLeftAndRightIncludingClicks) {
  EXPECT_EQ(seen_at(50, 70), kGreen);
  mirror->set_axis(MirrorAxis::kLeftRight);
  EXPECT_EQ(seen_at(350, 70), kGreen);
  EXPECT_NE(seen_at(50, 70), kGreen);
  click_at(350, 70);
  EXPECT_EQ(clicks, 1);
  click_at(50, 70);
  EXPECT_EQ(clicks, 1) << "nothing is drawn there";
}

TEST_F(WindowMirrorTest, SwapsUpAndDown) {
  mirror->set_axis(MirrorAxis::kUpDown);
  EXPECT_EQ(seen_at(50, 230), kGreen);
  click_at(50, 230);
  EXPECT_EQ(clicks, 1);
  const int top = window.geometry().top();
  EXPECT_EQ(mirror->row_on_screen(top), top + 299);
}

TEST_F(WindowMirrorTest, RestoresTheUnmirroredWindow) {
  mirror->set_axis(MirrorAxis::kLeftRight);
  mirror->set_axis(MirrorAxis::kNone);
  EXPECT_EQ(seen_at(50, 70), kGreen);
  click_at(50, 70);
  EXPECT_EQ(clicks, 1);
}

TEST_F(WindowMirrorTest, MirrorsPopupsAboutTheMiddleOfTheWindow) {
  mirror->set_axis(MirrorAxis::kLeftRight);
  QWidget popup(&window, Qt::ToolTip);
  const QRect frame = window.geometry();
  popup.setGeometry(frame.left() + 10, frame.top() + 20, 100, 50);
  popup.show();
  settle();
  EXPECT_EQ(popup.geometry().left(), frame.left() + 290);
  EXPECT_EQ(popup.geometry().top(), frame.top() + 20);
  EXPECT_NE(popup.graphicsEffect(), nullptr);
  mirror->set_axis(MirrorAxis::kNone);
  EXPECT_EQ(popup.graphicsEffect(), nullptr);
}

/// Pixel, right and down from the view's middle, at which a camera shows a point.
QPointF pixel_of(const scene::CameraView& view, const ViewPlace& place, const Vec3& p) {
  const Vec3 from_eye = p - view.eye_P;
  const double ahead = from_eye.dot(view.forward_P());
  const double px = 0.5 * place.rows / std::tan(0.5 * view.view_angle_rad) / ahead;
  return {px * from_eye.dot(view.right_P()), -px * from_eye.dot(view.up_P)};
}

TEST(MirrorCamera, ProjectsPointsAsSeenFromTheEye) {
  constexpr double kTiny_px = 1e-6;
  for (const double tilt_deg : {0.0, 30.0, 90.0}) {
    MirrorSettings settings;
    settings.tilt_deg = tilt_deg;
    settings.picture_W = {10.0, 40.0, -20.0};
    settings.eye_distance_mm = 550.0;
    const ViewPlace place{120.0, -60.0, 700, 0.3};
    const scene::CameraView view = mirror_camera_W(settings, place);
    EXPECT_NEAR(view.mm_per_pixel(view.focus_P, place.rows), place.mm_per_pixel, 1e-9);
    // The picture's plane is seen at its own pixels, from the window's middle on.
    const double tilt_rad = tilt_deg * std::acos(-1.0) / 180.0;
    const Vec3 up(0.0, std::sin(tilt_rad), std::cos(tilt_rad));
    const Vec3 on_picture = settings.picture_W + 30.0 * Vec3::UnitX() + 12.0 * up;
    const QPointF at = pixel_of(view, place, on_picture);
    EXPECT_NEAR(at.x() + place.right_px, 30.0 / 0.3, kTiny_px);
    EXPECT_NEAR(at.y() + place.down_px, -12.0 / 0.3, kTiny_px);
    // A point behind it is seen on the line from the eye.
    const Vec3 behind = view.eye_P + 1.4 * (on_picture - view.eye_P);
    const QPointF same = pixel_of(view, place, behind);
    EXPECT_NEAR(same.x(), at.x(), kTiny_px);
    EXPECT_NEAR(same.y(), at.y(), kTiny_px);
  }
}

TEST(MirrorCamera, LooksDownAtAFlatScreenAndAcrossAtAnUprightOne) {
  MirrorSettings settings;
  settings.tilt_deg = 90.0;
  EXPECT_LT((mirror_camera_W(settings, {}).forward_P() + Vec3::UnitZ()).norm(), 1e-12);
  settings.tilt_deg = 0.0;
  EXPECT_LT((mirror_camera_W(settings, {}).forward_P() - Vec3::UnitY()).norm(), 1e-12);
}

TEST(MirrorSettingsFile, RoundTripsSettings) {
  MirrorSettings settings;
  settings.axis = MirrorAxis::kUpDown;
  settings.is_camera_fixed = true;
  settings.picture_W = {12.0, -30.0, 44.0};
  settings.tilt_deg = 61.0;
  settings.screen_width_mm = 477.0;
  settings.eye_distance_mm = 510.0;
  save_mirror_settings(settings);
  const MirrorSettings again = load_mirror_settings();
  save_mirror_settings({});
  EXPECT_EQ(again.axis, settings.axis);
  EXPECT_TRUE(again.is_camera_fixed);
  EXPECT_EQ(again.picture_W, settings.picture_W);
  EXPECT_EQ(again.tilt_deg, settings.tilt_deg);
  EXPECT_EQ(again.screen_width_mm, settings.screen_width_mm);
  EXPECT_EQ(again.eye_distance_mm, settings.eye_distance_mm);
}

}  // namespace
}  // namespace trocar::trainer
