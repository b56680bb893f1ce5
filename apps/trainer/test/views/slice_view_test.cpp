#include "views/slices/slice_view.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QHelpEvent>
#include <QToolTip>
#include <cmath>

#include "phantom/phantom.h"
#include "test/widget_actions.h"
#include "ui_kit/theme.h"
#include "views/slices/slice_marks.h"

namespace trocar::trainer {
namespace {

std::shared_ptr<const anatomy::VirtualPatient> coarse_abdomen() {
  static const auto patient = std::make_shared<const anatomy::VirtualPatient>(
      phantom::generate_phantom("abdomen", 1, {{180, 144, 128}}).value());
  return patient;
}

struct ShownSlice {
  explicit ShownSlice(SliceKind kind) : view(kind) {
    view.resize(400, 360);
    view.show_patient(coarse_abdomen());
    view.show();
    QObject::connect(&view, &SliceView::focus_moved, [this](const Vec3& p_P) { moved_P.push_back(p_P); });
    QObject::connect(&view, &SliceView::clicked, [this](const Vec3& p_P) { clicked_P.push_back(p_P); });
    QObject::connect(&view, &SliceView::window_changed, [this](double c, double w) { windows.push_back({c, w}); });
    QCoreApplication::processEvents();
  }
  QColor color_at(const QPointF& at) {
    return view.grab().toImage().pixelColor((at * view.devicePixelRatioF()).toPoint());
  }

  SliceView view;
  std::vector<Vec3> moved_P, clicked_P;
  std::vector<slices::Window> windows;
};

Segment expert_path() {
  return coarse_abdomen()->paths.front().line_P;
}

TEST(SliceView, MapsPixelsToThePatientAndBack) {
  for (const SliceKind kind : {SliceKind::kAxial, SliceKind::kCoronal, SliceKind::kSagittal, SliceKind::kAlongNeedle,
                               SliceKind::kAlongNeedleTurned, SliceKind::kAcrossNeedle}) {
    ShownSlice shown(kind);
    shown.view.set_needle_frame(needle_pose(expert_path().b, expert_path().direction()));
    for (const QPointF at : {QPointF(3, 40), QPointF(200, 200), QPointF(399, 359)}) {
      const QPointF back = shown.view.position_of(shown.view.point_at(at));
      EXPECT_NEAR(back.x(), at.x(), 1e-9);
      EXPECT_NEAR(back.y(), at.y(), 1e-9);
    }
  }
}

TEST(SliceView, ShowsTheLiverInItsColourOnTheLeft) {
  ShownSlice shown(SliceKind::kAxial);
  const Vec3 target_P = expert_path().b;  // in the liver
  shown.view.set_focus(target_P);
  shown.view.set_label_opacity(1.0);
  const QPointF target = shown.view.position_of(target_P);
  EXPECT_LT(target.x(), 0.5 * shown.view.width());
  const Vec3 beside_P = target_P + Vec3(-12.0, 3.0, 0.0);  // clear of the cross-hairs
  const anatomy::Label* label = anatomy::find_label(*coarse_abdomen(), beside_P);
  ASSERT_NE(label, nullptr);
  ASSERT_EQ(label->name, "liver");
  EXPECT_EQ(shown.color_at(shown.view.position_of(beside_P)),
            QColor(label->color[0], label->color[1], label->color[2]));
  press_key(shown.view, Qt::Key_L);
  const QColor plain = shown.color_at(shown.view.position_of(beside_P));
  EXPECT_EQ(plain.red(), plain.green());
  EXPECT_EQ(plain.red(), plain.blue());
}

TEST(SliceView, MovesTheCrossHairsToTheMouse) {
  ShownSlice shown(SliceKind::kCoronal);
  const Vec3 before_P = shown.view.focus();
  drag(shown.view, {150, 200}, {240, 130}, Qt::LeftButton);
  ASSERT_EQ(shown.moved_P.size(), 2U);
  EXPECT_LT((shown.moved_P.back() - shown.view.point_at({240, 130})).norm(), 1e-9);
  EXPECT_EQ(shown.view.focus(), shown.moved_P.back());
  EXPECT_NEAR(shown.view.focus().y(), before_P.y(), 1e-9);  // It stays in its plane.
  EXPECT_TRUE(shown.clicked_P.empty());
  drag(shown.view, {100, 100}, {101, 100}, Qt::LeftButton);
  ASSERT_EQ(shown.clicked_P.size(), 1U);
  // The vertical line is the sagittal plane's trace, the horizontal one the axial plane's.
  const QPointF at = shown.view.position_of(shown.view.focus());
  const QColor vertical = shown.color_at({at.x(), 330});
  EXPECT_GT(vertical.green(), 2 * vertical.blue());  // yellow
  EXPECT_GT(vertical.red(), 2 * vertical.blue());
  bool has_red = false;
  for (const double beside : {-1.0, 0.0, 1.0}) {  // which row of pixels a line between two of them takes is Qt's choice
    const QColor horizontal = shown.color_at({396, at.y() + beside});  // over air
    has_red = has_red || horizontal.red() > std::max(50, 2 * horizontal.green());
  }
  EXPECT_TRUE(has_red);
}

TEST(SliceView, HasNoToolTipOverTheImage) {
  ShownSlice shown(SliceKind::kAxial);
  const auto asked_at = [&](const QPoint& at) {
    QHelpEvent help(QEvent::ToolTip, at, shown.view.mapToGlobal(at));
    QCoreApplication::sendEvent(&shown.view, &help);
    return QToolTip::text();
  };
  EXPECT_EQ(asked_at({200, 200}), "");
  EXPECT_EQ(asked_at({200, 1}), shown.view.toolTip());
  QToolTip::hideText();
}

TEST(SliceView, ScrollsByTheSlicesOfTheVolume) {
  ShownSlice shown(SliceKind::kAxial);
  const Vec3 before_P = shown.view.focus();
  wheel(shown.view, {200, 200}, 240);
  const double step_mm = coarse_abdomen()->ct.geometry.spacing_mm.z();
  EXPECT_NEAR(shown.view.focus().z() - before_P.z(), 2.0 * step_mm, 1e-9);
  EXPECT_NEAR(shown.view.geometry().height_mm(shown.view.focus()), 0.0, 1e-9);
  press_key(shown.view, Qt::Key_PageDown);
  EXPECT_NEAR(shown.view.focus().z() - before_P.z(), step_mm, 1e-9);
  EXPECT_EQ(shown.moved_P.size(), 2U);
}

TEST(SliceView, ZoomsAtThePointerAndPans) {
  ShownSlice shown(SliceKind::kSagittal);
  const QPointF at(120, 250);
  const Vec3 under_P = shown.view.point_at(at);
  const double before = shown.view.geometry().mm_per_px;
  wheel(shown.view, at, 120, Qt::ControlModifier);
  EXPECT_LT(shown.view.geometry().mm_per_px, before);
  EXPECT_LT((shown.view.point_at(at) - under_P).norm(), 1e-9);
  drag(shown.view, at, {160, 230}, Qt::MiddleButton);
  EXPECT_LT((shown.view.point_at({160, 230}) - under_P).norm(), 1e-9);
  drag(shown.view, {160, 230}, {180, 240}, Qt::LeftButton, Qt::ShiftModifier);
  EXPECT_LT((shown.view.point_at({180, 240}) - under_P).norm(), 1e-9);
  EXPECT_TRUE(shown.moved_P.empty());
  mouse(shown.view, QEvent::MouseButtonDblClick, {180, 240}, Qt::LeftButton);
  EXPECT_LT((shown.view.point_at(shown.view.picture_rect().center()) - under_P).norm(), 1e-9);
  press_key(shown.view, Qt::Key_R);
  EXPECT_NEAR(shown.view.geometry().mm_per_px, before, 1e-12);
}

TEST(SliceView, ChangesTheWindowByDraggingAndByKeys) {
  ShownSlice shown(SliceKind::kAxial);
  const QPointF muscle = shown.view.picture_rect().center() + QPointF(30, 25);
  press_key(shown.view, Qt::Key_L);
  const int before = shown.color_at(muscle).red();
  drag(shown.view, {200, 200}, {200, 150}, Qt::RightButton);
  ASSERT_EQ(shown.windows.size(), 1U);
  EXPECT_NEAR(shown.windows[0].center_hu, 40.0 - 100.0, 1e-9);  // 2 HU a point in a window of 400
  EXPECT_NEAR(shown.windows[0].width_hu, 400.0, 1e-9);
  EXPECT_GT(shown.color_at(muscle).red(), before);  // brighter
  press_key(shown.view, Qt::Key_3);
  EXPECT_EQ(slices::window_name(shown.view.window()), "Lung");
  shown.view.set_window(10.0, -5.0);
  EXPECT_EQ(shown.view.window().width_hu, 1.0);
  EXPECT_EQ(shown.windows.size(), 2U);  // A setter does not signal.
}

TEST(SliceView, FollowsTheTipOnlyOutsideTheMiddlePart) {
  ShownSlice shown(SliceKind::kAxial);
  for (int n = 0; n < 8; ++n) press_key(shown.view, Qt::Key_Plus);
  const Vec3 center_P = shown.view.geometry().center_P;
  shown.view.set_focus(center_P + Vec3(10.0, 0.0, 0.0));
  EXPECT_LT((shown.view.geometry().center_P - center_P).norm(), 1e-9);
  QPointF last = shown.view.position_of(shown.view.focus());
  for (double x = 10.0; x < 90.0; x += 0.5) {
    shown.view.set_focus(center_P + Vec3(x, 0.0, 0.0));
    const QPointF now = shown.view.position_of(shown.view.focus());
    EXPECT_LT(std::abs(now.x() - last.x()), 2.0);  // It glides.
    last = now;
  }
  EXPECT_NEAR(last.x(), 0.8 * shown.view.width(), 1.0);
}

TEST(SliceView, DrawsTheNeedleWhereItLies) {
  ShownSlice shown(SliceKind::kAxial);
  const Vec3 tip_P = expert_path().b;
  shown.view.set_focus(tip_P + Vec3(0.0, 40.0, 0.0));
  const std::vector<Vec3> shaft_P{tip_P + Vec3(-90.0, 0.0, 0.0), tip_P};
  const QPointF on_shaft = shown.view.position_of(tip_P + Vec3(-35.0, 0.0, 0.0));
  shown.view.set_needle(shaft_P);
  // The shaft's middle lies between two rows of pixels or on one.
  QColor solid = shown.color_at(on_shaft);
  for (const int row : {-1, 1})
    if (const QColor beside = shown.color_at(on_shaft + QPointF(0, row)); beside.red() > solid.red()) solid = beside;
  EXPECT_GT(solid.red(), 190);
  EXPECT_GT(solid.blue(), solid.red());
  // 20 mm away it is dashed: along the shaft there are pixels that are and some that are not of its colour.
  shown.view.set_focus(shown.view.focus() + Vec3(0.0, 0.0, 20.0));
  const QImage image = shown.view.grab().toImage();
  shown.view.set_needle({});
  const QImage without = shown.view.grab().toImage();
  int changed = 0, kept = 0;
  for (double x = -70.0; x < -8.0; x += 0.5) {
    const QPoint at = shown.view.position_of(tip_P + Vec3(x, 0.0, 0.0)).toPoint();
    ++(image.pixelColor(at) != without.pixelColor(at) ? changed : kept);
  }
  EXPECT_GT(changed, 20);
  EXPECT_GT(kept, 20);
}

TEST(SliceView, NeedlePlanesContainTheShaftWithTheTipDown) {
  const Segment path = expert_path();
  for (const SliceKind kind : {SliceKind::kAlongNeedle, SliceKind::kAlongNeedleTurned}) {
    ShownSlice shown(kind);
    shown.view.set_needle_frame(needle_pose(path.at(0.6), path.direction()));
    EXPECT_NEAR(shown.view.geometry().height_mm(path.a), 0.0, 1e-9);
    EXPECT_NEAR(shown.view.geometry().height_mm(path.b), 0.0, 1e-9);
    EXPECT_GT(shown.view.position_of(path.b).y(), shown.view.position_of(path.a).y());
    EXPECT_NEAR(shown.view.position_of(path.b).x(), shown.view.position_of(path.a).x(), 1e-6);
    wheel(shown.view, {100, 100}, 120);
    EXPECT_GT(std::abs(shown.view.geometry().height_mm(path.b)), 0.5);
    EXPECT_TRUE(shown.moved_P.empty());
  }
}

TEST(SliceView, ShowsThePlanPerGuidanceLevel) {
  ShownSlice shown(SliceKind::kAxial);
  const Segment path = expert_path();
  shown.view.set_focus(0.5 * (path.a + path.b) + Vec3(0.0, 40.0, 0.0));  // the cross-hairs beside all that is looked at
  shown.view.grab();
  shown.view.set_guidance(scene::Guidance::kNone);  // no plan yet; lesions are gone, too
  const QImage none = shown.view.grab().toImage();
  shown.view.set_paths(path, {});
  shown.view.set_entry_zone(tasks::EntryZone{path.a, 15.0});
  EXPECT_EQ(shown.view.grab().toImage(), none);
  const auto drawn_at = [&](const Vec3& p_P, double radius) {
    const QImage image = shown.view.grab().toImage();
    const QPoint at = shown.view.position_of(p_P).toPoint();
    int drawn = 0;
    for (int y = at.y() - static_cast<int>(radius); y <= at.y() + radius; ++y)
      for (int x = at.x() - static_cast<int>(radius); x <= at.x() + radius; ++x)
        drawn += image.pixel(x, y) != none.pixel(x, y) ? 1 : 0;
    return drawn;
  };
  const double zone_px = 15.0 / shown.view.geometry().mm_per_px + 3.0;
  shown.view.set_guidance(scene::Guidance::kTarget);
  EXPECT_GT(drawn_at(path.b, 12.0), 20);
  EXPECT_GT(drawn_at(path.a, zone_px), 20);
  EXPECT_EQ(drawn_at(path.at(0.6), 4.0), 0);
  shown.view.set_guidance(scene::Guidance::kPath);
  EXPECT_GT(drawn_at(path.at(0.6), 4.0), 3);
}

/// All kinds of views about a path, the right ones as small as views may be.
void look_at(std::shared_ptr<const anatomy::VirtualPatient> patient, const Segment& path, const char* name) {
  QWidget window;
  window.resize(1040, 700);
  const std::vector<Vec3> shaft_P{path.a - 60.0 * path.direction(), path.at(0.5), path.at(0.8)};
  std::vector<std::unique_ptr<SliceView>> views;
  for (int n = 0; n < 6; ++n) {
    auto view = std::make_unique<SliceView>(static_cast<SliceKind>(n), &window);
    view->setGeometry(400 * (n % 3), 350 * (n / 3), n % 3 == 2 ? 240 : 396, n % 3 == 2 ? 180 : 346);
    view->show_patient(patient);
    view->set_focus(shaft_P.back());
    view->set_needle_frame(needle_pose(shaft_P.back(), path.direction()));
    view->set_needle(shaft_P);
    view->set_paths(path, {});
    views.push_back(std::move(view));
  }
  window.show();
  QCoreApplication::processEvents();
  save(window, name);
  for (const auto& view : views) {
    const QColor tip = view->grab().toImage().pixelColor(view->position_of(shaft_P.back()).toPoint());
    EXPECT_GT(tip.blue(), 150) << view->objectName().toStdString();  // the tip's dot
  }
}

TEST(SliceView, ShowsTheNeedleInAllPlanes) {
  look_at(coarse_abdomen(), expert_path(), "slices.png");
}

TEST(SliceMarks, NamesOfLandmarksDoNotOverlap) {
  const QRectF wanted(10.0, 20.0, 100.0, 14.0);
  EXPECT_EQ(free_place(wanted, {}), wanted);
  const std::vector<QRectF> beside{{120.0, 20.0, 50.0, 14.0}};
  EXPECT_EQ(free_place(wanted, beside), wanted);
  // The second is where the first one leaves room.
  const std::vector<QRectF> two{{60.0, 40.0, 100.0, 14.0}, {40.0, 26.0, 100.0, 14.0}};
  EXPECT_EQ(free_place(wanted, two), QRectF(10.0, 54.0, 100.0, 14.0));
}

}  // namespace
}  // namespace trocar::trainer
