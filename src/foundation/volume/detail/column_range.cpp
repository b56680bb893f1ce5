#include "volume/detail/column_range.h"

#include <algorithm>
#include <cmath>

namespace trocar::volume::detail {

bool is_inside(const GridGeometry& geometry, const Vec3& index) noexcept {
  for (int a = 0; a < 3; ++a) {
    const double high = static_cast<double>(geometry.size[static_cast<std::size_t>(a)]) - 0.5;
    if (!(index[a] > -0.5 && index[a] < high)) return false;
  }
  return true;
}

ColumnRange columns_inside(const GridGeometry& geometry, const Vec3& start, const Vec3& step, int columns) noexcept {
  if (!start.allFinite() || !step.allFinite() || columns <= 0) return {};
  double low = 0.0;
  double high = static_cast<double>(columns - 1);
  for (int a = 0; a < 3; ++a) {
    if (step[a] == 0.0) continue;  // decided by the test of the ends below
    const double enter = (-0.5 - start[a]) / step[a];
    const double leave = (static_cast<double>(geometry.size[static_cast<std::size_t>(a)]) - 0.5 - start[a]) / step[a];
    low = std::max(low, std::ceil(std::min(enter, leave)));
    high = std::min(high, std::floor(std::max(enter, leave)));
  }
  const auto inside = [&](int u) { return is_inside(geometry, start + static_cast<double>(u) * step); };

  // The divisions are rounded: one column on each side can be wrong. Rounded sums are monotonic, so the ends decide.
  int first = static_cast<int>(std::min(low, static_cast<double>(columns)));
  int last = static_cast<int>(std::max(high, -1.0)) + 1;
  if (first > 0 && inside(first - 1)) --first;
  if (last < columns && inside(std::max(last, 0))) ++last;
  while (first < last && !inside(first)) ++first;
  while (first < last && !inside(last - 1)) --last;
  return first < last ? ColumnRange{first, last} : ColumnRange{};
}

}  // namespace trocar::volume::detail
