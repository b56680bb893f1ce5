#include "report/plot_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/result.h"

namespace trocar::report {

AxisRange range_of(const std::vector<double>& values) {
  bool is_empty = true;
  AxisRange range;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range.low = is_empty ? value : std::min(range.low, value);
    range.high = is_empty ? value : std::max(range.high, value);
    is_empty = false;
  }
  if (is_empty) return {0.0, 1.0};
  const double smallest = std::max(1e-9, 1e-6 * std::max(std::abs(range.low), std::abs(range.high)));
  if (range.high - range.low < smallest) {
    const double room = range.low == 0.0 ? 1.0 : 0.1 * std::abs(range.low);
    return {range.low - room, range.high + room};
  }
  return range;
}

double nice_step(const AxisRange& range, int at_most) {
  TROCAR_CHECK(range.low < range.high && at_most >= 1);
  const double rough = (range.high - range.low) / at_most;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= rough * (1.0 - 1e-9)) return factor * decade;
  return 10.0 * decade;
}

AxisRange nice_range(const AxisRange& range, double step) {
  // Rounding must not move a value on a tick to the next one.
  constexpr double kSlack = 1e-9;
  return {step * std::floor(range.low / step + kSlack), step * std::ceil(range.high / step - kSlack)};
}

std::vector<double> ticks_in(const AxisRange& range, double step) {
  constexpr double kSlack = 1e-9;
  std::vector<double> ticks;
  const double last = std::floor(range.high / step + kSlack);
  for (double n = std::ceil(range.low / step - kSlack); n <= last; n += 1.0) ticks.push_back(n == 0.0 ? 0.0 : n * step);
  return ticks;
}

std::string tick_text(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  std::string text = fmt::format("{:.{}f}", value, decimals);
  return text.starts_with('-') ? "\u2212" + text.substr(1) : text;  // a minus sign, not a hyphen
}

std::vector<Point2> thin_out(const std::vector<Point2>& line, double column_width) {
  std::vector<Point2> kept;
  std::size_t first = 0;
  while (first < line.size()) {
    const double column = std::floor(line[first].x() / column_width);
    std::size_t lowest = first;
    std::size_t highest = first;
    std::size_t last = first;
    while (last + 1 < line.size() && std::floor(line[last + 1].x() / column_width) == column) {
      ++last;
      if (line[last].y() < line[lowest].y()) lowest = last;
      if (line[last].y() > line[highest].y()) highest = last;
    }
    std::size_t order[] = {first, std::min(lowest, highest), std::max(lowest, highest), last};
    for (std::size_t i = 0; i < 4; ++i)
      if (i == 0 || order[i] != order[i - 1]) kept.push_back(line[order[i]]);
    first = last + 1;
  }
  return kept;
}

std::vector<double> spread_labels(const std::vector<double>& wanted, const std::vector<double>& widths,
                                  const AxisRange& room) {
  TROCAR_CHECK(wanted.size() == widths.size());
  std::vector<double> centers = wanted;
  double free_from = room.low;
  for (std::size_t i = 0; i < centers.size(); ++i) {
    centers[i] = std::max(centers[i], free_from + widths[i] / 2.0);
    free_from = centers[i] + widths[i] / 2.0;
  }
  double free_to = room.high;
  for (std::size_t i = centers.size(); i-- > 0;) {
    centers[i] = std::min(centers[i], free_to - widths[i] / 2.0);
    free_to = centers[i] - widths[i] / 2.0;
  }
  return centers;
}

}  // namespace trocar::report
