#pragma once

#include <QDialog>
#include <QVariantMap>
#include <memory>

class QLabel;
class QPushButton;

namespace trocar::trainer {

class DeviceCheck;
class PosePicture;

/// Displays whether a device responds and its moving pose, applies a small force on request, and calibrates the device
/// if its driver supports it. Keeps the device open while the dialog is open.
class DeviceTestDialog : public QDialog {
  Q_OBJECT

 public:
  DeviceTestDialog(const QString& spec, const QString& title, QWidget* parent = nullptr);
  ~DeviceTestDialog() override;
  /// Displayed texts, for scripts: device_answer, device_pose, device_force.
  QVariantMap facts() const;

 private:
  void start(bool is_calibrating);
  void show_state();

  QString spec_, title_;
  std::unique_ptr<DeviceCheck> check_;
  bool was_calibrating_ = false;
  QLabel* answer_ = nullptr;
  QLabel* pose_ = nullptr;
  QLabel* force_ = nullptr;
  PosePicture* picture_ = nullptr;
  QPushButton* push_ = nullptr;
  QPushButton* calibrate_ = nullptr;
  QPushButton* again_ = nullptr;
};

}  // namespace trocar::trainer
