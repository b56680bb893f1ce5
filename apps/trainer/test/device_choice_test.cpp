#include "panels/device_choice.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QCoreApplication>
#include <QElapsedTimer>
#include <QLabel>
#include <QPushButton>
#include <QStandardItemModel>

#include "devices/testing/hd_stand_ins.h"
#include "panels/device_test_dialog.h"

namespace trocar::trainer {
namespace {

struct DeviceChoiceTest : ::testing::Test {
  DeviceChoiceTest() {
    premium = &devices.add_premium("Left Device");
    omni = &devices.add_omni("Right Device");
  }
  trocar::testing::HdStandIns devices;
  trocar::testing::HdControls* premium = nullptr;
  trocar::testing::HdControls* omni = nullptr;
};

QComboBox& box_of(DeviceChoice& choice, const char* name) {
  return *choice.findChild<QComboBox*>(QString::fromLatin1(name));
}

bool can_choose(QComboBox& box, const char* spec) {
  return qobject_cast<QStandardItemModel*>(box.model())->item(box.findData(QString::fromLatin1(spec)))->isEnabled();
}

/// The text of a label of the dialog, when it has come about; empty: it has not within 20 s.
QString text_when(const DeviceTestDialog& dialog, const char* name, const QString& part) {
  const auto* label = dialog.findChild<QLabel*>(QString::fromLatin1(name));
  QElapsedTimer timer;
  for (timer.start(); timer.elapsed() < 20'000; QCoreApplication::processEvents(QEventLoop::AllEvents, 20))
    if (label->text().contains(part)) return label->text();
  ADD_FAILURE() << name << ": " << label->text().toStdString();
  return {};
}

/// Requests a force until it was applied. On a busy machine the safety gate stops it, or the device counts as
/// unplugged: then does what the dialog says.
void push_until_felt(const DeviceTestDialog& dialog) {
  const auto text_of = [&](const char* name) { return dialog.findChild<QLabel*>(QString::fromLatin1(name))->text(); };
  const auto click = [&](const char* name) { dialog.findChild<QPushButton*>(QString::fromLatin1(name))->click(); };
  QElapsedTimer timer, since_push;
  for (timer.start(); timer.elapsed() < 120'000; QCoreApplication::processEvents(QEventLoop::AllEvents, 20)) {
    if (text_of("device-force").contains(QStringLiteral("Did you feel"))) return;
    const bool is_unplugged = text_of("device-answer").contains(QStringLiteral("then test again"));
    const bool is_stopped = text_of("device-force").contains(QStringLiteral("Request it again"));
    const bool has_waited = !since_push.isValid() || since_push.elapsed() > 500;
    const bool is_asked = since_push.isValid() && !is_stopped && !is_unplugged;
    if (is_asked || !has_waited) continue;
    click(is_unplugged ? "device-again" : "device-push");
    is_unplugged ? since_push.invalidate() : since_push.start();
  }
  ADD_FAILURE() << text_of("device-answer").toStdString() << "\n" << text_of("device-force").toStdString();
}

TEST_F(DeviceChoiceTest, NamesTheDevicesAndKeepsThemApart) {
  DeviceChoice choice;
  choice.choose("openhaptics:Left Device", "openhaptics:Right Device");
  EXPECT_EQ(choice.needle(), "openhaptics:Left Device");
  EXPECT_EQ(choice.probe(), "openhaptics:Right Device");
  EXPECT_TRUE(box_of(choice, "device").currentText().contains(QStringLiteral("Left Device")));
  EXPECT_FALSE(can_choose(box_of(choice, "device"), "openhaptics:Right Device"));
  EXPECT_FALSE(can_choose(box_of(choice, "device-probe"), "openhaptics:Left Device"));
  EXPECT_TRUE(can_choose(box_of(choice, "device-probe"), "mouse"));
}

TEST_F(DeviceChoiceTest, OneDeviceCannotBeBothTools) {
  DeviceChoice choice;
  choice.choose("gamepad", "gamepad");
  EXPECT_EQ(choice.needle(), "gamepad");
  EXPECT_EQ(choice.probe(), "mouse");
  choice.choose("mouse", "openhaptics:Left Device");
  box_of(choice, "device")
      .setCurrentIndex(box_of(choice, "device").findData(QStringLiteral("openhaptics:Left Device")));
  EXPECT_EQ(choice.probe(), "mouse") << "the transducer gives way";
}

TEST_F(DeviceChoiceTest, ADeviceOfLastTimeThatIsNotListedIsKept) {
  DeviceChoice choice;
  choice.choose("openhaptics:Old Device", "mouse");
  EXPECT_EQ(choice.needle(), "openhaptics:Old Device");
}

TEST_F(DeviceChoiceTest, TheTestSaysWhetherADeviceAnswersMovesAndPushes) {
  DeviceTestDialog dialog(QStringLiteral("openhaptics:Left Device"), QStringLiteral("Left Device"));
  EXPECT_TRUE(
      text_when(dialog, "device-answer", QStringLiteral("Premium")).startsWith(QStringLiteral("The device responds")));
  text_when(dialog, "device-pose", QStringLiteral("Move the device"));
  trocar::testing::place(*premium, {30.0, 10.0, 0.0});
  text_when(dialog, "device-pose", QStringLiteral("Right 30"));
  text_when(dialog, "device-pose", QStringLiteral("Motion detected"));
  EXPECT_EQ(premium->strongest_n, 0.0) << "nobody asked for a force";
  push_until_felt(dialog);
  EXPECT_GT(premium->strongest_n, 0.5);
  EXPECT_LT(premium->strongest_n, 1.1);
  EXPECT_EQ(omni->openings, 0);
}

TEST_F(DeviceChoiceTest, AForceThatTheSafetyGateStopsIsToldAndMayBeRequestedAgain) {
  DeviceTestDialog dialog(QStringLiteral("openhaptics:Left Device"), QStringLiteral("Left Device"));
  text_when(dialog, "device-pose", QStringLiteral("Move the device"));
  text_when(dialog, "device-force", QStringLiteral("No force is applied"));
  premium->tremor_mm = 300.0;  // at 9 Hz: no hand
  text_when(dialog, "device-pose", QStringLiteral("Motion detected"));
  dialog.findChild<QPushButton*>(QStringLiteral("device-push"))->click();
  const QString stopped = text_when(dialog, "device-force", QStringLiteral("Request it again"));
  EXPECT_TRUE(stopped.contains(QStringLiteral("impossible motion"))) << stopped.toStdString();
  EXPECT_LT(premium->strongest_n, 0.05);
  premium->tremor_mm = 0.0;
  push_until_felt(dialog);
  EXPECT_GT(premium->strongest_n, 0.5);
}

TEST_F(DeviceChoiceTest, MissingAndUnpluggedDevicesAreToldInOneLine) {
  omni->is_present = 0;
  DeviceTestDialog dialog(QStringLiteral("openhaptics:Right Device"), QStringLiteral("Right Device"));
  const QString missing = text_when(dialog, "device-answer", QStringLiteral("does not respond."));
  EXPECT_TRUE(missing.contains(QStringLiteral("Right Device"))) << missing.toStdString();
  EXPECT_FALSE(missing.contains(QLatin1Char('\n')));
  omni->is_present = 1;
  dialog.findChild<QPushButton*>(QStringLiteral("device-again"))->click();
  text_when(dialog, "device-answer", QStringLiteral("The device responds"));
  omni->is_present = 0;
  text_when(dialog, "device-answer", QStringLiteral("no longer responds"));
}

TEST_F(DeviceChoiceTest, APremiumIsCalibratedWhereItsArmIsHeldForIt) {
  premium->calibration = 0x5002;  // HD_CALIBRATION_NEEDS_MANUAL_INPUT
  DeviceTestDialog dialog(QStringLiteral("openhaptics:Left Device"), QStringLiteral("Left Device"));
  text_when(dialog, "device-answer", QStringLiteral("not calibrated"));
  premium->is_in_reset_position = 1;
  dialog.findChild<QPushButton*>(QStringLiteral("device-calibrate"))->click();
  text_when(dialog, "device-answer", QStringLiteral("Calibrated. The device responds"));
}

}  // namespace
}  // namespace trocar::trainer
