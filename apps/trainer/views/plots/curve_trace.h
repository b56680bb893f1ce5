#pragma once

#include <QPointF>
#include <cstddef>
#include <vector>

namespace trocar::trainer {

/// A curve to which points are appended and that is decimated for drawing. Of every run of points within one column's
/// width, only the first, lowest, highest and last are drawn: no peak is lost, and tremor in place adds no points.
/// Appending takes constant time.
class CurveTrace {
 public:
  void append(const QPointF& point);
  void clear();
  /// In the unit of x; > 0. A change decimates all points again.
  void set_column_width(double width);

  const std::vector<QPointF>& points() const noexcept { return points_; }
  /// Rising indices of the points to draw, of the first `count` points, including the last of these.
  std::vector<std::size_t> drawn(std::size_t count) const;

 private:
  /// Points first..last with their extremes.
  struct Run {
    std::size_t first = 0, lowest = 0, highest = 0, last = 0;
    double left = 0.0, right = 0.0;
  };
  void thin_last();

  std::vector<QPointF> points_;
  std::vector<Run> runs_;
  double column_width_ = 1.0;
};

}  // namespace trocar::trainer
