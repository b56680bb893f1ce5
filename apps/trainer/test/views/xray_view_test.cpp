#include "views/xray/xray_view.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QCoreApplication>
#include <QElapsedTimer>
#include <QPushButton>
#include <QSlider>
#include <QThread>
#include <functional>

#include "phantom/phantom.h"
#include "test/widget_actions.h"
#include "views/xray/xray_controls.h"

namespace trocar::trainer {
namespace {

/// A view of a coarse abdomen on the screen.
class XrayViewTest : public ::testing::Test {
 protected:
  static std::shared_ptr<const anatomy::VirtualPatient> patient() {
    static const auto kPatient = [] {
      auto made = phantom::generate_phantom("abdomen", 1, {{96, 76, 60}});
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

TEST_F(XrayViewTest, RefusesAnInjectionWithAReason) {
  QStringList refused;
  QObject::connect(&view, &XrayView::injection_refused, [&](const QString& reason) { refused << reason; });
  view.set_injecting(true);
  EXPECT_TRUE(view.is_injecting());
  const QString reason = QStringLiteral("Remove the stylet first.");
  view.set_injection_hindrance(reason);
  EXPECT_FALSE(view.is_injecting());
  view.set_injecting(true);
  EXPECT_FALSE(view.is_injecting());
  EXPECT_EQ(refused, QStringList{reason});
  view.set_injection_hindrance({});
  view.set_injecting(true);
  EXPECT_TRUE(view.is_injecting());
}

TEST_F(XrayViewTest, InterruptionPausesAHeldInjection) {
  view.pause_injection(true);
  view.set_injecting(true);
  EXPECT_FALSE(view.is_injecting());
  view.pause_injection(false);
  EXPECT_TRUE(view.is_injecting());
  view.pause_injection(true);
  view.set_injecting(false);
  view.pause_injection(false);
  EXPECT_FALSE(view.is_injecting()) << "released during the interruption";
}

TEST_F(XrayViewTest, ExposesOnlyWithThePedalAndHoldsTheLastImage) {
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

TEST_F(XrayViewTest, KeyActsAsPedal) {
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

TEST_F(XrayViewTest, ContrastAgentLeavesTheNeedleDuringInjection) {
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

/// An exposure at LAO 20 at 2 s, held at LAO 40 from 3 s on; 1 ml of contrast agent into the liver up to 2 s.
struct XrayViewReplayTest : XrayViewTest {
  void SetUp() override {
    XrayViewTest::SetUp();
    tasks::XrayUse on;
    on.time_s = 2.0;
    on.lao_deg = 20.0;
    on.isocentre_P = Vec3(-40.0, 0.0, 0.0);
    on.field_mm = view.unit().fields_mm.front();
    on.is_beam_on = true;
    on.contrast_ml = 1.0;
    on.beam_s = 0.5;
    on.dose_area_gycm2 = 7.0;
    tasks::XrayUse off = on;
    off.time_s = 3.0;
    off.lao_deg = 40.0;
    off.is_beam_on = false;
    uses = {on, off};
    attempt::InjectionSteps steps;
    steps.start_s = 1.0;
    steps.steps.assign(30, {tip_P, 1.0});
    injections = std::make_shared<const attempt::InjectionSteps>(std::move(steps));
  }
  void show(double time_s) {
    view.show_moment(attempt::xray_moment(uses, time_s), {tip_P + Vec3(-100.0, 0.0, 0.0), tip_P});
  }

  const Vec3 tip_P{-80.0, 0.0, 20.0};
  std::vector<tasks::XrayUse> uses;
  std::shared_ptr<const attempt::InjectionSteps> injections;
};

TEST_F(XrayViewReplayTest, ShowsTheRecordedMomentsForwardsAndBackwards) {
  view.begin_replay(injections);
  show(1.0);
  EXPECT_TRUE(view.is_complete());
  EXPECT_FALSE(view.frame());
  show(5.0);
  EXPECT_FALSE(view.is_complete());
  ASSERT_TRUE(run_until([&] { return view.is_complete(); }));
  EXPECT_EQ(view.frame()->time_s, 2.0);
  EXPECT_EQ(view.frame()->arm.lao_deg, 20.0) << "the projection of the exposure";
  EXPECT_EQ(view.settings().arm.lao_deg, 40.0) << "the C-arm now";
  EXPECT_EQ(view.use().dose_area_gycm2, 7.0);
  const image::GrayImage first = view.frame()->gray;
  show(1.0);
  EXPECT_FALSE(view.frame()) << "black before the first pulse";
  show(2.5);
  ASSERT_TRUE(run_until([&] { return view.is_complete(); }));
  EXPECT_EQ(view.frame()->time_s, 2.5);
  show(5.0);
  ASSERT_TRUE(run_until([&] { return view.is_complete(); }));
  EXPECT_EQ(view.frame()->gray.pixels, first.pixels) << "a moment has one image";
}

TEST_F(XrayViewReplayTest, ContrastAgentIsInTheImage) {
  const auto mean_at_end = [&](const std::shared_ptr<const attempt::InjectionSteps>& given) {
    view.begin_replay(given);
    show(5.0);
    EXPECT_TRUE(run_until([&] { return view.is_complete(); }));
    double sum = 0.0;
    for (const std::uint8_t gray : view.frame()->gray.pixels) sum += gray;
    return sum / static_cast<double>(view.frame()->gray.pixels.size());
  };
  const double without = mean_at_end(std::make_shared<const attempt::InjectionSteps>());
  EXPECT_LT(mean_at_end(injections), without - 0.2) << "dark where it is";
}

TEST_F(XrayViewReplayTest, DisablesControlsDuringAReplay) {
  XrayControls controls(view);
  const auto* pedal = controls.findChild<QPushButton*>(QStringLiteral("xray-pedal"));
  const auto* lao = controls.findChild<QSlider*>(QStringLiteral("xray-lao"));
  view.set_pedal(true);
  ASSERT_TRUE(shows_exposure());
  view.begin_replay(injections);
  show(5.0);
  EXPECT_FALSE(view.is_pedal_down());
  EXPECT_FALSE(pedal->isEnabled() || lao->isEnabled());
  EXPECT_EQ(lao->value(), 40) << "the recorded angle";
  QKeyEvent down(QEvent::KeyPress, Qt::Key_Z, Qt::NoModifier);
  QCoreApplication::sendEvent(&view, &down);
  view.set_injecting(true);
  drag(view, {200, 200}, {300, 150}, Qt::RightButton);
  const double field_mm = view.settings().arm.field_mm;
  wheel(view, {200, 200}, 120);
  EXPECT_FALSE(view.is_pedal_down() || view.is_injecting());
  EXPECT_EQ(view.settings().arm.lao_deg, 40.0);
  EXPECT_EQ(view.settings().arm.field_mm, field_mm);
  view.begin();
  EXPECT_TRUE(pedal->isEnabled() && lao->isEnabled());
  EXPECT_EQ(view.settings().arm.lao_deg, view.unit().arm.lao_deg);
  EXPECT_EQ(view.use().beam_s, 0.0) << "a new examination";
  view.set_pedal(true);
  ASSERT_TRUE(shows_exposure());
  EXPECT_LT(view.use().dose_area_gycm2, 7.0);
}

}  // namespace
}  // namespace trocar::trainer
