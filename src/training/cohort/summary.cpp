#include "cohort/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/check.h"

namespace trocar::cohort {

Status check_finite(std::span<const double> values, std::string_view what) {
  const auto bad = std::find_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); });
  if (bad == values.end()) return {};
  return fail(fmt::format("value {} is not a number", bad - values.begin() + 1), std::string(what),
              "leave out attempts without a value");
}

double mean_of(std::span<const double> values) {
  TROCAR_CHECK(!values.empty());
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double standard_deviation_of(std::span<const double> values) {
  TROCAR_CHECK(values.size() >= 2);
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

std::optional<double> quantile_of(std::span<const double> values, double share) {
  TROCAR_CHECK(share >= 0.0 && share <= 1.0);
  if (values.empty()) return std::nullopt;
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const double position = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

std::optional<Quartiles> quartiles_of(std::span<const double> values) {
  if (values.empty()) return std::nullopt;
  const auto at = [&](double share) { return *quantile_of(values, share); };
  return Quartiles{at(0.0), at(0.25), at(0.5), at(0.75), at(1.0)};
}

std::optional<double> person_mean(std::span<const std::optional<double>> by_attempt, const AttemptRange& range) {
  std::vector<double> values;
  for (std::size_t n = 0; n < by_attempt.size(); ++n) {
    const bool is_within = n + 1 >= range.first && n + 1 <= range.last;
    if (is_within && by_attempt[n] && std::isfinite(*by_attempt[n])) values.push_back(*by_attempt[n]);
  }
  if (values.empty()) return std::nullopt;
  return mean_of(values);
}

}  // namespace trocar::cohort
