#pragma once

#include <QObject>
#include <QPointer>

class QWidget;

namespace trocar::trainer {

/// Draws a ring within the edge of the widget that has the keyboard focus. A page as a whole has none. The ring is
/// transparent for the mouse.
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
