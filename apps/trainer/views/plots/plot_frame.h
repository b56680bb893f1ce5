#pragma once

#include <QPainter>
#include <QPolygonF>
#include <QString>

#include "report/plot_scale.h"

namespace trocar::trainer {

/// The ground of a plot: where it lies in its widget and what its axes span.
struct PlotFrame {
  QRectF area;  ///< Points of the widget.
  report::AxisRange x, y;

  QPointF to_point(const QPointF& value) const noexcept;
  QPointF to_value(const QPointF& point) const noexcept;
  /// Grid lines and numbers at round values, units at the ends of the axes, the zero line stronger. `below`: points
  /// between the area and the numbers of the x axis.
  void draw_axes(QPainter& painter, const QString& x_unit, const QString& y_unit, double below) const;
};

/// A range with round ends that holds another one, for an axis that has room for `at_most` steps.
report::AxisRange rounded_out(const report::AxisRange& range, int at_most);

}  // namespace trocar::trainer
