#include "panels/mirror_dialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui_kit/decimal_field.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {

MirrorDialog::MirrorDialog(const MirrorSettings& settings, QWidget* parent) : QDialog(parent) {
  setObjectName(QStringLiteral("mirror-settings"));
  setWindowTitle(tr("Mirror workstation"));
  setAttribute(Qt::WA_DeleteOnClose);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(20, 16, 20, 16);
  column->setSpacing(10);
  QLabel* text = make_label(tr("For a monitor viewed in a mirror, with the hands behind the mirror."), "dim");
  text->setWordWrap(true);
  column->addWidget(text);
  auto* form = new QFormLayout;
  form->setSpacing(8);
  column->addLayout(form);
  axis_ = new QComboBox;
  axis_->setObjectName(QStringLiteral("mirror-axis"));
  axis_->addItems({tr("Off"), tr("Left and right"), tr("Up and down")});
  axis_->setCurrentIndex(static_cast<int>(settings.axis));
  axis_->setToolTip(tr("Mirrors the whole window with its menus and dialogs; F8 switches mirroring on and off"));
  form->addRow(tr("Mirror the window"), axis_);
  fixed_ = new QCheckBox(tr("Camera fixed to the device: the tool is displayed at the position of the hand"));
  fixed_->setObjectName(QStringLiteral("mirror-fixed"));
  fixed_->setChecked(settings.is_camera_fixed);
  column->addWidget(fixed_);
  QLabel* place =
      make_label(tr("Position of the mirror image, relative to the centre of the device's workspace:"), "dim");
  place->setWordWrap(true);
  column->addWidget(place);
  auto* numbers = new QFormLayout;
  numbers->setSpacing(8);
  column->addLayout(numbers);
  const QString mm = tr(" mm");
  const Vec3& p = settings.picture_W;
  right_ = add(*numbers, "mirror-right", tr("To the right"), tr("Position of the window's centre (to the right)"), mm,
               -500, 500, p.x());
  away_ = add(*numbers, "mirror-away", tr("Away from you"), tr("Position of the window's centre (away from you)"), mm,
              -500, 500, p.y());
  up_ = add(*numbers, "mirror-up", tr("Up"), tr("Position of the window's centre (up)"), mm, -500, 500, p.z());
  tilt_ = add(*numbers, "mirror-tilt", tr("Tilt"), tr("0°: upright before you; 90°: horizontal, viewed from above"),
              tr("°"), 0, 90, settings.tilt_deg);
  width_ = add(*numbers, "mirror-width", tr("Width of the screen"), tr("Width of the screen's image in the mirror"), mm,
               100, 2000, settings.screen_width_mm);
  eye_ = add(*numbers, "mirror-eye", tr("From your eye"), tr("Distance from the eye to the image"), mm, 200, 2000,
             settings.eye_distance_mm);
  auto* close = make_button("mirror-close", tr("Close"), tr("The settings are saved"));
  column->addWidget(close, 0, Qt::AlignRight);
  connect(close, &QPushButton::clicked, this, &QDialog::close);
  connect(axis_, qOverload<int>(&QComboBox::currentIndexChanged), this, &MirrorDialog::notify_change);
  connect(fixed_, &QCheckBox::toggled, this, &MirrorDialog::notify_change);
}

QDoubleSpinBox* MirrorDialog::add(QFormLayout& form, const char* name, const QString& title, const QString& tooltip,
                                  const QString& unit, double least, double most, double value) {
  auto* box = new DecimalField;
  box->setObjectName(QString::fromLatin1(name));
  box->setAccessibleName(title);
  box->setToolTip(tooltip);
  box->setRange(least, most);
  box->setDecimals(1);
  box->setSuffix(unit);
  box->setValue(value);
  form.addRow(make_label(title, "dim"), box);
  connect(box, qOverload<double>(&QDoubleSpinBox::valueChanged), this, &MirrorDialog::notify_change);
  return box;
}

MirrorSettings MirrorDialog::settings() const {
  MirrorSettings settings;
  settings.axis = static_cast<MirrorAxis>(axis_->currentIndex());
  settings.is_camera_fixed = fixed_->isChecked();
  settings.picture_W = {right_->value(), away_->value(), up_->value()};
  settings.tilt_deg = tilt_->value();
  settings.screen_width_mm = width_->value();
  settings.eye_distance_mm = eye_->value();
  return settings;
}

void MirrorDialog::notify_change() {
  Q_EMIT changed(settings());
}

}  // namespace trocar::trainer
