#pragma once

#include <QPainter>
#include <QPolygonF>
#include <QString>

#include "report/plot_scale.h"

namespace trocar::trainer {

/// Frame of a plot: its area in the widget and the ranges of its axes.
struct PlotFrame {
  QRectF area;  ///< Points of the widget.
  report::AxisRange x, y;

  QPointF to_point(const QPointF& value) const noexcept;
  QPointF to_value(const QPointF& point) const noexcept;
  /// Grid lines and numbers at round values, units at the ends of the axes, the zero line stronger. `below`: points
  /// between the area and the numbers of the x axis.
  void draw_axes(QPainter& painter, const QString& x_unit, const QString& y_unit, double below) const;
};

/// A range with round ends that contains another one, for an axis with space for `at_most` steps.
report::AxisRange rounded_out(const report::AxisRange& range, int at_most);

}  // namespace trocar::trainer
