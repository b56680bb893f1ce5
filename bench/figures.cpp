#include "bench/figures.h"

#include <algorithm>
#include <cmath>

namespace trocar::bench {
namespace {

/// Nearest rank: the smallest value that at least `fraction` of all values do not exceed.
double quantile(const std::vector<double>& sorted, double fraction) {
  const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(sorted.size())));
  return sorted[std::max<std::size_t>(rank, 1) - 1];
}

}  // namespace

Figures figures_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  Figures figures;
  figures.median = quantile(values, 0.5);
  if (values.size() >= 100) figures.p99 = quantile(values, 0.99);
  if (values.size() >= 1000) figures.p999 = quantile(values, 0.999);
  figures.max = values.back();
  return figures;
}

Figures figure_of(double value) {
  Figures figures;
  figures.median = value;
  return figures;
}

}  // namespace trocar::bench
