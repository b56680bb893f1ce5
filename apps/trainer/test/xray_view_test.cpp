#include "views/xray/xray_view.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QCoreApplication>
#include <QElapsedTimer>
#include <QPushButton>
#include <QSlider>
#include <QThread>
#include <functional>

#include "anatomy/phantom/phantom.h"
#include "test/widget_actions.h"
#include "views/xray/xray_controls.h"

namespace trocar::trainer {
namespace {

/// A view of a coarse abdomen on the screen.
class XrayViewTest : public ::testing::Test {
 protected:
  static std::shared_ptr<const anatomy::VirtualPatient> patient() {
    static const auto kPatient = [] {
      auto made = anatomy::generate_phantom("abdomen", 1, {{96, 76, 60}});
      EXPECT_TRUE(made) << made.error().text();
      return std::make_shared<const anatomy::VirtualPatient>(*std::move(made));
    }();
    return kPatient;
  }
  void SetUp() override {
    view.resize(400, 400);
    view.show();
    tasks::Needle needle;
    needle.name = "test";
    view.show_patient(patient(), needle, [] { return Vec3(-40.0, 0.0, 0.0); });
  }
  /// Frames of the window until the condition holds.
  bool run_until(const std::function<bool()>& holds) {
    QElapsedTimer clock;
    clock.start();
    while (!holds()) {
      if (clock.elapsed() > 60000) return false;
      now_s += 1.0 / 60.0;
      view.advance(now_s);
      QCoreApplication::processEvents();
      QThread::msleep(5);
    }
    return true;
  }
  bool shows_exposure() {
    return run_until([&] { return view.frame() && view.frame()->dose.pulses > 3; });
  }

  XrayView view;
  double now_s = 100.0;
};

TEST_F(XrayViewTest, ShowsAnImageOnlyWhileThePedalIsDownAndHoldsTheLast) {
  ASSERT_FALSE(run_until([&, n = 0]() mutable { return view.frame() != nullptr || ++n > 200; }) && view.frame());
  view.set_pedal(true);
  ASSERT_TRUE(shows_exposure());
  EXPECT_FALSE(view.frame()->is_held);
  EXPECT_GT(view.use().dose_area_gycm2, 0.0);
  EXPECT_TRUE(view.use().is_beam_on);
  view.set_pedal(false);
  ASSERT_TRUE(run_until([&] { return view.frame()->is_held; }));
  const double dose = view.use().dose_area_gycm2;
  const QImage held = view.grab().toImage();
  for (int n = 0; n < 30; ++n) run_until([&, k = 0]() mutable { return ++k > 1; });
  EXPECT_EQ(view.use().dose_area_gycm2, dose);
  EXPECT_EQ(view.grab().toImage(), held);
  EXPECT_FALSE(view.use().is_beam_on);
}

TEST_F(XrayViewTest, TheKeyIsAPedal) {
  QKeyEvent down(QEvent::KeyPress, Qt::Key_Z, Qt::NoModifier), up(QEvent::KeyRelease, Qt::Key_Z, Qt::NoModifier);
  QCoreApplication::sendEvent(&view, &down);
  EXPECT_TRUE(view.is_pedal_down());
  QCoreApplication::sendEvent(&view, &up);
  EXPECT_FALSE(view.is_pedal_down());
  QCoreApplication::sendEvent(&view, &down);
  view.hide();
  EXPECT_FALSE(view.is_pedal_down()) << "no radiation that nobody sees";
}

TEST_F(XrayViewTest, MouseMovesTableArmAndField) {
  ASSERT_TRUE(run_until([&] { return view.settings().arm.isocentre_P.x() < -39.0; }));
  const Vec3 before_P = view.settings().arm.isocentre_P;
  drag(view, {200, 200}, {240, 200}, Qt::LeftButton);
  // The patient follows the pointer to the right of the image, his left: the middle is then further to his right.
  EXPECT_LT(view.settings().arm.isocentre_P.x(), before_P.x() - 10.0);
  drag(view, {200, 200}, {300, 150}, Qt::RightButton);
  EXPECT_NEAR(view.settings().arm.lao_deg, 30.0, 1.0);
  EXPECT_NEAR(view.settings().arm.cranial_deg, 15.0, 1.0);
  const Vec3 low_P = view.settings().arm.isocentre_P;
  view.change_settings([](XraySettings& s) { s.table_mm = 50.0; });
  EXPECT_NEAR(view.settings().arm.isocentre_P.y(), low_P.y() + 50.0, 1e-9) << "supine: the table raises him";
  const double field_mm = view.settings().arm.field_mm;
  wheel(view, {200, 200}, 120);
  EXPECT_LT(view.settings().arm.field_mm, field_mm);
  for (int n = 0; n < 20; ++n) drag(view, {0, 200}, {400, 200}, Qt::RightButton);
  EXPECT_EQ(view.settings().arm.lao_deg, view.unit().largest_lao_deg);
}

TEST_F(XrayViewTest, ContrastAgentLeavesTheNeedleWhileItIsInjected) {
  const Vec3 liver_P(-80.0, 0.0, 20.0);
  view.set_needle(std::vector<Vec3>{liver_P + Vec3(-100.0, 0.0, 0.0), liver_P});
  ASSERT_TRUE(run_until([&] { return view.contrast() != nullptr; }));
  view.set_injecting(true);
  ASSERT_TRUE(run_until([&] { return view.use().contrast_ml > 0.3; }));
  view.set_injecting(false);
  ASSERT_TRUE(run_until([&, n = 0]() mutable { return ++n > 20; }));
  const double ml = view.use().contrast_ml;
  ASSERT_TRUE(run_until([&, n = 0]() mutable { return ++n > 40; }));
  EXPECT_EQ(view.use().contrast_ml, ml);
}

TEST_F(XrayViewTest, ControlsShowTheSettings) {
  XrayControls controls(view);
  view.change_settings([](XraySettings& s) {
    s.arm.lao_deg = -30.0;
    s.pulses_per_s = 7.5;
    s.mode = xray::ImageMode::kRoadMap;
  });
  EXPECT_EQ(controls.findChild<QSlider*>(QStringLiteral("xray-lao"))->value(), -30);
  EXPECT_EQ(controls.findChild<QComboBox*>(QStringLiteral("xray-pulses"))->currentData().toDouble(), 7.5);
  EXPECT_EQ(controls.findChild<QComboBox*>(QStringLiteral("xray-mode"))->currentIndex(), 2);
  controls.findChild<QPushButton*>(QStringLiteral("xray-ap"))->click();
  EXPECT_EQ(view.settings().arm.lao_deg, 0.0);
  controls.findChild<QSlider*>(QStringLiteral("xray-collimate-across"))->setValue(60);
  EXPECT_NEAR(view.settings().arm.collimation[0], 0.6, 1e-9);
}

}  // namespace
}  // namespace trocar::trainer
