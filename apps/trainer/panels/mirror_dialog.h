#pragma once

#include <QDialog>

#include "panels/mirror_settings.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;

namespace trocar::trainer {

/// Settings of a workstation with a mirror. Each change takes effect at once.
class MirrorDialog : public QDialog {
  Q_OBJECT

 public:
  MirrorDialog(const MirrorSettings& settings, QWidget* parent);

 Q_SIGNALS:
  void changed(const trocar::trainer::MirrorSettings& settings);

 private:
  QDoubleSpinBox* add(QFormLayout& form, const char* name, const QString& title, const QString& tooltip,
                      const QString& unit, double least, double most, double value);
  MirrorSettings settings() const;
  void notify_change();

  QComboBox* axis_ = nullptr;
  QCheckBox* fixed_ = nullptr;
  QDoubleSpinBox* right_ = nullptr;
  QDoubleSpinBox* away_ = nullptr;
  QDoubleSpinBox* up_ = nullptr;
  QDoubleSpinBox* tilt_ = nullptr;
  QDoubleSpinBox* width_ = nullptr;
  QDoubleSpinBox* eye_ = nullptr;
};

}  // namespace trocar::trainer
