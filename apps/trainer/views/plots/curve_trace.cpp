#include "views/plots/curve_trace.h"

#include <algorithm>

#include "core/result.h"

namespace trocar::trainer {

void CurveTrace::append(const QPointF& point) {
  points_.push_back(point);
  thin_last();
}

void CurveTrace::clear() {
  points_.clear();
  runs_.clear();
}

void CurveTrace::set_column_width(double width) {
  TROCAR_CHECK(width > 0.0);
  if (width == column_width_) return;
  column_width_ = width;
  runs_.clear();
  std::vector<QPointF> all;
  all.swap(points_);
  points_.reserve(all.capacity());
  for (const QPointF& point : all) append(point);
}

void CurveTrace::thin_last() {
  const std::size_t n = points_.size() - 1;
  const double x = points_[n].x();
  if (!runs_.empty()) {
    Run& run = runs_.back();
    const double left = std::min(run.left, x);
    const double right = std::max(run.right, x);
    if (right - left <= column_width_) {
      run.left = left;
      run.right = right;
      run.last = n;
      if (points_[n].y() < points_[run.lowest].y()) run.lowest = n;
      if (points_[n].y() > points_[run.highest].y()) run.highest = n;
      return;
    }
  }
  runs_.push_back({n, n, n, n, x, x});
}

std::vector<std::size_t> CurveTrace::drawn(std::size_t count) const {
  std::vector<std::size_t> indices;
  indices.reserve(4 * runs_.size() + 1);
  const auto keep = [&](std::size_t index) {
    if (index < count && (indices.empty() || index > indices.back())) indices.push_back(index);
  };
  for (const Run& run : runs_) {
    if (run.first >= count) break;
    for (const std::size_t index :
         {run.first, std::min(run.lowest, run.highest), std::max(run.lowest, run.highest), run.last})
      keep(index);
  }
  if (count > 0 && count <= points_.size()) keep(count - 1);
  return indices;
}

}  // namespace trocar::trainer
