#pragma once

#include <QDialog>
#include <QVariantMap>
#include <memory>

class QLabel;
class QPushButton;

namespace trocar::trainer {

class DeviceCheck;
class PosePicture;

/// Says in plain words whether a device answers, shows its pose moving, gives a small force on request, and calibrates
/// it where its driver can. Holds the device while it is open.
class DeviceTestDialog : public QDialog {
  Q_OBJECT

 public:
  DeviceTestDialog(const QString& spec, const QString& title, QWidget* parent = nullptr);
  ~DeviceTestDialog() override;
  /// What it says, for scripts: device_answer, device_pose, device_force.
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
