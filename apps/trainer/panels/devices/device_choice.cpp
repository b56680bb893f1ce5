#include "panels/devices/device_choice.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QInputDialog>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QStandardItemModel>
#include <QVBoxLayout>
#include <algorithm>

#include "attempt/servers/haptic_servers.h"
#include "panels/devices/device_test_dialog.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

constexpr int kMostAdded = 8;
const char* const kAdded = "start/added-devices";
const char* const kOpenHaptics = "openhaptics:";

std::string spec_of(const QComboBox& box) {
  return to_std(box.currentData().toString());
}

/// Disables devices that are used for the other tool.
void grey_out(QComboBox& box, const std::string& other) {
  auto* model = qobject_cast<QStandardItemModel*>(box.model());
  for (int row = 0; row < box.count(); ++row) {
    const bool is_free = attempt::can_be_used_together(to_std(box.itemData(row).toString()), other);
    QStandardItem* item = model->item(row);
    item->setEnabled(is_free);
    item->setToolTip(is_free ? QString() : DeviceChoice::tr("Already used for the other tool"));
  }
}

}  // namespace

DeviceChoice::DeviceChoice(QWidget* parent) : QWidget(parent) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  auto* add = make_button("add-device", tr("Add a device by name …"),
                          tr("An OpenHaptics device with the name assigned in the vendor's setup program"));
  add->setStyleSheet(QStringLiteral("padding: 1px 8px;"));
  auto* heading = new QHBoxLayout;
  heading->addWidget(make_label(tr("Needle device"), "dim"));
  heading->addStretch();
  heading->addWidget(add);
  column->addLayout(heading);
  needle_ = add_tool(*column, tr("Needle device"), "device", "test-device");
  column->addSpacing(4);
  column->addWidget(make_label(tr("Transducer device"), "dim"));
  probe_ = add_tool(*column, tr("Transducer device"), "device-probe", "test-device-probe");
  connect(add, &QPushButton::clicked, this, &DeviceChoice::add_by_name);
  fill();
  for (QComboBox* box : {needle_, probe_})
    connect(box, qOverload<int>(&QComboBox::currentIndexChanged), this, &DeviceChoice::keep_apart);
  keep_apart();
}

QComboBox* DeviceChoice::add_tool(QBoxLayout& column, const QString& title, const char* name, const char* test_name) {
  auto* box = new QComboBox;
  box->setObjectName(QString::fromLatin1(name));
  box->setAccessibleName(title);
  box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  auto* button = make_button(test_name, tr("Test"), tr("Tests connection, motion and forces of the device"));
  button->setAccessibleName(tr("Test the device of: %1").arg(title));
  auto* row = new QHBoxLayout;
  row->setSpacing(6);
  row->addWidget(box, 1);
  row->addWidget(button);
  column.addLayout(row);
  connect(button, &QPushButton::clicked, this, [this, box] { test(*box); });
  // Mouse and keys need no test.
  connect(box, qOverload<int>(&QComboBox::currentIndexChanged), button,
          [box, button] { button->setEnabled(spec_of(*box) != "mouse"); });
  button->setEnabled(false);
  return box;
}

void DeviceChoice::fill() {
  for (const attempt::ToolDevice& device : attempt::tool_devices()) list(to_qt(device.spec));
  for (const QString& spec : QSettings().value(QString::fromLatin1(kAdded)).toStringList()) list(spec);
}

void DeviceChoice::list(const QString& spec) {
  for (QComboBox* box : {needle_, probe_})
    if (box->findData(spec) < 0) box->addItem(shown(attempt::device_title(to_std(spec))), spec);
}

/// On a conflict, the transducer gets the mouse.
void DeviceChoice::keep_apart() {
  if (!attempt::can_be_used_together(spec_of(*needle_), spec_of(*probe_)))
    probe_->setCurrentIndex(probe_->findData("mouse"));
  grey_out(*probe_, spec_of(*needle_));
  grey_out(*needle_, spec_of(*probe_));
}

void DeviceChoice::choose(const std::string& needle, const std::string& probe) {
  const auto select = [this](QComboBox& box, const std::string& spec) {
    if (!spec.empty()) list(to_qt(spec));
    box.setCurrentIndex(std::max(0, box.findData(to_qt(spec))));
  };
  probe_->setCurrentIndex(0);  // so that the needle can use the device of the transducer
  select(*needle_, needle);
  select(*probe_, probe);
  keep_apart();
}

std::string DeviceChoice::needle() const {
  return spec_of(*needle_);
}

std::string DeviceChoice::probe() const {
  return spec_of(*probe_);
}

void DeviceChoice::add_by_name() {
  const QString name =
      QInputDialog::getText(this, tr("Add a device"), tr("Name of the OpenHaptics device, as in its setup program:"));
  if (name.trimmed().isEmpty()) return;
  const QString spec = QString::fromLatin1(kOpenHaptics) + name.trimmed();
  list(spec);
  QSettings settings;
  QStringList added = settings.value(QString::fromLatin1(kAdded)).toStringList();
  added.removeAll(spec);
  added.prepend(spec);
  while (added.size() > kMostAdded) added.removeLast();
  settings.setValue(QString::fromLatin1(kAdded), added);
  keep_apart();
}

void DeviceChoice::test(const QComboBox& box) {
  if (auto* open = window()->findChild<DeviceTestDialog*>()) delete open;  // both can use the same device
  auto* dialog = new DeviceTestDialog(box.currentData().toString(), box.currentText(), window());
  dialog->show();
}

}  // namespace trocar::trainer
