// The keys that are held: pedal and injection.
#include <QAbstractSpinBox>
#include <QApplication>
#include <QKeyEvent>
#include <QLineEdit>

#include "views/xray/xray_view.h"

namespace trocar::trainer {
namespace {

/// A key typed into a text field is no pedal.
bool is_typing() {
  const QWidget* focus = QApplication::focusWidget();
  return qobject_cast<const QLineEdit*>(focus) != nullptr || qobject_cast<const QAbstractSpinBox*>(focus) != nullptr ||
         QApplication::activeModalWidget() != nullptr;
}

}  // namespace

bool XrayView::eventFilter(QObject* watched, QEvent* event) {
  const bool is_press = event->type() == QEvent::KeyPress || event->type() == QEvent::ShortcutOverride;
  if (event->type() == QEvent::WindowDeactivate || event->type() == QEvent::ApplicationDeactivate) {
    set_pedal(false);
    set_injecting(false);
  }
  if (!is_press && event->type() != QEvent::KeyRelease) return QWidget::eventFilter(watched, event);
  const auto* key = static_cast<const QKeyEvent*>(event);
  const bool is_ours = (key->key() == Qt::Key_Z || key->key() == Qt::Key_J) && key->modifiers() == Qt::NoModifier;
  if (!is_ours || !isVisible() || replay_ || (is_press && is_typing())) return QWidget::eventFilter(watched, event);
  if (key->isAutoRepeat()) return true;
  if (event->type() == QEvent::ShortcutOverride) {
    event->accept();
    return true;
  }
  key->key() == Qt::Key_Z ? set_pedal(is_press) : set_injecting(is_press);
  return true;
}

}  // namespace trocar::trainer
