#pragma once

#include <QPointF>
#include <QString>
#include <Qt>

#include "core/result.h"

class QWidget;
class QImage;
class QColor;

/// User input to a widget, as events of the window system. Positions are in 0..1 of the widget.
namespace trocar::trainer {

void press(QWidget& widget, const QPointF& place, Qt::MouseButton button);
void move(QWidget& widget, const QPointF& place, Qt::MouseButtons buttons);
void release(QWidget& widget, const QPointF& place, Qt::MouseButton button);
void double_click(QWidget& widget, const QPointF& place);
/// Turns the wheel by notches; positive: away from the user.
void turn_wheel(QWidget& widget, const QPointF& place, int notches);
/// Sends a key or chord by its name, "Ctrl+Z", to the focused widget of the active window, including shortcuts. Error:
/// no such key.
enum class KeyMotion { kPress, kDown, kUp };
Status send_keys(QWidget& window, const QString& keys, KeyMotion motion);
inline Status press_keys(QWidget& window, const QString& keys) {
  return send_keys(window, keys, KeyMotion::kPress);
}
void type_text(QWidget& window, const QString& text);
/// Selects an entry of a list, box or tab bar by its text; set_value sets a slider, number, check box or text field.
/// Error: the widget has no such entry or value.
Status choose_entry(QWidget& widget, const QString& text);
Status set_value(QWidget& widget, const QString& value);

/// Share of the pixels whose channels all lie within the tolerance of the colour.
double share_near(const QImage& image, const QColor& color, int tolerance);

}  // namespace trocar::trainer
