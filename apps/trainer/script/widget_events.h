#pragma once

#include <QPointF>
#include <QString>
#include <Qt>

#include "core/result.h"

class QWidget;
class QImage;
class QColor;

/// What a hand does to a widget, as events of the window system. Places are in 0..1 of the widget.
namespace trocar::trainer {

void press(QWidget& widget, const QPointF& place, Qt::MouseButton button);
void move(QWidget& widget, const QPointF& place, Qt::MouseButtons buttons);
void release(QWidget& widget, const QPointF& place, Qt::MouseButton button);
void double_click(QWidget& widget, const QPointF& place);
/// Notches; positive: away from the user.
void turn_wheel(QWidget& widget, const QPointF& place, int notches);
/// A key or chord by its name, "Ctrl+Z", to the focus of the active window, shortcuts included. Error: no such key.
Status press_keys(QWidget& window, const QString& keys);
void type_text(QWidget& window, const QString& text);
/// An entry of a list, box, tab bar by its words, or a value of a slider, number, check box, text field. Error: the
/// widget has none such.
Status choose_entry(QWidget& widget, const QString& text);
Status set_value(QWidget& widget, const QString& value);

/// Share of the pixels whose channels all lie within the tolerance of the colour.
double share_near(const QImage& image, const QColor& color, int tolerance);

}  // namespace trocar::trainer
