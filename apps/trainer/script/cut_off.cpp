#include "script/cut_off.h"

#include <QAbstractButton>
#include <QAbstractScrollArea>
#include <QLabel>
#include <QScreen>
#include <QWidget>
#include <optional>

namespace trocar::trainer {
namespace {

constexpr int kRounding_px = 2;

/// Empty for widgets without text.
QString text_on(const QWidget& widget) {
  if (const auto* button = qobject_cast<const QAbstractButton*>(&widget)) return button->text();
  if (const auto* label = qobject_cast<const QLabel*>(&widget)) return label->text();
  return {};
}

QSize needed_by(const QWidget& widget) {
  const auto* label = qobject_cast<const QLabel*>(&widget);
  if (label != nullptr && label->wordWrap()) return {0, label->heightForWidth(widget.width())};
  return widget.sizeHint();
}

bool is_viewport(const QWidget& widget) {
  const auto* area = qobject_cast<const QAbstractScrollArea*>(widget.parentWidget());
  return area != nullptr && area->viewport() == &widget;
}

/// The widget that clips a part of this one.
const QWidget* find_cutter(const QWidget& widget) {
  QRect rect(QPoint(), widget.size());
  for (const QWidget* inner = &widget; !inner->isWindow(); inner = inner->parentWidget()) {
    const QWidget* outer = inner->parentWidget();
    rect.translate(inner->pos());
    QRect shown = rect.intersected(outer->rect());
    if (is_viewport(*outer)) {
      if (shown.isEmpty() && rect.width() <= outer->width()) return nullptr;  // scrolled out of view
      shown.setTop(rect.top());
      shown.setBottom(rect.bottom());
      if (shown != rect) return outer;
      rect = rect.intersected(outer->rect());
      continue;
    }
    if (shown != rect) return outer;
  }
  return nullptr;
}

QString name_or_text_of(const QWidget& widget) {
  const QString name = widget.objectName();
  return name.isEmpty() ? QStringLiteral("\"%1\"").arg(text_on(widget).left(40)) : name;
}

std::optional<QString> find_fault(const QWidget& widget) {
  const QSize needed = needed_by(widget);
  if (needed.width() > widget.width() + kRounding_px)
    return QStringLiteral("%1: %2 px wide, needs %3")
        .arg(name_or_text_of(widget))
        .arg(widget.width())
        .arg(needed.width());
  if (needed.height() > widget.height() + kRounding_px)
    return QStringLiteral("%1: %2 px high, needs %3")
        .arg(name_or_text_of(widget))
        .arg(widget.height())
        .arg(needed.height());
  if (const QWidget* cutter = find_cutter(widget))
    return QStringLiteral("%1: reaches out of %2").arg(name_or_text_of(widget), name_or_text_of(*cutter));
  return std::nullopt;
}

}  // namespace

QStringList find_cut_off(const QWidget& window) {
  QStringList faults;
  for (const QWidget* widget : window.findChildren<QWidget*>()) {
    if (!widget->isVisible() || widget->window() != &window || text_on(*widget).isEmpty()) continue;
    if (const auto fault = find_fault(*widget)) faults << *fault;
  }
  return faults;
}

bool is_wholly_visible(const QWidget& widget) {
  if (!widget.isVisible() || widget.visibleRegion() != QRegion(widget.rect())) return false;
  return widget.screen()->geometry().contains(QRect(widget.mapToGlobal(QPoint()), widget.size()));
}

}  // namespace trocar::trainer
