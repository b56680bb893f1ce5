#include "views/patient/patient_view.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QCursor>
#include <QElapsedTimer>
#include <QKeyEvent>
#include <QKeySequence>
#include <QMouseEvent>
#include <QScreen>
#include <QWheelEvent>

#include "test/open_abdomen.h"
#include "views/patient/stereo_output.h"
#include "volume/sampling.h"

namespace trocar::trainer {
namespace {

class PatientViewTest : public ::testing::Test {
 protected:
  void SetUp() override {
    view.resize(480, 360);
    view.show();
    QApplication::processEvents();
    open_abdomen()->later->wait();
    view.show_patient(open_abdomen()->the_case.patient, std::make_shared<const std::vector<anatomy::NamedMesh>>());
    for (const auto& meshes : open_abdomen()->later->surfaces_after(0)) view.add_surfaces(meshes);
    view.scene().finish_loading();
  }
  /// What a user sees once the picture is whole.
  QImage whole_picture() {
    view.draw_whole();
    QApplication::processEvents();
    return view.grab().toImage().convertToFormat(QImage::Format_RGB32);
  }
  void send_mouse(QEvent::Type type, const QPoint& place, Qt::MouseButton button, Qt::MouseButtons buttons) {
    QMouseEvent event(type, place, view.mapToGlobal(place), button, buttons, Qt::NoModifier);
    QApplication::sendEvent(&view, &event);
  }
  void press(int key) {
    QKeyEvent event(QEvent::KeyPress, key, Qt::NoModifier);
    QApplication::sendEvent(&view, &event);
  }
  PatientView view;
};

int count_of(const QImage& image, bool (*passes)(const QColor&)) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) count += passes(image.pixelColor(x, y)) ? 1 : 0;
  }
  return count;
}

bool is_ivory(const QColor& c) {
  return c.red() > 140 && c.green() > 125 && c.blue() > 100 && c.red() - c.blue() > 15 && c.red() - c.blue() < 70;
}
bool is_liver(const QColor& c) {
  return c.red() > 70 && c.red() > c.green() + 30 && c.green() < 90 && c.blue() < 80;
}
bool is_teal(const QColor& c) {
  return c.green() > 150 && c.blue() > 140 && c.red() < 130;
}

TEST_F(PatientViewTest, PresetsHideBonesAndLiver) {
  const QImage all = whole_picture();
  EXPECT_GT(count_of(all, is_ivory), 2000);
  EXPECT_GT(count_of(all, is_liver), 1000);
  view.apply_preset(scene::StructurePreset::kBones);
  const QImage bones = whole_picture();
  EXPECT_GT(count_of(bones, is_ivory), 2000);
  EXPECT_EQ(count_of(bones, is_liver), 0);
  view.apply_preset(scene::StructurePreset::kTarget);
  const QImage target = whole_picture();
  EXPECT_LT(count_of(target, is_ivory), 50);
  EXPECT_GT(count_of(target, is_liver), 300);
}

TEST_F(PatientViewTest, DragTurnsWheelZoomsAndKeysChooseViews) {
  whole_picture();
  const scene::CameraView before = view.view();
  send_mouse(QEvent::MouseButtonPress, {200, 200}, Qt::LeftButton, Qt::LeftButton);
  send_mouse(QEvent::MouseMove, {260, 200}, Qt::NoButton, Qt::LeftButton);
  send_mouse(QEvent::MouseButtonRelease, {260, 200}, Qt::LeftButton, Qt::NoButton);
  EXPECT_NEAR((view.view().focus_P - before.focus_P).norm(), 0.0, 1e-9);
  EXPECT_GT((view.view().eye_P - before.eye_P).norm(), 100.0);
  press(Qt::Key_Plus);
  EXPECT_LT(view.view().distance_mm(), before.distance_mm());
  press(Qt::Key_1);
  whole_picture();
  EXPECT_NEAR(view.view().forward_P().y(), 1.0, 1e-6);
  press(Qt::Key_5);
  whole_picture();
  EXPECT_NEAR(view.view().forward_P().y(), -1.0, 1e-6);
}

TEST_F(PatientViewTest, GuidanceFollowsItsKey) {
  view.set_path(open_abdomen()->the_case.patient->paths.front().line_P, 10.0);
  EXPECT_GT(count_of(whole_picture(), is_teal), 100);
  press(Qt::Key_O);
  EXPECT_LT(count_of(whole_picture(), is_teal), 10);  // a few pixels of organs have the colour
}

TEST_F(PatientViewTest, ViewKeysOverrideWindowShortcuts) {
  const auto is_taken = [&](int key, Qt::KeyboardModifiers modifiers) {
    QKeyEvent event(QEvent::ShortcutOverride, key, modifiers);
    event.ignore();
    QApplication::sendEvent(&view, &event);
    return event.isAccepted();
  };
  EXPECT_TRUE(is_taken(Qt::Key_O, Qt::NoModifier));
  EXPECT_TRUE(is_taken(Qt::Key_Plus, Qt::ShiftModifier));
  // Keys of the ultrasound view, the tools and the replay mean the same with the focus here.
  for (const int key : {Qt::Key_F, Qt::Key_G, Qt::Key_D, Qt::Key_C, Qt::Key_M, Qt::Key_A, Qt::Key_S, Qt::Key_V,
                        Qt::Key_H, Qt::Key_X, Qt::Key_E, Qt::Key_K, Qt::Key_N, Qt::Key_P, Qt::Key_W})
    EXPECT_FALSE(is_taken(key, Qt::NoModifier)) << QKeySequence(key).toString().toStdString();
  EXPECT_FALSE(is_taken(Qt::Key_1, Qt::ControlModifier));
  EXPECT_FALSE(is_taken(Qt::Key_Space, Qt::NoModifier));  // stops the forces
}

TEST_F(PatientViewTest, DoubleClickPicksThePointOnTheSkin) {
  whole_picture();
  std::optional<Vec3> picked_P;
  QObject::connect(&view, &PatientView::picked, [&](const Vec3& p_P) { picked_P = p_P; });
  send_mouse(QEvent::MouseButtonDblClick, {240, 180}, Qt::LeftButton, Qt::LeftButton);
  ASSERT_TRUE(picked_P);
  // The skin's surface is smoothed by less than two voxels.
  EXPECT_NEAR(volume::sample_linear(open_abdomen()->the_case.patient->skin_distance_mm, *picked_P), 0.0, 3.0);
  picked_P.reset();
  send_mouse(QEvent::MouseButtonDblClick, {2, 2}, Qt::LeftButton, Qt::LeftButton);
  EXPECT_FALSE(picked_P);
}

TEST_F(PatientViewTest, DoesNotRedrawAnUnchangedScene) {
  whole_picture();
  const std::size_t frames = view.still_frame_times().count() + view.moving_frame_times().count();
  for (int i = 0; i < 5; ++i) view.draw();
  EXPECT_EQ(view.still_frame_times().count() + view.moving_frame_times().count(), frames);
}

TEST_F(PatientViewTest, InterruptedFullFrameFallsBackToACheapOne) {
  whole_picture();
  if (view.scene().has_gpu()) GTEST_SKIP() << "a graphics card draws every frame in full";
  bool wants_break = true;
  view.set_interrupt([&] { return wants_break; });
  view.set_opacity("liver", 0.8);
  view.draw();  // cheap, because something has changed
  EXPECT_FALSE(view.is_still());
  EXPECT_EQ(view.broken_frames(), 0);
  // Once nothing has moved for a while the whole picture is tried, and given up.
  while (view.broken_frames() == 0) view.draw();
  EXPECT_FALSE(view.is_still());
  wants_break = false;
  while (!view.is_still()) view.draw();
  EXPECT_EQ(view.still_frame_times().count(), 2u);
}

TEST_F(PatientViewTest, PointerMotionInterruptsAFullFrame) {
  whole_picture();
  if (view.scene().has_gpu()) GTEST_SKIP() << "a graphics card draws every frame in full";
  QCursor::setPos(20, 20);
  int asked = 0;
  view.set_interrupt([&] {
    if (++asked == 3) QCursor::setPos(40, 30);
    return false;
  });
  view.set_opacity("liver", 0.8);
  view.draw();
  while (view.broken_frames() == 0 && !view.is_still()) view.draw();
  EXPECT_EQ(view.broken_frames(), 1);
  EXPECT_FALSE(view.is_still());
  EXPECT_EQ(asked, 3);  // seen the next time that it looked
  EXPECT_GE(view.unwatched_times().count(), 4U);
}

TEST_F(PatientViewTest, MirroredOutputIsFlippedOnTheScreen) {
  const QImage image = whole_picture();
  scene::StereoOptions options;
  options.is_mirrored_left_right = true;
  options.is_mirrored_up_down = true;
  view.set_stereo(options);
  const QImage flipped = whole_picture().mirrored(true, true);
  EXPECT_EQ(image, flipped);
}

TEST_F(PatientViewTest, QuadBufferSurfaceForwardsItsEvents) {
  whole_picture();
  const QImage mono = view.grab().toImage();
  scene::StereoOptions options;
  options.mode = scene::StereoMode::kQuadBuffer;
  options.eye_angle_deg = 0.0;  // the screen of this test may show the left eye only
  view.set_stereo(options);
  view.draw_whole();
  auto* output = view.findChild<StereoOutput*>();
  if (output == nullptr) {  // a window is no child of the widget that contains it
    for (QWindow* window : QGuiApplication::allWindows()) {
      if (auto* found = qobject_cast<StereoOutput*>(window)) output = found;
    }
  }
  ASSERT_NE(output, nullptr);
  QElapsedTimer clock;
  for (clock.start(); !output->isExposed() && clock.elapsed() < 5'000;) QApplication::processEvents();
  view.draw_whole();
  QApplication::processEvents();
  const QImage shown = output->screen()->grabWindow(output->winId()).toImage().convertToFormat(QImage::Format_RGB32);
  ASSERT_EQ(shown.size(), mono.size());
  EXPECT_NEAR(count_of(shown, is_ivory), count_of(mono, is_ivory), 0.02 * count_of(mono, is_ivory));
  EXPECT_GT(count_of(shown, is_ivory), 2000);
  const double before_mm = view.view().distance_mm();
  QWheelEvent wheel(QPointF(100, 100), QPointF(100, 100), QPoint(), QPoint(0, 120), Qt::NoButton, Qt::NoModifier,
                    Qt::NoScrollPhase, false);
  QApplication::sendEvent(output, &wheel);
  EXPECT_LT(view.view().distance_mm(), before_mm);
  view.set_stereo({});
  EXPECT_FALSE(output->isVisible());
}

}  // namespace
}  // namespace trocar::trainer
