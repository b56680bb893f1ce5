#include "views/plots/plot_frame.h"

#include <algorithm>

#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

constexpr double kTickSpace_x = 52.0;  ///< Space in points for a number along its axis.
constexpr double kTickSpace_y = 30.0;

int steps_in(double points, double room) {
  return std::max(1, static_cast<int>(points / room));
}

QString tick_label(double value, double step) {
  return shown(report::tick_text(value, step));
}

}  // namespace

QPointF PlotFrame::to_point(const QPointF& value) const noexcept {
  return {area.left() + area.width() * (value.x() - x.low) / (x.high - x.low),
          area.bottom() - area.height() * (value.y() - y.low) / (y.high - y.low)};
}

QPointF PlotFrame::to_value(const QPointF& point) const noexcept {
  return {x.low + (x.high - x.low) * (point.x() - area.left()) / area.width(),
          y.low + (y.high - y.low) * (area.bottom() - point.y()) / area.height()};
}

void PlotFrame::draw_axes(QPainter& painter, const QString& x_unit, const QString& y_unit, double below) const {
  const Theme& t = theme();
  painter.setFont(scaled_font(0.82));
  const QFontMetricsF metrics(painter.font());
  const double high = metrics.height();
  const double step_x = report::nice_step(x, steps_in(area.width(), kTickSpace_x));
  const double step_y = report::nice_step(y, steps_in(area.height(), kTickSpace_y));
  for (const double value : report::ticks_in(y, step_y)) {
    const double at = to_point({x.low, value}).y();
    painter.setPen(QPen(value == 0.0 ? t.dim : t.line, 1.0));
    painter.drawLine(QPointF(area.left(), at), QPointF(area.right(), at));
    painter.setPen(t.dim);
    painter.drawText(QRectF(0.0, at - 0.5 * high, area.left() - 6.0, high), Qt::AlignRight | Qt::AlignVCenter,
                     tick_label(value, step_y));
  }
  const double unit_wide = metrics.horizontalAdvance(x_unit) + 8.0;
  const double top = area.bottom() + below + 2.0;
  for (const double value : report::ticks_in(x, step_x)) {
    const double at = to_point({value, y.low}).x();
    painter.setPen(QPen(t.line, 1.0));
    painter.drawLine(QPointF(at, area.top()), QPointF(at, area.bottom()));
    const QString text = tick_label(value, step_x);
    const double wide = metrics.horizontalAdvance(text);
    if (at + 0.5 * wide > area.right() - unit_wide) continue;  // space of the unit
    painter.setPen(t.dim);
    painter.drawText(QPointF(at - 0.5 * wide, top + metrics.ascent()), text);
  }
  painter.setPen(t.dim);
  painter.drawText(QPointF(area.right() - metrics.horizontalAdvance(x_unit), top + metrics.ascent()), x_unit);
  painter.drawText(QPointF(area.left() + 5.0, area.top() + metrics.ascent()), y_unit);
}

report::AxisRange rounded_out(const report::AxisRange& range, int at_most) {
  return report::nice_range(range, report::nice_step(range, at_most));
}

}  // namespace trocar::trainer
