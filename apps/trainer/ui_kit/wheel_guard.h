#pragma once

#include <QObject>

namespace trocar::trainer {

/// Event filter: the wheel changes a slider, combo box or number field only while the widget has the focus by a click
/// or the Tab key; otherwise it scrolls the surrounding area.
class WheelGuard : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  bool eventFilter(QObject* watched, QEvent* event) override;
};

}  // namespace trocar::trainer
