#include "ui_kit/wheel_guard.h"

#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QComboBox>
#include <QEvent>
#include <QScrollBar>
#include <QTabBar>

namespace trocar::trainer {
namespace {

/// A widget whose value the wheel changes.
QWidget* find_guarded(QObject* object) {
  if (qobject_cast<QScrollBar*>(object) != nullptr) return nullptr;
  const bool is_guarded =
      qobject_cast<QAbstractSlider*>(object) != nullptr || qobject_cast<QComboBox*>(object) != nullptr ||
      qobject_cast<QAbstractSpinBox*>(object) != nullptr || qobject_cast<QTabBar*>(object) != nullptr;
  return is_guarded ? static_cast<QWidget*>(object) : nullptr;
}

}  // namespace

bool WheelGuard::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::Wheel && event->type() != QEvent::Polish) return false;
  QWidget* const widget = find_guarded(watched);
  if (widget == nullptr) return false;
  if (event->type() == QEvent::Polish) {
    // Otherwise the wheel would first give it the focus.
    if (widget->focusPolicy() == Qt::WheelFocus) widget->setFocusPolicy(Qt::StrongFocus);
    return false;
  }
  if (widget->window()->focusWidget() == widget) return false;
  event->ignore();
  return true;  // the parent receives it
}

}  // namespace trocar::trainer
