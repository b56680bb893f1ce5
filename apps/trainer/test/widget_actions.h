#pragma once

#include <QCoreApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPixmap>
#include <QWheelEvent>
#include <QWidget>
#include <cstdlib>

/// User input to one widget, sent as events. Positions are points of the widget.
namespace trocar::trainer {

inline void mouse(QWidget& widget, QEvent::Type type, const QPointF& at, Qt::MouseButton button,
                  Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  const Qt::MouseButton changed = type == QEvent::MouseMove ? Qt::NoButton : button;
  const Qt::MouseButtons held = type == QEvent::MouseButtonRelease ? Qt::NoButton : button;
  QMouseEvent event(type, at, QPointF(widget.mapToGlobal(at.toPoint())), changed, held, modifiers);
  QCoreApplication::sendEvent(&widget, &event);
}

inline void drag(QWidget& widget, const QPointF& from, const QPointF& to, Qt::MouseButton button,
                 Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  mouse(widget, QEvent::MouseButtonPress, from, button, modifiers);
  mouse(widget, QEvent::MouseMove, to, button, modifiers);
  mouse(widget, QEvent::MouseButtonRelease, to, button, modifiers);
}

inline void wheel(QWidget& widget, const QPointF& at, int delta, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  QWheelEvent event(at, QPointF(widget.mapToGlobal(at.toPoint())), {}, {0, delta}, Qt::NoButton, modifiers,
                    Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&widget, &event);
}

inline void press_key(QWidget& widget, int key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  QKeyEvent event(QEvent::KeyPress, key, modifiers);
  QCoreApplication::sendEvent(&widget, &event);
}

/// Saves an image of the widget for visual inspection if TROCAR_SAVE_PICTURES names a prefix.
inline void save(QWidget& widget, const char* name) {
  if (const char* prefix = std::getenv("TROCAR_SAVE_PICTURES"))
    widget.grab().save(QString::fromLocal8Bit(prefix) + QString::fromLatin1(name));
}

}  // namespace trocar::trainer
