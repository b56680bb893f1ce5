#pragma once

#include <QObject>

namespace trocar::trainer {

/// The wheel changes a slider, choice or number only while it has the focus, by a click or the Tab key; over others it
/// scrolls the area around them.
class WheelGuard : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  bool eventFilter(QObject* watched, QEvent* event) override;
};

}  // namespace trocar::trainer
