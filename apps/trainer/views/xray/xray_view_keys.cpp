// The keys that are held: pedal and injection.
#include <QKeyEvent>

#include "ui_kit/action_table.h"
#include "ui_kit/page_keys.h"
#include "views/xray/xray_view.h"

namespace trocar::trainer {
bool XrayView::eventFilter(QObject* watched, QEvent* event) {
  const bool is_press = event->type() == QEvent::KeyPress || event->type() == QEvent::ShortcutOverride;
  if (event->type() == QEvent::WindowDeactivate || event->type() == QEvent::ApplicationDeactivate) {
    set_pedal(false);
    set_injecting(false);
  }
  if (!is_press && event->type() != QEvent::KeyRelease) return QWidget::eventFilter(watched, event);
  const auto* key = static_cast<const QKeyEvent*>(event);
  const auto found = find_action(Scope::kPuncture, *key, [](Action action) {
    return action == Action::kFluoroscopy || action == Action::kContrast;
  });
  if (!found || !isVisible() || replay_ || (is_press && !may_act(key_place())))
    return QWidget::eventFilter(watched, event);
  if (key->isAutoRepeat()) return true;
  if (event->type() == QEvent::ShortcutOverride) {
    event->accept();
    return true;
  }
  found->action == Action::kFluoroscopy ? set_pedal(is_press) : set_injecting(is_press);
  return true;
}

}  // namespace trocar::trainer
