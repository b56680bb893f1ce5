#pragma once

#include <QPointF>
#include <cstddef>
#include <vector>

namespace trocar::trainer {

/// A curve that grows point by point and is thinned for a picture as it grows: of every run of points that stays within
/// one column's width only the first, lowest, highest and last are drawn, so that no peak is lost and a hand that
/// trembles in place adds nothing. Appending costs the same however long the curve is.
class CurveTrace {
 public:
  void append(const QPointF& point);
  void clear();
  /// In the unit of x; thins everything anew where it has changed. > 0.
  void set_column_width(double width);

  const std::vector<QPointF>& points() const noexcept { return points_; }
  /// Indices of points() to be drawn, rising, of the first `count` points; the last of these is among them.
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
