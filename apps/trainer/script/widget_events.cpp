#include "script/widget_events.h"

#include <fmt/format.h>

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QImage>
#include <QKeyEvent>
#include <QKeySequence>
#include <QLineEdit>
#include <QMouseEvent>
#include <QShortcut>
#include <QSpinBox>
#include <QTabBar>
#include <QTabWidget>
#include <QWheelEvent>
#include <QWidget>
#include <cstdlib>

#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

QPointF at(const QWidget& widget, const QPointF& place) {
  return {place.x() * (widget.width() - 1), place.y() * (widget.height() - 1)};
}

/// The child widget at this position, as the window system would find it.
QWidget& hit(QWidget& widget, QPointF& place_px) {
  QWidget* child = widget.childAt(place_px.toPoint());
  if (child == nullptr) return widget;
  place_px = child->mapFrom(&widget, place_px.toPoint());
  return *child;
}

void send_mouse(QWidget& widget, QEvent::Type type, const QPointF& place, Qt::MouseButton button,
                Qt::MouseButtons buttons) {
  QPointF place_px = at(widget, place);
  QWidget& target = hit(widget, place_px);
  const QPointF global = target.mapToGlobal(place_px.toPoint());
  QMouseEvent event(type, place_px, global, button, buttons, QApplication::keyboardModifiers());
  QCoreApplication::sendEvent(&target, &event);
}

/// The widget with the focus, or the one that gets it when the window becomes active: a bare X server activates no
/// window.
QWidget& focused(QWidget& window) {
  if (QWidget* widget = QApplication::focusWidget()) return *widget;
  return window.focusWidget() != nullptr ? *window.focusWidget() : window;
}

Status no_such(const QWidget& widget, const QString& what) {
  return fail(fmt::format("\"{}\" cannot be set", to_std(what)), to_std(widget.objectName()),
              std::string("it is a ") + widget.metaObject()->className());
}

/// Qt finds shortcuts only for events of the window system; therefore they are looked up here.
bool act_on_shortcut(QWidget& window, const QKeySequence& sequence) {
  for (QAbstractButton* button : window.findChildren<QAbstractButton*>()) {
    if (button->shortcut() != sequence || !button->isVisible() || !button->isEnabled()) continue;
    button->click();
    return true;
  }
  for (QShortcut* shortcut : window.findChildren<QShortcut*>()) {
    const auto* owner = qobject_cast<const QWidget*>(shortcut->parent());
    if (shortcut->key() != sequence || !shortcut->isEnabled() || owner == nullptr || !owner->isVisible()) continue;
    Q_EMIT shortcut->activated();
    return true;
  }
  for (QAction* action : window.findChildren<QAction*>()) {
    if (action->shortcut() != sequence || !action->isEnabled()) continue;
    action->trigger();
    return true;
  }
  return false;
}

}  // namespace

void press(QWidget& widget, const QPointF& place, Qt::MouseButton button) {
  if (widget.focusPolicy() & Qt::ClickFocus) widget.setFocus(Qt::MouseFocusReason);
  send_mouse(widget, QEvent::MouseButtonPress, place, button, button);
}
void move(QWidget& widget, const QPointF& place, Qt::MouseButtons buttons) {
  send_mouse(widget, QEvent::MouseMove, place, Qt::NoButton, buttons);
}
void release(QWidget& widget, const QPointF& place, Qt::MouseButton button) {
  send_mouse(widget, QEvent::MouseButtonRelease, place, button, Qt::NoButton);
}
void double_click(QWidget& widget, const QPointF& place) {
  press(widget, place, Qt::LeftButton);
  release(widget, place, Qt::LeftButton);
  send_mouse(widget, QEvent::MouseButtonDblClick, place, Qt::LeftButton, Qt::LeftButton);
  release(widget, place, Qt::LeftButton);
}

void turn_wheel(QWidget& widget, const QPointF& place, int notches) {
  constexpr int kNotch = 120;
  QPointF place_px = at(widget, place);
  QWidget& target = hit(widget, place_px);
  QWheelEvent event(place_px, target.mapToGlobal(place_px.toPoint()), {}, {0, notches * kNotch}, Qt::NoButton,
                    QApplication::keyboardModifiers(), Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&target, &event);
}

Status send_keys(QWidget& window, const QString& keys, KeyMotion motion) {
  const QKeySequence sequence(keys, QKeySequence::PortableText);
  if (sequence.count() != 1 || sequence.toString().isEmpty())
    return fail("there is no key \"" + to_std(keys) + "\"", {}, "write Ctrl+Z, Space, F5 …");
#if QT_VERSION >= QT_VERSION_CHECK(6, 0, 0)
  const int key = sequence[0].key();
  const Qt::KeyboardModifiers modifiers = sequence[0].keyboardModifiers();
#else
  const int key = sequence[0] & ~static_cast<int>(Qt::KeyboardModifierMask);
  const Qt::KeyboardModifiers modifiers(sequence[0] & static_cast<int>(Qt::KeyboardModifierMask));
#endif
  QWidget* target = &focused(window);
  const QString text = modifiers == Qt::NoModifier && key < 0x100 ? QString(QChar(key)).toLower() : QString();
  QKeyEvent up(QEvent::KeyRelease, key, modifiers, text);
  if (motion == KeyMotion::kUp) {
    QCoreApplication::sendEvent(target, &up);
    return {};
  }
  // An override event first, as from the window system: text fields keep their keys.
  QKeyEvent override_event(QEvent::ShortcutOverride, key, modifiers, text);
  override_event.ignore();
  QCoreApplication::sendEvent(target, &override_event);
  if (!override_event.isAccepted()) {
    if (act_on_shortcut(window, sequence)) return {};
  }
  target = &focused(window);  // an open list has closed
  QKeyEvent down(QEvent::KeyPress, key, modifiers, text);
  QCoreApplication::sendEvent(target, &down);
  if (motion == KeyMotion::kPress) QCoreApplication::sendEvent(target, &up);
  return {};
}

void type_text(QWidget& window, const QString& text) {
  QWidget* target = &focused(window);
  for (const QChar c : text) {
    QKeyEvent down(QEvent::KeyPress, 0, Qt::NoModifier, QString(c));
    QCoreApplication::sendEvent(target, &down);
    QKeyEvent up(QEvent::KeyRelease, 0, Qt::NoModifier, QString(c));
    QCoreApplication::sendEvent(target, &up);
  }
}

Status choose_entry(QWidget& widget, const QString& text) {
  if (auto* box = qobject_cast<QComboBox*>(&widget)) {
    const int index = box->findText(text, Qt::MatchContains);
    if (index < 0) return no_such(widget, text);
    box->setCurrentIndex(index);
    Q_EMIT box->activated(index);
    return {};
  }
  QTabBar* tabs = qobject_cast<QTabBar*>(&widget);
  if (auto* tab_widget = qobject_cast<QTabWidget*>(&widget)) tabs = tab_widget->tabBar();
  if (tabs != nullptr) {
    for (int tab = 0; tab < tabs->count(); ++tab) {
      if (!tabs->tabText(tab).contains(text)) continue;
      tabs->setCurrentIndex(tab);
      return {};
    }
    return no_such(widget, text);
  }
  if (auto* view = qobject_cast<QAbstractItemView*>(&widget)) {
    const auto found = view->model()->match(view->model()->index(0, 0), Qt::DisplayRole, text, 1,
                                            Qt::MatchContains | Qt::MatchRecursive);
    if (found.isEmpty()) return no_such(widget, text);
    view->setCurrentIndex(found.first());
    Q_EMIT view->clicked(found.first());
    return {};
  }
  return no_such(widget, text);
}

Status set_value(QWidget& widget, const QString& value) {
  bool is_number = false;
  const double number = value.toDouble(&is_number);
  if (auto* slider = qobject_cast<QAbstractSlider*>(&widget); slider != nullptr && is_number) {
    slider->setValue(static_cast<int>(number));
    return {};
  }
  if (auto* box = qobject_cast<QSpinBox*>(&widget); box != nullptr && is_number) {
    box->setValue(static_cast<int>(number));
    return {};
  }
  if (auto* box = qobject_cast<QDoubleSpinBox*>(&widget); box != nullptr && is_number) {
    box->setValue(number);
    return {};
  }
  if (auto* button = qobject_cast<QAbstractButton*>(&widget); button != nullptr && button->isCheckable()) {
    if (button->isChecked() != (value == QLatin1String("on"))) button->click();
    return {};
  }
  if (auto* field = qobject_cast<QLineEdit*>(&widget)) {
    field->setFocus();
    field->setText(value);
    Q_EMIT field->textEdited(value);
    Q_EMIT field->editingFinished();
    return {};
  }
  return no_such(widget, value);
}

double share_near(const QImage& image, const QColor& color, int tolerance) {
  const QImage pixels = image.convertToFormat(QImage::Format_RGB32);
  std::int64_t near = 0;
  for (int row = 0; row < pixels.height(); ++row) {
    const auto* line = reinterpret_cast<const QRgb*>(pixels.constScanLine(row));
    for (int column = 0; column < pixels.width(); ++column) {
      const QRgb p = line[column];
      near += std::abs(qRed(p) - color.red()) <= tolerance && std::abs(qGreen(p) - color.green()) <= tolerance &&
              std::abs(qBlue(p) - color.blue()) <= tolerance;
    }
  }
  const double count = static_cast<double>(pixels.width()) * pixels.height();
  return count > 0 ? static_cast<double>(near) / count : 0.0;
}

}  // namespace trocar::trainer
