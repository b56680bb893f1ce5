#pragma once

#include <QObject>
#include <QPointer>

class QWidget;

namespace trocar::trainer {

/// Draws a ring inside the edge of the widget that has the keyboard focus. A focused page has no ring. The ring is
/// transparent to the mouse.
class FocusRing : public QObject {
  Q_OBJECT

 public:
  explicit FocusRing(QObject* parent = nullptr);
  ~FocusRing() override;

  /// Null: no ring.
  void show_on(QWidget* widget);
  /// The widget with the ring; null: none.
  QWidget* target() const;

 private:
  QPointer<QWidget> ring_;  ///< A child of the target, clipped as the target is.
};

}  // namespace trocar::trainer
