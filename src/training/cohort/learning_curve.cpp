#include "cohort/learning_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cohort/detail/distributions.h"
#include "core/check.h"

namespace trocar::cohort {
namespace {

bool has_score(const std::optional<double>& score) {
  return score && std::isfinite(*score);
}

Status check_rate(double rate, double low, double high, const char* name) {
  if (rate >= low && rate <= high) return {};  // false for NaN
  return fail_usage(fmt::format("{} of {:g} is not within {:g} and {:g}", name, rate, low, high), "CUSUM",
                    "choose another one");
}

Status check_rates(const CusumRates& rates) {
  TROCAR_TRY_STATUS(check_rate(rates.acceptable, 0.001, 0.9, "an acceptable failure rate"));
  TROCAR_TRY_STATUS(check_rate(rates.unacceptable, 0.001, 0.999, "an unacceptable failure rate"));
  TROCAR_TRY_STATUS(check_rate(rates.alpha, 0.001, 0.499, "alpha"));
  TROCAR_TRY_STATUS(check_rate(rates.beta, 0.001, 0.499, "beta"));
  if (rates.unacceptable > rates.acceptable) return {};
  return fail_usage(fmt::format("the unacceptable failure rate {:g} is not above the acceptable {:g}",
                                rates.unacceptable, rates.acceptable),
                    "CUSUM", "exchange them");
}

}  // namespace

std::vector<std::optional<double>> moving_mean(std::span<const std::optional<double>> scores, std::size_t window) {
  TROCAR_CHECK(window >= 1);
  std::vector<std::optional<double>> means;
  std::vector<double> last;
  for (const std::optional<double>& score : scores) {
    if (has_score(score)) last.push_back(*score);
    if (last.size() > window) last.erase(last.begin());
    means.push_back(last.empty() ? std::nullopt : std::optional(mean_of(last)));
  }
  return means;
}

std::optional<double> trend_per_attempt(std::span<const std::optional<double>> scores) {
  constexpr std::ptrdiff_t kLeastScores = 3;
  if (std::count_if(scores.begin(), scores.end(), has_score) < kLeastScores) return std::nullopt;
  std::vector<double> slopes;
  for (std::size_t a = 0; a < scores.size(); ++a)
    for (std::size_t b = a + 1; b < scores.size(); ++b)
      if (has_score(scores[a]) && has_score(scores[b]))
        slopes.push_back((*scores[b] - *scores[a]) / static_cast<double>(b - a));
  return quantile_of(slopes, 0.5);
}

Result<Cusum> cusum_of(const std::vector<bool>& passed, const CusumRates& rates) {
  TROCAR_TRY_STATUS(check_rates(rates));
  const double p = std::log(rates.unacceptable / rates.acceptable);
  const double q = std::log((1.0 - rates.acceptable) / (1.0 - rates.unacceptable));
  Cusum cusum;
  cusum.pass_step = q / (p + q);
  cusum.lower = -std::log((1.0 - rates.alpha) / rates.beta) / (p + q);
  cusum.upper = std::log((1.0 - rates.beta) / rates.alpha) / (p + q);
  double sum = 0.0;
  for (const bool is_passed : passed) {
    sum += is_passed ? -cusum.pass_step : 1.0 - cusum.pass_step;
    cusum.values.push_back(sum);
    if (sum > cusum.lower && sum < cusum.upper) continue;
    cusum.signals.push_back(
        {cusum.values.size(), sum <= cusum.lower ? Cusum::Decision::kAcceptable : Cusum::Decision::kUnacceptable});
    sum = 0.0;
  }
  return cusum;
}

std::vector<std::optional<CurvePoint>> mean_curve(std::span<const std::vector<std::optional<double>>> people) {
  std::vector<std::vector<double>> by_attempt;
  for (const std::vector<std::optional<double>>& scores : people)
    for (std::size_t n = 0; n < scores.size(); ++n) {
      if (!has_score(scores[n])) continue;
      by_attempt.resize(std::max(by_attempt.size(), n + 1));
      by_attempt[n].push_back(*scores[n]);
    }
  std::vector<std::optional<CurvePoint>> curve;
  for (const std::vector<double>& scores : by_attempt) {
    curve.emplace_back();
    if (scores.empty()) continue;
    CurvePoint& point = curve.back().emplace(CurvePoint{scores.size(), mean_of(scores)});
    if (scores.size() < 2) continue;
    const auto n = static_cast<double>(scores.size());
    const double student_t = std::sqrt(f_quantile(0.95, 1.0, n - 1.0));  // two-sided 95 %: t² has the F distribution
    const double half = student_t * standard_deviation_of(scores) / std::sqrt(n);
    point.interval = Interval{point.mean - half, point.mean + half};
  }
  return curve;
}

}  // namespace trocar::cohort
