#include "panels/devices/device_choice.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QCoreApplication>
#include <QElapsedTimer>
#include <QFile>
#include <QLabel>
#include <QPushButton>
#include <QStandardItemModel>
#include <QTemporaryDir>

#include "devices/testing/hd_stand_ins.h"
#include "panels/devices/device_test_dialog.h"

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

/// Requests a force until more than 0.5 N were applied. On a busy machine the safety gate weakens it or stops it, or
/// the device counts as unplugged: then does what the dialog says.
void push_until_felt(const DeviceTestDialog& dialog, const trocar::testing::HdControls& device) {
  const auto says = [&](const char* name, const char* part) {
    return dialog.findChild<QLabel*>(QString::fromLatin1(name))->text().contains(QString::fromLatin1(part));
  };
  const auto click = [&](const char* name) { dialog.findChild<QPushButton*>(QString::fromLatin1(name))->click(); };
  QElapsedTimer timer, since_click;
  for (timer.start(); timer.elapsed() < 120'000; QCoreApplication::processEvents(QEventLoop::AllEvents, 20)) {
    const bool is_unplugged = says("device-answer", "then test again");
    const bool is_over = says("device-force", "Did you feel");
    if (is_over && device.strongest_n > 0.5) return;
    const bool is_stopped = is_over || is_unplugged || says("device-force", "Request it again");
    if (since_click.isValid() && (!is_stopped || since_click.elapsed() < 500)) continue;
    click(is_unplugged ? "device-again" : "device-push");
    is_unplugged ? since_click.invalidate() : since_click.start();
  }
  for (const char* name : {"device-answer", "device-pose", "device-force"})
    ADD_FAILURE() << name << ": " << dialog.findChild<QLabel*>(QString::fromLatin1(name))->text().toStdString();
}

TEST_F(DeviceChoiceTest, ListsDevicesByNameWithoutDuplicates) {
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

TEST_F(DeviceChoiceTest, KeepsASavedDeviceThatIsNoLongerListed) {
  DeviceChoice choice;
  choice.choose("openhaptics:Old Device", "mouse");
  EXPECT_EQ(choice.needle(), "openhaptics:Old Device");
}

TEST_F(DeviceChoiceTest, DeviceTestReportsAnswerMotionAndForce) {
  DeviceTestDialog dialog(QStringLiteral("openhaptics:Left Device"), QStringLiteral("Left Device"));
  EXPECT_TRUE(
      text_when(dialog, "device-answer", QStringLiteral("Premium")).startsWith(QStringLiteral("The device responds")));
  text_when(dialog, "device-pose", QStringLiteral("Move the device"));
  trocar::testing::place(*premium, {30.0, 10.0, 0.0});
  text_when(dialog, "device-pose", QStringLiteral("Right 30"));
  text_when(dialog, "device-pose", QStringLiteral("Motion detected"));
  EXPECT_EQ(premium->strongest_n, 0.0) << "nobody asked for a force";
  push_until_felt(dialog, *premium);
  EXPECT_LT(premium->strongest_n, 1.1);
  EXPECT_EQ(omni->openings, 0);
}

TEST_F(DeviceChoiceTest, ReportsAForceStoppedByTheSafetyGate) {
  DeviceTestDialog dialog(QStringLiteral("openhaptics:Left Device"), QStringLiteral("Left Device"));
  text_when(dialog, "device-pose", QStringLiteral("Move the device"));
  text_when(dialog, "device-force", QStringLiteral("No force is applied"));
  premium->tremor_mm = 300.0;  // at 9 Hz: no hand
  text_when(dialog, "device-pose", QStringLiteral("Motion detected"));
  dialog.findChild<QPushButton*>(QStringLiteral("device-push"))->click();
  const QString stopped = text_when(dialog, "device-force", QStringLiteral("Request it again"));
  EXPECT_TRUE(stopped.contains(QStringLiteral("impossible motion"))) << stopped.toStdString();
  premium->tremor_mm = 0.0;
  premium->strongest_n = 0.0;  // the gate braked the motion
  push_until_felt(dialog, *premium);
}

/// A haptic server in test mode that ends a push as one does whose loop was too slow for a force.
constexpr char kBusyServer[] = R"(#!/bin/sh
printf 'device\tOmni\tSensAble PHANTOM Omni\t6\t0.53\t1\n'
ended=0
while read -r line; do
  ended=$((ended + 1))
  printf 'state\t0\t0\t0\t0\t0\t1\t0\t1\t0.01\tnone\t%s\n' "$ended"
done
)";

TEST_F(DeviceChoiceTest, ReportsAForceTooWeakToFeel) {
  QTemporaryDir folder;
  QFile program(folder.filePath(QStringLiteral("trocar-hapticd")));
  ASSERT_TRUE(program.open(QIODevice::WriteOnly));
  program.write(kBusyServer);
  program.close();
  ASSERT_TRUE(program.setPermissions(QFile::ReadOwner | QFile::ExeOwner));
  const QByteArray programs = qgetenv("TROCAR_BIN_DIR");
  qputenv("TROCAR_BIN_DIR", folder.path().toUtf8());
  DeviceTestDialog dialog(QStringLiteral("virtual"), QStringLiteral("Omni"));
  qputenv("TROCAR_BIN_DIR", programs);
  text_when(dialog, "device-force", QStringLiteral("No force is applied"));
  for (int push = 0; push < 2; ++push) {
    dialog.findChild<QPushButton*>(QStringLiteral("device-push"))->click();
    text_when(dialog, "device-force", QStringLiteral("too busy"));
  }
}

TEST_F(DeviceChoiceTest, ReportsMissingAndUnpluggedDevicesInOneLine) {
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

TEST_F(DeviceChoiceTest, CalibratesAPremiumWhileItsArmIsHeld) {
  premium->calibration = 0x5002;  // HD_CALIBRATION_NEEDS_MANUAL_INPUT
  DeviceTestDialog dialog(QStringLiteral("openhaptics:Left Device"), QStringLiteral("Left Device"));
  text_when(dialog, "device-answer", QStringLiteral("not calibrated"));
  premium->is_in_reset_position = 1;
  dialog.findChild<QPushButton*>(QStringLiteral("device-calibrate"))->click();
  text_when(dialog, "device-answer", QStringLiteral("Calibrated. The device responds"));
}

}  // namespace
}  // namespace trocar::trainer
