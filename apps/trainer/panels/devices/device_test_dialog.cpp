#include "panels/devices/device_test_dialog.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "panels/devices/device_check.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "views/ultrasound/pose_picture.h"

namespace trocar::trainer {
namespace {

using State = DeviceCheckView::State;

constexpr double kMoved_mm = 5.0;  ///< Larger motion is not tremor.

bool can_calibrate(const QString& spec) {
  return spec.startsWith(QLatin1String("openhaptics"));
}

/// Steps of a device's calibration that the user must do.
QString calibration_text(const QString& spec) {
  if (can_calibrate(spec))
    return DeviceTestDialog::tr(
        "Calibrate: first put the stylus into its inkwell (Omni, Touch), or hold the arm in its reset position as the "
        "vendor's manual shows it (Premium).");
  if (spec.startsWith(QLatin1String("forcedimension")))
    return DeviceTestDialog::tr("It calibrates automatically in its calibration pit; then press its force button.");
  if (spec.startsWith(QLatin1String("haply")))
    return DeviceTestDialog::tr("It calibrates automatically with the grip on its rest.");
  return {};
}

QString answer_text(const DeviceCheckView& view, bool was_calibrating) {
  switch (view.state) {
    case State::kStarting:
      return DeviceTestDialog::tr("Looking for the device …");
    case State::kAnswers:
      return (was_calibrating ? DeviceTestDialog::tr("Calibrated. The device responds: %1.")
                              : DeviceTestDialog::tr("The device responds: %1."))
          .arg(view.text);
    case State::kUnplugged:
      return DeviceTestDialog::tr("The device no longer responds. Check that it is plugged in, then test again.");
    case State::kFailed:
      return DeviceTestDialog::tr("The device does not respond. %1").arg(view.text);
  }
  return {};
}

QString pose_text(const DeviceCheckView& view) {
  if (!view.has_pose) return DeviceTestDialog::tr("Waiting for its pose …");
  const QString moved = view.moved_mm > kMoved_mm
                            ? DeviceTestDialog::tr("Motion detected: %1 mm so far.").arg(view.moved_mm, 0, 'f', 0)
                            : DeviceTestDialog::tr("Move the device: the picture must follow.");
  return DeviceTestDialog::tr("Right %1, away %2, up %3 mm. Buttons: %4. %5")
      .arg(view.p_D.x(), 0, 'f', 0)
      .arg(view.p_D.y(), 0, 'f', 0)
      .arg(view.p_D.z(), 0, 'f', 0)
      .arg(view.buttons == 0 ? DeviceTestDialog::tr("none") : QString::number(view.buttons))
      .arg(moved);
}

QString force_text(const DeviceCheckView& view) {
  constexpr double kSomething_n = 0.05;
  if (view.force_n > kSomething_n) return DeviceTestDialog::tr("Force now: %1 N upwards").arg(view.force_n, 0, 'f', 1);
  if (!view.stop_reason.isEmpty())
    return DeviceTestDialog::tr("The safety gate stopped the force: %1. Request it again.").arg(view.stop_reason);
  if (view.strongest_n > kSomething_n)
    return DeviceTestDialog::tr("%1 N were applied. Did you feel the force?").arg(view.strongest_n, 0, 'f', 1);
  if (view.is_push_over)
    return DeviceTestDialog::tr("The computer was too busy for a force that can be felt. Request it again.");
  return view.has_force ? DeviceTestDialog::tr("No force is applied before you request it.")
                        : DeviceTestDialog::tr("It has no motors for forces; a gamepad uses rumble.");
}

}  // namespace

DeviceTestDialog::DeviceTestDialog(const QString& spec, const QString& title, QWidget* parent)
    : QDialog(parent), spec_(spec), title_(title) {
  setObjectName(QStringLiteral("device-test"));
  setWindowTitle(tr("Test: %1").arg(title));
  setAttribute(Qt::WA_DeleteOnClose);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(20, 16, 20, 16);
  column->setSpacing(10);
  column->addWidget(make_label(title, "heading"));
  const auto add_line = [&](const char* name) {
    QLabel* label = make_label({});
    label->setObjectName(QString::fromLatin1(name));
    label->setWordWrap(true);
    column->addWidget(label);
    return label;
  };
  answer_ = add_line("device-answer");
  picture_ = new PosePicture;
  column->addWidget(picture_, 1);
  pose_ = add_line("device-pose");
  force_ = add_line("device-force");
  if (const QString text = calibration_text(spec); !text.isEmpty()) {
    QLabel* calibration = make_label(text, "dim");
    calibration->setWordWrap(true);
    column->addWidget(calibration);
  }
  auto* row = new QHBoxLayout;
  push_ = make_button("device-push", tr("Give a small force"), tr("Upwards, for about a second; hold the device"));
  calibrate_ = make_button("device-calibrate", tr("Calibrate"), tr("When the device is in the required position"));
  calibrate_->setVisible(can_calibrate(spec));
  again_ = make_button("device-again", tr("Test again"), tr("Opens the device again"));
  auto* close = make_button("device-close", tr("Close"), tr("Release the device"));
  for (QPushButton* button : {push_, calibrate_, again_}) row->addWidget(button);
  row->addStretch();
  row->addWidget(close);
  column->addLayout(row);
  connect(push_, &QPushButton::clicked, this, [this] { check_->push(); });
  connect(calibrate_, &QPushButton::clicked, this, [this] { start(true); });
  connect(again_, &QPushButton::clicked, this, [this] { start(false); });
  connect(close, &QPushButton::clicked, this, &QDialog::close);
  start(false);
}

DeviceTestDialog::~DeviceTestDialog() = default;

QVariantMap DeviceTestDialog::facts() const {
  return {{QStringLiteral("device_answer"), answer_->text()},
          {QStringLiteral("device_pose"), pose_->text()},
          {QStringLiteral("device_force"), force_->text()}};
}

void DeviceTestDialog::start(bool is_calibrating) {
  check_.reset();  // only one program can open the device
  was_calibrating_ = is_calibrating;
  check_ = std::make_unique<DeviceCheck>(spec_, is_calibrating);
  connect(check_.get(), &DeviceCheck::changed, this, &DeviceTestDialog::show_state);
  show_state();
}

void DeviceTestDialog::show_state() {
  const DeviceCheckView& view = check_->view();
  const bool is_there = view.state == State::kAnswers;
  answer_->setText(answer_text(view, was_calibrating_));
  answer_->setToolTip(view.details);
  const bool is_bad = view.state == State::kFailed || view.state == State::kUnplugged;
  answer_->setStyleSheet(QStringLiteral("color: %1; font-weight: 600;")
                             .arg((is_bad     ? theme().bad
                                   : is_there ? theme().good
                                              : theme().dim)
                                      .name()));
  pose_->setText(is_there ? pose_text(view) : QString());
  force_->setText(is_there ? force_text(view) : QString());
  picture_->show_pose(view.p_D, view.axis_D, is_there && view.has_pose);
  push_->setEnabled(is_there);
}

}  // namespace trocar::trainer
